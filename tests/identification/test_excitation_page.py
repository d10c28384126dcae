"""docs/excitation.md is true: its command prints what the page says, but for last digits, and writes what it lists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from page_blocks import Page

CONDITIONS = re.compile(r"condition number ([\d.]+) of 7 parameters.* drawn motions ([\d.]+) at best, ([\d.]+) ", re.S)


@pytest.mark.campaign
def test_the_press_moves(tmp_path: Path) -> None:
    model = Page("identification.md", tmp_path).blocks("yaml")[0]
    page = Page("excitation.md", tmp_path)
    (command,), (printed,) = page.blocks("sh"), page.blocks("text")
    page.write("press.yaml", model)
    made = page.run("sh", "-ec", command).stdout
    seen, said = (CONDITIONS.search(text) for text in (made, printed))
    assert seen is not None
    assert said is not None
    # drawn motions are the same anywhere, an optimiser's way is that of the processor
    assert seen.groups()[1:] == said.groups()[1:]
    assert float(seen[1]) == pytest.approx(float(said[1]), rel=0.2)
    for text in (made, printed):
        assert "no range of a_ddot, b_ddot, s_ddot" in text
    files = re.findall(r"^\| `(excitation\.\S+)` \|", page.text, re.M)
    assert {*files} == {path.name for path in (tmp_path / "excited/moving_press").iterdir() if path.name[0] != "."}
