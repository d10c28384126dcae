"""Kernels at many states at once, the same operations with the same bits as `ir/interpret.py` has one by one.

Statements of one operation that do not wait for each other run as one operation on arrays: a kernel of ten thousand
statements has a few hundred such groups.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from symgen.ir.kernel import (
    Block,
    Check,
    Function,
    Kernel,
    Literal,
    Local,
    Operand,
    OperationName,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.last_kernels import LastKernels
from symgen.verify.given import loaded
from symgen.verify.lanes.lane_arithmetic import TYPES, UFUNCS, LaneArithmetic, Lanes, Places, number, together

# Numbers that are worked out at a time: fewer take longer, and more do not stay in the cache.
NUMBERS_AT_ONCE = 4_000_000


def run_many(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, arguments: Sequence[Mapping[str, Sequence[float]]]
) -> list[tuple[Status, list[float]]]:
    """The status of each state and, where it is OK, the outputs; `arguments` hold the parameters `p`, too."""
    if not arguments:
        return []
    given = {name: np.array([one[name] for one in arguments], float) for name in arguments[0]}
    status, outputs = run_lanes(kernel, sincos, scalar, given)
    by_state = zip(status.tolist(), outputs.tolist(), strict=True)
    return [(Status(code), entries if code == 0 else []) for code, entries in by_state]


def run_lanes(
    kernel: Kernel,
    sincos: Function | None,
    scalar: Scalar,
    given: Mapping[str, Lanes],
    numbers: Scalar | None = None,
) -> tuple[Lanes, Lanes]:
    """The status of each state and a row of outputs, which stand for nothing where it is not OK.

    `given` has a row for each state.  With `numbers` the literals are those of this scalar type, so that they make no
    difference between the types.
    """
    count = len(next(iter(given.values())))
    at_once = max(1, NUMBERS_AT_ONCE // (len(kernel.statements) + 1))
    parts = [slice(start, start + at_once) for start in range(0, count, at_once)] or [slice(0)]
    with np.errstate(all="ignore"):
        ends = [
            _KernelRun(
                kernel, sincos, scalar, {name: rows[part] for name, rows in given.items()}, numbers or scalar
            ).outcomes()
            for part in parts
        ]
    if len(ends) == 1:
        return ends[0]
    status, outputs = zip(*ends, strict=True)
    return np.concatenate(status), np.concatenate(outputs)


def run_together(
    kernel: Kernel,
    sincos: Function | None,
    scalar: Scalar,
    sets: Sequence[Mapping[str, Lanes]],
    numbers: Scalar | None = None,
) -> list[tuple[Lanes, Lanes]]:
    """What `run_lanes` has for each set of as many states, with the same bits: it takes hardly longer for many states
    than for a few."""
    given = {name: np.concatenate([one[name] for one in sets]) for name in sets[0]}
    ends = run_lanes(kernel, sincos, scalar, given, numbers)
    return [*zip(*(np.split(end, len(sets)) for end in ends), strict=True)]


class _KernelRun:
    """Values stand in a row for each local and each number."""

    def __init__(
        self, kernel: Kernel, sincos: Function | None, scalar: Scalar, given: Mapping[str, Lanes], numbers: Scalar
    ) -> None:
        self._count = len(next(iter(given.values())))
        self._arithmetic = LaneArithmetic(scalar, sincos)
        self._plan = plan = _PLANS.of(kernel, lambda: _Plan(kernel))
        self._values = np.empty((plan.rows, self._count), TYPES[scalar])
        for load in kernel.loads:
            self._values[plan.loaded[load.local]] = loaded(given, load)
        rounded = plan.numbers(numbers)
        self._values[plan.rows - len(rounded) :] = rounded[:, None]

    def outcomes(self) -> tuple[Lanes, Lanes]:
        """Of all states."""
        status = np.zeros(self._count, dtype=int)
        for block in self._plan.blocks:
            status = np.where(status == 0, self._block(block), status)
        outputs = self._values[self._plan.outputs]
        status = np.where((status == 0) & ~np.isfinite(outputs).all(axis=0), Status.NOT_FINITE, status)
        return status, outputs.T.astype(float)

    def _block(self, block: _BlockPlan) -> Lanes:
        """The first status of each state."""
        values = self._values
        for operation, operands, targets in block.groups:
            # rows that stand together are read where they are; else places are in range, and nothing has to be looked
            # at before rows are taken
            read = [
                values[places] if places.__class__ is slice else values.take(places, 0, None, "clip")
                for places in operands
            ]
            if (function := UFUNCS.get(operation)) is not None:
                function(*read, out=values[targets[0]])
                continue
            made = self._arithmetic.apply(operation, read)
            for places, result in zip(targets, made, strict=True):
                values[places] = result
        status = np.zeros(self._count, dtype=int)
        for check in block.checks:
            status = np.where(status == 0, self._check(check), status)
        return status

    def _check(self, check: _CheckPlan) -> Lanes:
        value, limit = self._values[check.value], self._values[check.limit]
        failed = ~(value >= limit if check.inclusive else value > limit)
        first: Lanes = 0
        if check.first is not None and np.any(failed):
            first = self._block(check.first)
        return np.where(failed, np.where(first == 0, check.status, first), 0)


class _StatementGroup(NamedTuple):
    """Statements of one operation: places of their first operands, of their second ones; likewise targets, which stand
    one after the other.  Places are numbers until all are known."""

    operation: OperationName
    operands: tuple[Places, ...]
    targets: tuple[slice, ...]


@dataclass(frozen=True)
class _CheckPlan:
    status: Status
    inclusive: bool
    value: int
    limit: int
    first: _BlockPlan | None


@dataclass(frozen=True)
class _BlockPlan:
    groups: tuple[_StatementGroup, ...]
    checks: tuple[_CheckPlan, ...]


class _Plan:
    """Where values stand, and what runs together: numbers stand behind all else, at negative places until all are
    known."""

    def __init__(self, kernel: Kernel) -> None:
        # of each place, how many groups of its block come before it at least
        self._depth: list[int] = [0] * len(kernel.loads)
        self._numbers: list[Literal] = []
        self._rounded: dict[Scalar, Lanes] = {}
        # by identity: the values of numbers take longer to compare than to store twice
        self._placed: dict[int, int] = {}
        self.loaded = {load.local: place for place, load in enumerate(kernel.loads)}
        known = dict(self.loaded)
        blocks = [self._block(block, known) for block in kernel.blocks]
        self.outputs = [self._place(output, known) for output in kernel.outputs]
        self.blocks = [_from_the_front(block, self.rows) for block in blocks]

    @property
    def rows(self) -> int:
        """How many there are."""
        return len(self._depth) + len(self._numbers)

    def numbers(self, scalar: Scalar) -> Lanes:
        """What the last rows are in a scalar type."""
        if scalar not in self._rounded:
            self._rounded[scalar] = np.array([number(one, scalar) for one in reversed(self._numbers)], TYPES[scalar])
        return self._rounded[scalar]

    def _place(self, operand: Operand, known: Mapping[str, int]) -> int:
        if not isinstance(operand, Literal):
            return known[operand.name]
        place = self._placed.get(id(operand))
        if place is None:
            self._numbers.append(operand)
            place = self._placed[id(operand)] = -len(self._numbers)
        return place

    def _block(self, block: Block, known: dict[str, int]) -> _BlockPlan:
        """`known` are the places of locals, to which those of the block are added."""
        groups = self._groups(block.statements, known)
        return _BlockPlan(groups, tuple(self._check(check, known) for check in block.checks))

    def _groups(self, statements: Iterable[Statement], known: dict[str, int]) -> tuple[_StatementGroup, ...]:
        """Targets get their places group by group, so that each result is written as one piece."""
        by_level: dict[tuple[int, OperationName], list[Statement]] = {}
        levels: dict[str, int] = {}
        depth = self._depth
        for statement in statements:
            level = 0
            for operand in statement.operands:
                if operand.__class__ is Local:
                    name = operand.name
                    above = levels[name] if name in levels else depth[known[name]]
                    if above > level:
                        level = above
            for target in statement.targets:
                levels[target] = level + 1
            key = level + 1, statement.operation
            if key in by_level:
                by_level[key].append(statement)
            else:
                by_level[key] = [statement]
        groups = []
        for (level, operation), members in sorted(by_level.items(), key=lambda item: item[0]):
            read = [
                [known[o.name] if o.__class__ is Local else self._place(o, known) for o in one.operands]
                for one in members
            ]
            made = []
            for targets in zip(*(one.targets for one in members), strict=True):
                first = len(depth)
                known |= zip(targets, range(first, first + len(targets)), strict=True)
                depth += [level] * len(targets)
                made.append(slice(first, len(depth)))
            groups.append(_StatementGroup(operation, tuple(zip(*read, strict=True)), tuple(made)))
        return tuple(groups)

    def _check(self, check: Check, known: Mapping[str, int]) -> _CheckPlan:
        # what a failure looks at is nobody else's
        first = None if check.first is None else self._block(check.first, dict(known))
        value, limit = self._place(check.value, known), self._place(check.limit, known)
        return _CheckPlan(check.status, check.inclusive, value, limit, first)


def _from_the_front(block: _BlockPlan, rows: int) -> _BlockPlan:
    """The same with places that are not negative."""

    def counted(places: Sequence[int]) -> Places:
        return together([place + rows if place < 0 else place for place in places])

    groups = tuple(
        _StatementGroup(operation, tuple(map(counted, operands)), targets)
        for operation, operands, targets in block.groups
    )
    checks = tuple(
        check if check.first is None else replace(check, first=_from_the_front(check.first, rows))
        for check in block.checks
    )
    return _BlockPlan(groups, checks)


# Every step looks at all kernels of a model in turn: short ones stay until the next.
_PLANS = LastKernels[_Plan](24, statements=150_000)
