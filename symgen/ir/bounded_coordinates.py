"""Bounds of coordinates out of which a kernel would lose digits, checked when it is called."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Status
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class CoordinateBound:
    """A coordinate, in its unit, is at least `low` and at most `high`; None where nothing bounds it."""

    coordinate: str
    low: Fraction | None
    high: Fraction | None


def within(kernel: Kernel, bounds: Sequence[CoordinateBound], coordinates: Sequence[str]) -> Kernel:
    """The kernel with status COORDINATE_RANGE where one is beyond its bound; `coordinates` are the names of all."""
    if not bounds:
        return kernel
    taken = {load.local for load in kernel.loads}
    taken.update(target for block in kernel.blocks for one in block.all_statements() for target in one.targets)
    loads, checks = list(kernel.loads), []
    for bound in bounds:
        index = coordinates.index(bound.coordinate)
        local = next((load.local for load in loads if (load.argument, load.index) == ("q", index)), None)
        if local is None:
            local = f"place_{index}"
            while local in taken:
                local += "_"
            loads.append(Load(local, "q", index))
        if bound.low is not None:
            checks.append(Check(Status.COORDINATE_RANGE, Local(local), Literal(bound.low), inclusive=True))
        if bound.high is not None:
            checks.append(Check(Status.COORDINATE_RANGE, Literal(bound.high), Local(local), inclusive=True))
    return replace(kernel, loads=tuple(loads), blocks=(Block((), tuple(checks)), *kernel.blocks))


def coordinate_bounds_of(kernel: Kernel, coordinates: Sequence[str]) -> Iterator[CoordinateBound]:
    """The bounds that a kernel checks."""
    names = {load.local: coordinates[load.index] for load in kernel.loads if load.argument == "q"}
    ends: dict[str, list[Fraction | None]] = {}
    for check in (check for block in kernel.blocks for check in block.checks):
        if check.status is Status.COORDINATE_RANGE:
            for side, (value, limit) in enumerate(((check.value, check.limit), (check.limit, check.value))):
                if isinstance(value, Local) and isinstance(limit, Literal):
                    ends.setdefault(names[value.name], [None, None])[side] = limit.value
    yield from (CoordinateBound(name, low, high) for name, (low, high) in ends.items())
