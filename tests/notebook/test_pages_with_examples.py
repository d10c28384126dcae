"""Pages that go through an example are true: their blocks run one after the other, and print what they say."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.parametrize("name", ["derivatives", "encoders", "friction", "limits", "tracking"])
def test_every_block_runs_and_prints_what_the_page_says(
    name: str, tmp_path: Path, tool: Callable[[str], str]
) -> None:
    tool("cc")
    page = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    commands = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"}
    (tmp_path / "delta.yaml").write_bytes((DOCS.parent / "models/delta.yaml").read_bytes())
    printed = ""
    for language, block in re.findall(r"```(\w+)\n(.*?)```", page, re.DOTALL):
        if language == "yaml":
            model = re.search(r"model: (\w+)", block)
            assert model is not None
            (tmp_path / f"{model[1]}.yaml").write_text(block, encoding="utf-8")
            continue
        command = ["sh", "-ec", block] if language == "sh" else ["python", "-c", block]
        made = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert made.returncode == 0, made.stderr
        printed += made.stdout
    said = re.findall(r"prints `([^`]+)`", page)
    assert said
    for line in said:
        assert line in printed
