"""docs/base-parameters.md is true: its command prints what it says."""

from __future__ import annotations

from pathlib import Path

from page_blocks import Page


def test_the_press(tmp_path: Path) -> None:
    page = Page("base-parameters.md", tmp_path)
    (model,), (command,), (printed,) = map(page.blocks, ("yaml", "sh", "text"))
    page.write("press.yaml", model)
    assert page.run("sh", "-ec", command).stdout == printed
