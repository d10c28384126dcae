"""docs/base-parameters.md is true: its commands print what it says, and its Python runs."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from page_blocks import Page


def test_the_press(tmp_path: Path) -> None:
    page = Page("base-parameters.md", tmp_path)
    (model,), (command, _), (printed,) = map(page.blocks, ("yaml", "sh", "text"))
    page.write("press.yaml", model)
    assert page.run("sh", "-ec", command).stdout == printed


@pytest.mark.slow
def test_the_regressor_of_the_press(tmp_path: Path) -> None:
    page = Page("base-parameters.md", tmp_path)
    (model,), (_, command), (use,) = map(page.blocks, ("yaml", "sh", "python"))
    page.write("press.yaml", model)
    page.run("sh", "-ec", command)
    page.run(sys.executable, "-c", use)
    header = (tmp_path / "press/c/press.h").read_text(encoding="utf-8")
    assert "#define PRESS_SIZE_PI 30" in header
    assert "PRESS_PI_CRANK_MZ = 3," in header
    # another mass, another combination, and accelerations that the loop does not allow
    changed = {'"ram.m": 2.5': '"ram.m": 2.4', '"rod.mz": 1.015': '"rod.mz": 1.014', "c_dd - a": "1 - a"}
    for known, other in changed.items():
        assert "AssertionError" in page.run(sys.executable, "-c", use.replace(known, other), code=1).stderr
