"""What a kernel costs in memory: its own code, what linking it adds to an image, RAM, stack."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.tools import run, toolchain


@dataclass(frozen=True, slots=True)
class KernelFootprint:
    """Bytes of one kernel: `code` with its constants and the helpers of its own file, `linked` also with what it takes
    from the libraries of C and compiler, `ram` its static data, `frame` the deepest chain of frames in its own file by
    -fstack-usage, and the undefined symbols of the kernel's part of the object.
    """

    code: int
    linked: int
    ram: int
    frame: int
    undefined: tuple[str, ...]


def footprints(
    workshop: Workshop, target: Path, functions: Sequence[str], deep: Collection[str] = ()
) -> dict[str, KernelFootprint]:
    """Footprints of functions of one object by name; a helper of `deep` ones, which run through steps, calls others."""
    frames = _frames(target.with_suffix(".su"))
    return {name: _footprint(workshop, target, name, frames, 2 if name in deep else 1) for name in functions}


def deepest_frame(targets: Iterable[Path]) -> int:
    """The largest sum of three frames in any of the objects that gcc wrote: a function and two helpers of its file."""
    frames = [sorted(_frames(target.with_suffix(".su")).values())[-3:] for target in targets]
    return max(map(sum, frames), default=0)


def _footprint(
    workshop: Workshop, target: Path, function: str, frames: Mapping[str, int], depth: int
) -> KernelFootprint:
    part = target.with_suffix(f".{function}.o")
    run([workshop.tool("ld"), *_emulation(workshop), "-r", "--gc-sections", "-e", function, "-o", str(part),
         str(target)])
    code, ram = _sections(workshop, part)
    own, undefined = _symbols(workshop, part)
    linked, _ = _sections(workshop, _linked(workshop, part, function)) if undefined else (code, ram)
    # only what runs through steps calls other helpers: the chain is the function and the largest of them
    helpers = sorted(frames.get(name, 0) for name in own if name != function)[-depth:]
    part.unlink()
    return KernelFootprint(code, linked, ram, frames.get(function, 0) + sum(helpers), undefined)


def _symbols(workshop: Workshop, part: Path) -> tuple[set[str], tuple[str, ...]]:
    """The functions in an object, and the undefined symbols it refers to; its table may name others that went away."""
    listing = run([workshop.tool("objdump"), "-t", "-r", str(part)]).stdout
    rows = [line.split() for line in listing.splitlines()]
    # `00000000 g     F .text.name  00000010 name` and `00000000  *UND*  00000000 name`
    functions = {row[-1].partition(".")[0] for row in rows if "F" in row[1:4]}
    unknown = {row[-1] for row in rows if "*UND*" in row}
    referred = {re.split(r"[+-]0x", row[2])[0] for row in rows if len(row) == 3 and row[1].startswith("R_")}
    return functions, tuple(sorted(unknown & referred))


def _linked(workshop: Workshop, part: Path, function: str) -> Path:
    """An executable of one function and what it needs from libraries."""
    assert workshop.core is not None
    chain = toolchain(workshop.core.family)
    image = part.with_suffix(".elf")
    command = [f"{chain.prefix}gcc", *chain.specs, *workshop.core.gcc, "-nostartfiles", "-Wl,--gc-sections"]
    script = ["-T", str(workshop.folder / "link.ld"), "-Wl,--no-warn-rwx-segments", f"-Wl,-e,{function}"]
    run([*command, *script, "-o", str(image), str(part), "-lm"])
    return image


def _emulation(workshop: Workshop) -> tuple[str, ...]:
    return ("-m", "elf32lriscv") if workshop.core is not None and workshop.core.family == "riscv" else ()


def _sections(workshop: Workshop, file: Path) -> tuple[int, int]:
    """Bytes of code with constants, and bytes of data that is not constant."""
    row = run([workshop.tool("size"), "-A", "-d", str(file)]).stdout
    code = ram = 0
    for line in row.splitlines():
        columns = line.split()
        if len(columns) != 3 or not columns[1].isdigit():
            continue
        name, size = columns[0], int(columns[1])
        if name.startswith((".text", ".rodata", ".srodata", ".ARM.exidx", ".ARM.extab")):
            code += size
        elif name.startswith((".data", ".sdata", ".bss", ".sbss", ".tbss", ".tdata", "COMMON")):
            ram += size
    return code, ram


def _frames(usage: Path) -> dict[str, int]:
    """Frames by function; lines read `file:line:column:function <tab> bytes <tab> kind`."""
    rows = [line.split("\t") for line in usage.read_text(encoding="utf-8").splitlines()]
    return {row[0].rsplit(":", 1)[1].partition(".")[0]: int(row[1]) for row in rows}
