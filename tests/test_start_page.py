"""docs/start.md is true: its blocks run one after the other, and print what it says."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[1] / "docs" / "start.md"


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)


@pytest.mark.slow
@pytest.mark.toolchain
def test_every_block_runs_and_prints_what_the_page_says(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    commands = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"}

    def run(*command: str, code: int = 0) -> subprocess.CompletedProcess[str]:
        made = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert made.returncode == code, made.stderr
        return made

    (model,), (source,), (mistakes,), (python,) = map(blocks, ("yaml", "c", "text", "python"))
    (tmp_path / "lift.yaml").write_text(model, encoding="utf-8")
    (tmp_path / "main.c").write_text(source, encoding="utf-8")
    wrong = model.replace("com: [l/2, 0, 0], inertia", "com: [L/2, 0, 0], inertia").replace("joint: s", "joint: nut")
    (tmp_path / "wrong.yaml").write_text(wrong, encoding="utf-8")
    assert run("symgen", "wrong.yaml", code=1).stderr.strip().endswith(mistakes.strip())
    printed = "".join(run("sh", "-ec", block).stdout for block in blocks("sh"))
    printed += run("python", "-c", python).stdout
    page = PAGE.read_text(encoding="utf-8")
    for said in re.findall(r"prints `([^`]+)`", page):
        assert said in printed
    for path in re.findall(r"- `((?:report|c|./python)/[^`]+)`", page):
        assert (tmp_path / "generated" / "lift" / path).is_file()
    assert (tmp_path / "generated/lift/simulation.csv").is_file()
