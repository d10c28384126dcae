"""Running an image under QEMU, with the plug-in that counts the instructions of every call."""

from __future__ import annotations

import shutil
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

from symgen.backends.render import template_folder
from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import Core
from symgen.laboratory.target.tools import EMULATOR, run
from symgen.runtime.processes import ToolError

QUIET = ("-display", "none", "-monitor", "none", "-serial", "none", "-nodefaults")
SEMIHOSTING = ("-chardev", "stdio,id=console", "-semihosting-config", "enable=on,target=native,chardev=console")


def build_counter(folder: Path) -> Path:
    """The plug-in, built from symgen's own source."""
    target = folder / "counter.so"
    source = template_folder() / "target" / "counter.c"
    run(["gcc", "-std=c99", "-O2", "-shared", "-fPIC", "-o", str(target.resolve()), str(source)], folder)
    return target


def emulate(core: Core, image: Path, arguments: Sequence[str] = ()) -> str:
    """Runs an image in its folder until it exits with 0, and returns what it printed; raises ToolError otherwise."""
    command = [EMULATOR[core.family], *core.machine, *QUIET, *SEMIHOSTING, *arguments, "-kernel", str(image)]
    return run(command, image.parent).stdout


def run_image(core: Core | None, image: Path) -> None:
    """Runs an image on its core, or a program on the host."""
    if core is None:
        run([str(image)], image.parent)
    else:
        emulate(core, image)


def count_calls(core: Core, image: Path, counter: Path, functions: Mapping[str, int]) -> dict[str, tuple[int, ...]]:
    """Instructions of every call of the functions (address by name), in the order of the calls.

    Counted are all instructions from a function's first to its return, those of functions it calls included.
    """
    calls, out = image.parent / "calls.txt", image.parent / "counts.bin"
    calls.write_text("".join(f"{address:x}\n" for address in functions.values()), encoding="utf-8")
    emulate(core, image, ("-plugin", f"{counter},calls={calls},out={out}"))
    by_function: dict[str, list[int]] = {name: [] for name in functions}
    names = list(functions)
    for place, count in struct.iter_unpack("<II", out.read_bytes()):
        by_function[names[place]].append(count)
    return {name: tuple(counts) for name, counts in by_function.items()}


def addresses(workshop: Workshop, image: Path, functions: Sequence[str]) -> dict[str, int]:
    """Where functions lie in an image (without the bit that marks Thumb code)."""
    rows = [line.split() for line in run([workshop.tool("nm"), str(image)]).stdout.splitlines()]
    known = {row[2]: int(row[0], 16) & ~1 for row in rows if len(row) == 3}
    if missing := [name for name in functions if name not in known]:
        raise ToolError(f"{image.name} has no function {missing[0]}")
    return {name: known[name] for name in functions}


def stage(image: Path, files: Sequence[Path]) -> None:
    """Puts the input files into the folder of an image."""
    for file in files:
        shutil.copy(file, image.parent / file.name)
