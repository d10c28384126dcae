"""Kernels with twice the digits on emulated cores: the bits of the host, no library, no RAM, a stack that is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from wide_record import NAME, recorded

from symgen.cli.main import main
from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import BY_NAME, LEVELS
from symgen.laboratory.target.record import TargetReport
from symgen.laboratory.target.run import BESIDE, measure
from symgen.laboratory.target.tools import run
from symgen.model.load import load_model

WIDE = {"forward_dynamics": ("float64", "float32"), "singularity": ("float32",)}


def measured(tool: Callable[[str], str], folder: Path, core: str) -> TargetReport:
    arm = ("arm-none-eabi-gcc", "qemu-system-arm")
    riscv = ("riscv64-unknown-elf-gcc", "qemu-system-riscv32")
    for name in ("gcc", *(arm if BY_NAME[core].family == "arm" else riscv)):
        tool(name)
    path, out = recorded(folder, WIDE)
    model = replace(load_model(path), outputs=(*WIDE,))
    return measure(model, [BY_NAME[core]], out=out)


@pytest.mark.firmware
@pytest.mark.toolchain
@pytest.mark.parametrize("core", ["cortex-m4f", "rv32imac"])
def test_bits_are_those_of_the_host(tool: Callable[[str], str], tmp_path: Path, core: str) -> None:
    report = measured(tool, tmp_path, core)
    assert report.failures == ()
    assert not any("derivation chooses" in note for note in report.notes)
    assert "forward_dynamics works with twice the digits in float64 and float32" in report.notes
    cells = [c for c in report.cells if c.where == core and c.trig == "portable"]
    assert {c.level for c in cells if c.compiler == "gcc"} == {*LEVELS}
    assert all(c.different == 0 for c in cells)
    costs = {(c.kernel, c.scalar): c for c in report.cores[0].costs if c.level == "-Os"}
    for name, scalars in WIDE.items():
        for scalar in scalars:
            cost = costs[name, scalar]
            assert cost.footprint is not None
            assert cost.calls
            assert cost.footprint.ram == 0
            assert cost.stack <= cost.footprint.frame + BESIDE
    own = costs["forward_dynamics", "float32"].footprint
    assert own is not None
    # plain arithmetic in float32 and a root: the M4F calls nothing, where a copy of a table would be a memcpy
    assert core != "cortex-m4f" or own.undefined == ()


@pytest.fixture(scope="module")
def emitted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the C."""
    path, out = recorded(tmp_path_factory.mktemp("emitted"), WIDE)
    assert main([str(path), "--only", "c", "--recorded", str(out), "--quiet", "--out", str(out)]) == 0
    return out / NAME / "c"


@pytest.mark.toolchain
@pytest.mark.parametrize("level", [level for level in LEVELS if level != "-O0"])
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_no_compiler_makes_a_call_of_a_table(
    tool: Callable[[str], str], emitted: Path, tmp_path: Path, level: str, compiler: str
) -> None:
    for name in ("arm-none-eabi-gcc", "arm-none-eabi-nm", compiler):
        tool(name)
    shop = Workshop(tmp_path, BY_NAME["cortex-m4f"])
    shop.write({name: (emitted / name).read_text() for name in (f"{NAME}_f.c", f"{NAME}_f.h")})
    assert "_steps_f(" in (shop.folder / f"{NAME}_f.c").read_text()
    made = shop.compile(f"{NAME}_f.c", level, "gcc" if compiler == "gcc" else "clang")
    symbols = run(["arm-none-eabi-nm", "-u", str(made)]).stdout
    assert "mem" not in symbols
