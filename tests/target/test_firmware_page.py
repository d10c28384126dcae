"""docs/firmware-start.md is true: its controller follows the circle, is built for the core, and takes what is said."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from page_blocks import Page

# Compilers of other versions take a few instructions more or less.
ALIKE = 0.05


@pytest.fixture
def page(tmp_path: Path) -> Page:
    """The page, with the leg of the page before and the outputs that this one asks for."""
    there, before = Page("firmware-start.md", tmp_path), Page("urdf.md", tmp_path)
    (tree,), (model,), (outputs,) = before.blocks("xml"), before.blocks("yaml"), there.blocks("yaml")
    there.write("leg.urdf", tree)
    there.write("leg.yaml", f"{model.partition('outputs:')[0]}{outputs}")
    for name, text in zip(("control.h", "control.c", "bench.c"), there.blocks("c"), strict=True):
        there.write(name, text)
    return there


@pytest.mark.firmware
@pytest.mark.slow
@pytest.mark.toolchain
def test_the_controller_follows_the_circle(page: Page, tool: Callable[[str], str]) -> None:
    tool("cc")
    generate, desk, _ = page.blocks("sh")
    page.run("sh", "-ec", generate)
    printed = page.run("sh", "-ec", desk).stdout
    (said,) = re.findall(r"prints `([^`]+)`", page.text)
    assert printed == f"{said}\n"


@pytest.mark.slow
@pytest.mark.toolchain
def test_the_controller_is_built_for_the_core(page: Page, tool: Callable[[str], str]) -> None:
    tool("arm-none-eabi-gcc")
    generate, _, core = page.blocks("sh")
    page.run("sh", "-ec", f"{generate.strip()} --only c --no-verify")
    assert page.run("sh", "-ec", core).stderr == ""
    assert {path.name for path in page.folder.glob("*.o")} == {"control.o", "leg_f.o"}


@pytest.mark.firmware
def test_the_core_takes_what_the_page_says(page: Page, tool: Callable[[str], str]) -> None:
    tool("qemu-system-arm")
    (command,) = page.blocks("console")
    page.run("sh", "-ec", command)
    record = json.loads((page.folder / "generated/leg/target.json").read_text(encoding="utf-8"))
    rows = re.findall(r"^\| (\w+) \| (\d+) \| (\d+) \|$", page.text, re.M)
    assert len(rows) == 6
    (total,) = re.findall(r"That is (\d+) instructions", page.text)
    assert sum(int(count) for _, count, _ in rows) == int(total)
    (core,) = record["cores"]
    single = [cost for cost in core["costs"] if cost["scalar"] == "float32"]
    for kernel, count, size in rows:
        of_kernel = {cost["level"]: cost for cost in single if cost["kernel"] == kernel}
        assert of_kernel["-O2"]["most"] == pytest.approx(int(count), rel=ALIKE), kernel
        assert of_kernel["-Os"]["footprint"]["code"] == pytest.approx(int(size), rel=ALIKE), kernel
