"""The generated package as its user builds it: CMake, a toolchain file without an operating system, an image that calls
every function."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.backends.render import render
from symgen.ir.kernel import Program, Scalar
from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import Core
from symgen.laboratory.target.driver import driver_source
from symgen.laboratory.target.entries import Entries, plain_entries, with_companions
from symgen.laboratory.target.selection import small_kernels
from symgen.laboratory.target.tools import run, toolchain
from symgen.model.model import Model
from symgen.package.files import emit_package

CMAKE = "cmake"
WITHOUT_CMAKE = "cmake is not installed: the package is not built"
LEVEL, BUILD_TYPE = "-Os", "MinSizeRel"
# Characters of source. Larger packages are built with their small kernels: what they need of libraries is the same.
LARGEST = 1_500_000


@dataclass(frozen=True, slots=True)
class Package:
    """The files of a package and of the driver that calls its functions, and those functions."""

    model: Model
    files: Mapping[str, str]
    driver: str
    entries: Mapping[Scalar, Entries]


@dataclass(frozen=True, slots=True)
class ProjectView:
    """What the templates of a project around a package print."""

    name: str
    family: str
    compiler: str
    flags: str
    build_type: str


def has_cmake() -> bool:
    """Whether packages can be built."""
    return shutil.which(CMAKE) is not None


def package_of(model: Model, programs: Mapping[Scalar, Program]) -> Package:
    """The package of all kernels, or of the small ones where it would be large."""
    made = _package(model, programs)
    if sum(len(text) for path, text in made.files.items() if path.endswith(".h")) <= LARGEST:
        return made
    small = {scalar: small_kernels(program) for scalar, program in programs.items()}
    return _package(model, small) if all(program.kernels for program in small.values()) else made


def build_package(package: Package, core: Core, folder: Path) -> Path:
    """The image for a core, linked by CMake; raises ToolError where CMake, the compiler or the linker refuses."""
    chain = toolchain(core.family)
    flags = " ".join((*chain.specs, *core.gcc))
    view = ProjectView(package.model.c_name, core.family, f"{chain.prefix}gcc", flags, BUILD_TYPE)
    shop = Workshop(folder, core)
    shop.write({
        "driver.c": package.driver,
        "toolchain.cmake": render("target/toolchain.cmake.jinja", view),
        "CMakeLists.txt": render("target/project.cmake.jinja", view),
    })
    for path, text in package.files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    run([CMAKE, "-S", ".", "-B", "build", "-DCMAKE_TOOLCHAIN_FILE=toolchain.cmake"], folder)
    run([CMAKE, "--build", "build"], folder)
    return folder / "build" / "image.elf"


def _package(model: Model, programs: Mapping[Scalar, Program]) -> Package:
    emitters: Sequence[Callable[[Model, Program], dict[str, str]]] = (emit_c, emit_c_prepared, emit_c_sc)
    sources = {path: text for p in programs.values() for emit in emitters for path, text in emit(model, p).items()}
    entries = {scalar: with_companions(model, plain_entries(model, p), p) for scalar, p in programs.items()}
    return Package(
        model, emit_package(model, [*programs.values()], sources), driver_source(model, entries), entries
    )
