"""Results of a build beside those of the host: bit by bit, or within a bound where a C library's functions differ."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, isfinite

from symgen.backends.c.endings import SINES_GIVEN
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.laboratory.target.driver import FORMAT, SIZE, Results, RunRecord
from symgen.laboratory.target.entries import Entries, Entry
from symgen.laboratory.target.vectors import PERTURBATIONS

# Both results may be 16 units of d + eps |y| from the exact one, and the d of a few perturbations falls short by two.
BOUND = 64.0
LIBRARY = frozenset({"tan", "asin", "acos", "atan", "atan2", "exp", "log", "sinh", "cosh", "tanh", "pow"})

Units = Mapping[str, Sequence[float]]


@dataclass(frozen=True, slots=True)
class Difference:
    """How many records differ, the largest distance in units of d + eps |y|, and what is wrong (empty: nothing)."""

    different: int
    distance: float
    wrong: tuple[str, ...]


def uses_library(entry: Entry, portable: bool) -> bool:
    """Whether a function's results come through functions of the C library, whose last bits are its own.

    What is prepared may have come through one.
    """
    kernel = entry.kernel if entry.form == SINES_GIVEN else entry.plain
    names = {statement.operation for statement in kernel.statements}
    return bool(names & LIBRARY) or (not portable and "sincos" in names)


def compare(entries: Entries, portable: bool, host: Results, other: Results, units: Units, regular: int) -> Difference:
    """Every record of `other` beside the host's; the first `regular` states are judged where bits may differ."""
    different, farthest = 0, 0.0
    wrong: list[str] = []
    for entry in entries.functions:
        pairs = list(zip(host.records[entry.name], other.records[entry.name], strict=True))
        unequal = [k for k, (a, b) in enumerate(pairs) if a != b]
        different += len(unequal)
        if not uses_library(entry, portable):
            if unequal:
                a, b = pairs[unequal[0]]
                wrong.append(f"{entry.name}: {len(unequal)} of {len(pairs)} differ, first vector {unequal[0]}: "
                             f"status {b.status} for {a.status}, {b.outputs.hex()} for {a.outputs.hex()}")
            continue
        for k in unequal:
            if k >= regular:
                continue
            distance = _distance(*pairs[k], entries.scalar, units[entry.kernel.name][k])
            farthest = max(farthest, distance)
            if not distance <= BOUND:
                wrong.append(f"{entry.name}: vector {k} is {distance:.3g} units of d + eps |y| from the host's")
    return Difference(different, farthest, tuple(wrong))


def units_of(entries: Entries, scalar: Scalar, exact: Results, moved: Results) -> Units:
    """d + eps |y| of every quantity and state in a scalar type, d the largest distance under the perturbations.

    Both results are those of the plain kernels in float64.
    """
    eps = float(UNIT_ROUNDOFF[scalar])
    by_name: dict[str, list[float]] = {}
    for entry in entries.functions:
        if entry.form:
            continue
        units = []
        for k, record in enumerate(exact.records[entry.name]):
            y = numbers(record, "float64")
            around = moved.records[entry.name][k * PERTURBATIONS : (k + 1) * PERTURBATIONS]
            others = [numbers(other, "float64") for other in around if other.status == 0]
            d = max((_norm([a - b for a, b in zip(y, z, strict=True)]) for z in others), default=0.0)
            units.append(d + eps * _norm(y))
        by_name[entry.name] = units
    return by_name


def numbers(record: RunRecord, scalar: Scalar) -> tuple[float, ...]:
    """The outputs of a record as numbers."""
    count = len(record.outputs) // SIZE[scalar]
    return struct.unpack(f"<{count}{FORMAT[scalar]}", record.outputs)


def _distance(a: RunRecord, b: RunRecord, scalar: Scalar, unit: float) -> float:
    if a.status != b.status:
        return float("inf")
    if a.status:
        return 0.0
    gap = _norm([x - y for x, y in zip(numbers(a, scalar), numbers(b, scalar), strict=True)])
    return gap / unit if unit > 0 and isfinite(gap) else float("inf") if gap else 0.0


def _norm(values: Sequence[float]) -> float:
    return hypot(*values)
