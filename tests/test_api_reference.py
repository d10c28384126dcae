"""`make api` makes a reference that says what the docstrings say."""

from __future__ import annotations

import ast
import html
import re
import subprocess
import sys
from pathlib import Path

import pytest
from api_reference import shown

ROOT = Path(__file__).parent.parent


@pytest.mark.slow
def test_the_reference_is_built_without_a_warning(tmp_path: Path) -> None:
    packages = ["symgen", "symgen.symbolic.matrix", "symgen.laboratory.bench.peers.engines.symforce_engine"]
    command = [sys.executable, "tools/api_reference.py", str(tmp_path), *packages]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    for page, text in (
        ("symgen", "make of it what the command does"),
        ("symgen/symbolic/matrix", "zeros cost nothing because"),
        ("symgen/laboratory/bench/peers/engines/symforce_engine", "SymForce's exact π."),
    ):
        written = (tmp_path / f"{page}.html").read_text(encoding="utf-8")
        assert text in written
        assert not re.search('src="(?!data:)', written), "something is loaded from elsewhere"


def docstrings() -> list[tuple[str, str]]:
    texts = []
    for path in sorted((ROOT / "symgen").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module) and (text := ast.get_docstring(node)):
                texts.append((f"{path.relative_to(ROOT)} {getattr(node, 'name', '')}", text))
    return texts


def test_docstrings_are_shown_as_they_are_written() -> None:
    """Markdown takes some of `* _ [ ] < -` for marks: formulas must not lose them, numbers of lists may."""

    def words(text: str) -> str:
        text = re.sub(r"^ *(\d+\.|-) ", "", text, flags=re.M)
        return re.sub(r"\s|`|(?<![\w*`])\*(?=\w+\*(?!\w))|(?<=\w)\*(?![\w*])", "", text)

    changed = [
        (place, text)
        for place, text in docstrings()
        if re.search(r"[*\[<~#\\&!]|^\s*[-+\d>=]", text, flags=re.M)
        and words(text) != words(html.unescape(re.sub(r"<[^>]+>", "", str(shown(text)))))
    ]
    assert changed == []
