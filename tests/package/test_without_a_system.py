"""The package links on every core without an operating system, as its README says, with CMake and a toolchain file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from shipped import model, programs

from symgen.laboratory.target import package_build
from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import BY_NAME, CORES, Core
from symgen.laboratory.target.emulator import addresses
from symgen.laboratory.target.package_build import Package, build_package, package_of
from symgen.runtime.processes import ToolError

NAME = "rear_car"
# One of each family of processors; the others differ in flags.
FEW = ("cortex-m0+", "rv32imac")
COMPILER = {"arm": "arm-none-eabi-gcc", "riscv": "riscv64-unknown-elf-gcc"}


@cache
def package() -> Package:
    return package_of(model(NAME), programs(NAME))


def needed(tool: Callable[[str], str], core: Core) -> None:
    for name in ("cmake", COMPILER[core.family]):
        tool(name)


@pytest.mark.parametrize(
    "core",
    [pytest.param(core, id=core.name, marks=() if core.name in FEW else pytest.mark.campaign) for core in CORES],
)
def test_every_function_links(tool: Callable[[str], str], tmp_path: Path, core: Core) -> None:
    needed(tool, core)
    folder = tmp_path / "a folder with spaces"
    image = build_package(package(), core, folder)
    functions = [entry.function for entries in package().entries.values() for entry in entries.functions]
    assert {f"{NAME}_inverse_dynamics{form}{suffix}" for form in ("", "_prepared", "_sc") for suffix in ("", "_f")} <= {
        *functions
    }
    assert addresses(Workshop(folder, core), image, functions).keys() == {*functions}


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["cortex-m0+", "cortex-m4f"])
def test_it_would_be_noticed_without_the_library_of_math(
    tool: Callable[[str], str], tmp_path: Path, name: str
) -> None:
    needed(tool, BY_NAME[name])
    path = "package/CMakeLists.txt"
    spoiled = package().files[path].replace(" PUBLIC -lm", "")
    assert spoiled != package().files[path]
    with pytest.raises(ToolError, match="undefined reference to `sqrt'"):
        build_package(replace(package(), files={**package().files, path: spoiled}), BY_NAME[name], tmp_path)


def test_large_packages_are_built_with_their_small_kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(package_build, "LARGEST", 1000)
    known = programs(NAME)
    made = package_of(model(NAME), known)
    names = {entry.kernel.name for entry in made.entries["float32"].functions}
    assert "inverse_dynamics" in names
    assert names < {kernel.name for kernel in known["float32"].kernels}
