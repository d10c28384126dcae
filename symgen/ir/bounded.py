"""Bounds of parameters within which the result of a kernel is known to be accurate, checked when it is called."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Statement, Status
from symgen.ir.last_kernels import LastKernels
from symgen.ir.split import names_in
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Bound:
    """The magnitude of a parameter, in its unit, is at least `low` and at most `high`; None where nothing bounds it."""

    parameter: str
    low: Fraction | None
    high: Fraction | None


def bounded(kernel: Kernel, bounds: Sequence[Bound], parameters: Sequence[str], positive: Container[str]) -> Kernel:
    """The kernel with status PARAMETER_RANGE where a parameter is beyond its bound, of any sign if not `positive`.

    That is found before anything else: where numbers are so far apart, other statuses may come of rounding alone.  It
    may be a parameter that says where the coordinates are and that the kernel itself does not need; `parameters` are
    the names of all, in the order of the model.
    """
    if not bounds:
        return kernel
    made = _BOUNDED.of(kernel, dict)
    key = tuple(bounds), tuple(parameters), tuple(bound.parameter in positive for bound in bounds)
    if key not in made:
        made[key] = _bounded(kernel, bounds, parameters, positive)
    return made[key]


def _bounded(kernel: Kernel, bounds: Sequence[Bound], parameters: Sequence[str], positive: Container[str]) -> Kernel:
    locals_ = {load.member: load.local for load in kernel.loads if load.argument == "p"}
    taken = {load.local for load in kernel.loads}
    taken.update(target for statement in kernel.statements for target in statement.targets)
    loads, blocks = list(kernel.loads), []
    for bound in bounds:
        if bound.parameter not in locals_:
            locals_[bound.parameter] = _new(bound.parameter, taken)
            index = parameters.index(bound.parameter)
            loads.append(Load(locals_[bound.parameter], "p", index, bound.parameter))
        size = Local(locals_[bound.parameter])
        statements: tuple[Statement, ...] = ()
        if bound.parameter not in positive:
            name = _new(f"size_of_{size.name}", taken)
            size, statements = Local(name), (Statement((name,), "abs", (size,)),)
        blocks.append(Block(statements, tuple(_checks(size, bound))))
    return replace(kernel, loads=tuple(loads), blocks=(*blocks, *kernel.blocks))


# One after another, the files of a model are made of the same kernels.
_BOUNDED = LastKernels[dict[tuple[tuple[Bound, ...], tuple[str, ...], tuple[bool, ...]], Kernel]](4, statements=500_000)


def bounds_of(kernel: Kernel) -> Iterator[tuple[Bound, bool]]:
    """The bounds that a kernel checks, and of each whether its parameter may have any sign."""
    members = {load.local: load.member for load in kernel.loads if load.argument == "p"}
    for block in kernel.blocks:
        checks = [check for check in block.checks if check.status is Status.PARAMETER_RANGE]
        if not checks:
            return
        ends = {isinstance(check.value, Literal): check for check in checks}
        low, high = (None if side not in ends else _limit(ends[side]) for side in (False, True))
        size = next(side for side in (checks[0].value, checks[0].limit) if isinstance(side, Local)).name
        signed = bool(block.statements)
        (name,) = names_in(block.statements[0].operands) if signed else (size,)
        yield Bound(members[name], low, high), signed


def _limit(check: Check) -> Fraction:
    return next(side.value for side in (check.value, check.limit) if isinstance(side, Literal))


def _checks(size: Local, bound: Bound) -> Iterator[Check]:
    if bound.low is not None:
        yield Check(Status.PARAMETER_RANGE, size, Literal(bound.low), inclusive=True)
    if bound.high is not None:
        yield Check(Status.PARAMETER_RANGE, Literal(bound.high), size, inclusive=True)


def _new(name: str, taken: set[str]) -> str:
    """A name that was not taken; now it is."""
    while name in taken:
        name += "_"
    taken.add(name)
    return name
