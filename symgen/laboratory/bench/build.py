"""All C candidates compiled with the same flags and linked into one program, with code size and stack."""

from __future__ import annotations

import re
import shutil
import struct
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE
from symgen.ir.kernel import Scalar
from symgen.laboratory.bench.candidate import CCandidate, Task
from symgen.laboratory.bench.workload import Workload
from symgen.model.model import Model
from symgen.runtime.processes import ToolError, run

# Position-independent for all, as a library that is loaded needs it; see docs/bench for what that means for CasADi.
FLAGS = ("-O2", "-std=c99", "-ffp-contract=off")
# A tool that only knows double is given float by its own type name, type-generic functions and float constants.
SINGLE = ("-include", "tgmath.h", "-fsingle-precision-constant")
TIMED_STATES = 256
PROCESSES = 2
LONGEST_RUN = 1800.0  # seconds of a compiler, or of a program that measures


class BuildError(Exception):
    """The compiler refused a candidate; the text says which and why."""


@dataclass(frozen=True, slots=True)
class DriverGroup:
    """The kernels of one scalar type."""

    type: str
    entries: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BenchDriverView:
    """What the driver's template prints."""

    n: int
    third: int
    parameters: int
    size: int
    timed_states: int
    groups: tuple[DriverGroup, ...]


@dataclass(frozen=True, slots=True)
class CandidateFootprint:
    """Bytes of code of the functions of a candidate, and bytes of stack they take (library functions excluded)."""

    code: int
    stack: int


@dataclass(frozen=True, slots=True)
class Built:
    """The program, and the footprint of each candidate by entry."""

    program: Path
    footprints: Mapping[str, CandidateFootprint]


def find_gcc() -> str | None:
    """gcc, the compiler all candidates share; None when this machine has none."""
    return shutil.which("gcc")


def build(
    folder: Path, model: Model, task: Task, candidates: Sequence[CCandidate], loads: Mapping[Scalar, Workload]
) -> Built:
    """Compile and link in `folder`, and write the states beside the program."""
    with ThreadPoolExecutor(PROCESSES) as pool:
        compiled = list(pool.map(lambda c: compile_candidate(folder / c.entry, c), candidates))
    scalars = [scalar for scalar in loads if any(c.scalar == scalar for c in candidates)]
    view = BenchDriverView(
        n=model.n,
        third=len(loads[scalars[0]].states[0]) - 2 * model.n - len(model.parameters),
        parameters=len(model.parameters),
        size=task.size,
        timed_states=TIMED_STATES,
        groups=tuple(DriverGroup(C_TYPE[s], tuple(c.entry for c in candidates if c.scalar == s)) for s in scalars),
    )
    (folder / "driver.c").write_text(render("bench/driver.c.jinja", view), encoding="utf-8")
    for scalar in scalars:
        _write_states(folder / f"states_{C_TYPE[scalar]}.bin", loads[scalar])
    objects = [str(path) for paths, _ in compiled for path in paths]
    program = folder / "bench"
    # Symbols are bound before the first call, so that no call is dearer than the next.
    gcc(["-O1", "-std=c99", "-o", str(program), str(folder / "driver.c"), *objects, "-Wl,-z,now", "-lm"], "the driver")
    return Built(program, {c.entry: footprint for c, (_, footprint) in zip(candidates, compiled, strict=True)})


def results_of(built: Built, folder: Path, candidates: Sequence[CCandidate], task: Task) -> dict[str, Any]:
    """What each candidate makes of every state: arrays (states, size) by entry; NaN where it reports a status."""
    import numpy as np

    _done([str(built.program), "results", "0"], folder)
    by_entry: dict[str, Any] = {}
    for scalar, kind in C_TYPE.items():
        entries = [c.entry for c in candidates if c.scalar == scalar]
        if entries:
            data = np.fromfile(folder / f"results_{kind}.bin", dtype=np.dtype(scalar))
            by_entry |= dict(zip(entries, data.reshape(len(entries), -1, task.size), strict=True))
    return by_entry


def nanoseconds(built: Built, passes: int) -> dict[str, float]:
    """Median time of one call by entry; the candidates take turns in every pass."""
    printed = _done([str(built.program), "time", str(passes)], built.program.parent)
    return {name: float(value) for name, value in (line.split() for line in printed.splitlines())}


def compile_candidate(
    folder: Path, candidate: CCandidate, common: Sequence[str] | None = None
) -> tuple[list[Path], CandidateFootprint]:
    """The objects of a candidate and what they take; `common` stands in for the usual flags of all candidates.

    Raises BuildError with the compiler's words.
    """
    folder.mkdir()
    objects = []
    code = stack = 0
    for number, unit in enumerate(candidate.units):
        for name, text in unit.headers.items():
            (folder / name).write_text(text, encoding="utf-8")
        source, target = folder / f"unit{number}.c", folder / f"unit{number}.o"
        source.write_text(unit.source, encoding="utf-8")
        flags = [*(FLAGS if common is None else common), "-fPIC", *candidate.flags, "-fstack-usage"]
        flags += [f"-DREAL={C_TYPE[candidate.scalar]}", "-Dcasadi_real=REAL"]
        if candidate.scalar == "float32" and not unit.headers:
            flags += SINGLE
        flags += [f"-D{name}={new}" for name, new in unit.renamed.items()]
        gcc([*flags, "-c", "-o", str(target), str(source)], candidate.label)
        objects.append(target)
        if not unit.is_adaptor:
            functions = {unit.renamed.get(name, name) for name in candidate.functions}
            code += _code_bytes(target, functions)
            stack += _stack_bytes(target.with_suffix(".su"), functions)
    return objects, CandidateFootprint(code, stack)


def gcc(arguments: Sequence[str], what: str) -> None:
    """Run gcc; raises BuildError with its words and `what` it refuses."""
    completed = run(["gcc", *arguments], LONGEST_RUN)
    if completed.returncode:
        raise BuildError(f"gcc refuses {what}: {completed.stderr[:2000]}")


def _done(command: Sequence[str], folder: Path | None = None) -> str:
    """What a program prints; raises ToolError when it fails."""
    completed = run(command, LONGEST_RUN, folder)
    if completed.returncode:
        raise ToolError(f"{command[0]} failed ({completed.returncode}): {completed.stderr[:2000]}")
    return completed.stdout


def _code_bytes(target: Path, functions: set[str]) -> int:
    rows = [line.split() for line in _done(["nm", "-S", "--defined-only", str(target)]).splitlines()]
    return sum(int(row[1], 16) for row in rows if len(row) == 4 and row[2] in "tTr" and _base(row[3]) in functions)


def _stack_bytes(usage: Path, functions: set[str]) -> int:
    """Lines read `file:line:column:function <tab> bytes <tab> kind`."""
    rows = [line.split("\t") for line in usage.read_text(encoding="utf-8").splitlines()]
    return sum(int(row[1]) for row in rows if _base(row[0].rsplit(":", 1)[1]) in functions)


def _base(symbol: str) -> str:
    """The function a compiler's variant (`f.constprop.0`, `f.part.0`) was made from."""
    return re.split(r"\.", symbol, maxsplit=1)[0]


def _write_states(path: Path, load: Workload) -> None:
    kind = "d" if load.scalar == "float64" else "f"
    path.write_bytes(b"".join(struct.pack(f"{len(row)}{kind}", *row) for row in load.states.tolist()))
