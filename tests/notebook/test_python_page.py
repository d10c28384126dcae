"""docs/python.md is true: its code runs from top to bottom."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


@pytest.mark.slow
@pytest.mark.toolchain
@pytest.mark.campaign
def test_the_code_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) > 6
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    printed = capsys.readouterr().out
    assert "unknown name `M_c` in the kinetic energy" in printed
    assert "forces act on coordinates; name one of them: x, a" in printed
    assert (tmp_path / "build" / "example" / "cart" / "c" / "cart.c").is_file()
    assert (tmp_path / "arm.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert "<html" in (tmp_path / "arm.html").read_text(encoding="utf-8")
