"""Sines are unrolled where a core computes in the type itself; elsewhere every operation is a call anyway."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import write_sources

from symgen.ir.kernel import Scalar
from symgen.laboratory.target.cores import CORES, Core
from symgen.laboratory.target.tools import PREFIX, toolchain

FILES: dict[Scalar, tuple[str, str]] = {
    "float64": ("front_car.c", "FRONT_CAR_UNROLL"), "float32": ("front_car_f.c", "FRONT_CAR_UNROLL_F"),
}


@pytest.mark.parametrize("scalar", FILES)
@pytest.mark.parametrize("core", CORES, ids=lambda core: core.name)
def test_where_the_unit_computes_in_the_type(
    core: Core, scalar: Scalar, tmp_path: Path, tool: Callable[[str], str]
) -> None:
    compiler = tool(f"{PREFIX[core.family]}gcc")
    write_sources("front_car", tmp_path)
    source, macro = FILES[scalar]

    def unrolled(level: str) -> bool:
        command = [compiler, *toolchain(core.family).specs, *core.gcc, "-std=c99", level, "-dM", "-E", source]
        macros = subprocess.run(command, cwd=tmp_path / "c", capture_output=True, text=True, check=True).stdout
        (line,) = (line for line in macros.splitlines() if line.split()[:2] == ["#define", macro])
        return "_Pragma" in line

    assert unrolled("-O2") == (scalar in core.native)
    assert not unrolled("-Os")
