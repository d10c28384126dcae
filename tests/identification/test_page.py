"""docs/base-parameters.md is true: its commands print what it says, and its Python runs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from page_blocks import Page


def test_the_press(tmp_path: Path) -> None:
    page = Page("base-parameters.md", tmp_path)
    (model,), (command, _), (printed,) = map(page.blocks, ("yaml", "sh", "text"))
    page.write("press.yaml", model)
    assert page.run("sh", "-ec", command).stdout == printed


@pytest.mark.campaign
@pytest.mark.slow
def test_the_regressor_of_the_press(tmp_path: Path, tool: Callable[[str], str]) -> None:
    page = Page("base-parameters.md", tmp_path)
    (model,), (_, command), (use,) = map(page.blocks, ("yaml", "sh", "python"))
    page.write("press.yaml", model)
    page.run("sh", "-ec", command)
    page.run(sys.executable, "-c", use)
    header = (tmp_path / "press/c/press.h").read_text(encoding="utf-8")
    assert "#define PRESS_SIZE_PI 30" in header
    assert "PRESS_PI_CRANK_MZ = 3," in header
    (snippet,) = page.blocks("c")
    given = "float q[3] = {0.8f, -1.0f, 0.41f}, qd[3] = {0}, qdd[3] = {1, 2, 3};\n"
    given += "press_params_f p = press_default_params_f();"
    used = 'return printf("%d %.5g %.5g\\n", (int)status, beta[PRESS_BETA_CRANK_MZ], of_mass) < 0;'
    page.write("main.c", f'#include "press_f.h"\n#include <stdio.h>\nint main(void) {{\n{given}\n{snippet}{used}\n}}\n')
    strict = ("-std=c99", "-Wall", "-Werror", "-Ipress/c")
    page.run(tool("gcc"), *strict, "-o", "main", "main.c", "press/c/press_f.c", "-lm")
    assert page.run("./main").stdout == "0 0.39 -7.0373\n"  # -9.81 sin a
    # another mass, another combination, and accelerations that the loop does not allow
    changed = {'"ram.m": 2.5': '"ram.m": 2.4', "1.015": "1.014", "c_dd - a": "1 - a"}
    for known, other in changed.items():
        assert "AssertionError" in page.run(sys.executable, "-c", use.replace(known, other), code=1).stderr
