"""The system tools a target needs: where they are, which packages bring them, and how they are run."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from subprocess import CompletedProcess

from symgen.generation.results import WrongUseError
from symgen.laboratory.target.cores import Compiler, Core, Family
from symgen.runtime import processes
from symgen.runtime.processes import ToolError

PREFIX: dict[Family, str] = {"arm": "arm-none-eabi-", "riscv": "riscv64-unknown-elf-"}
EMULATOR: dict[Family, str] = {"arm": "qemu-system-arm", "riscv": "qemu-system-riscv32"}
# Packages of Debian and Ubuntu.
PACKAGES: dict[str, tuple[str, ...]] = {
    "arm-none-eabi-gcc": ("gcc-arm-none-eabi", "libnewlib-arm-none-eabi"),
    "qemu-system-arm": ("qemu-system-arm",),
    "riscv64-unknown-elf-gcc": ("gcc-riscv64-unknown-elf", "picolibc-riscv64-unknown-elf"),
    "qemu-system-riscv32": ("qemu-system-misc",),
    "gcc": ("gcc", "libc6-dev"),
}
LONGEST_RUN = 900.0


@dataclass(frozen=True, slots=True)
class Toolchain:
    """What builds for the cores of one family: commands, and what its C library needs of gcc and of clang."""

    prefix: str
    specs: tuple[str, ...]
    include: tuple[str, ...]


def require(cores: Iterable[Core]) -> None:
    """Raises WrongUseError that names the missing tools and the packages that bring them."""
    needed = ["gcc"]
    for core in cores:
        needed += [PREFIX[core.family] + "gcc", EMULATOR[core.family]]
    missing = [tool for tool in dict.fromkeys(needed) if shutil.which(tool) is None]
    if missing:
        packages = " ".join(package for tool in missing for package in PACKAGES[tool])
        raise WrongUseError(
            f"not installed: {', '.join(missing)}; on Debian or Ubuntu:\n"
            f"  apt-get install --no-install-recommends {packages}"
        )


def compilers() -> tuple[Compiler, ...]:
    """gcc, and clang where there is one."""
    return ("gcc", "clang") if shutil.which("clang") else ("gcc",)


@cache
def toolchain(family: Family) -> Toolchain:
    """The toolchain of a family; picolibc is RISC-V's only packaged C library."""
    prefix = PREFIX[family]
    specs = ("--specs=picolibc.specs",) if family == "riscv" else ()
    printed = run([f"{prefix}gcc", *specs, "-E", "-v", "-x", "c", "/dev/null"]).stderr
    listed = printed.partition("search starts here:\n")[2].partition("#include <...> search starts here:\n")
    folders = [line.strip() for line in (listed[2] or printed).partition("End of search list")[0].splitlines()]
    # clang brings its own headers of the language and lacks those of the library
    library = [folder for folder in folders if Path(folder, "math.h").is_file() and Path(folder, "string.h").is_file()]
    include = tuple(argument for folder in library[:1] for argument in ("-isystem", folder))
    return Toolchain(prefix, specs, include)


def run(command: Sequence[str], folder: Path | None = None) -> CompletedProcess[str]:
    """Runs a tool; raises ToolError with what it says when it fails or hangs."""
    completed = processes.run(command, LONGEST_RUN, folder)
    if completed.returncode:
        said = (completed.stderr + completed.stdout).strip()[:2000]
        raise ToolError(f"{command[0]} failed ({completed.returncode}): {said}\n  {' '.join(command)}")
    return completed


def version(tool: str) -> str:
    """The first line a tool says about itself."""
    return (run([tool, "--version"]).stdout.splitlines() or ["unknown"])[0]
