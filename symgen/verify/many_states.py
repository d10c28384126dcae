"""Kernels at many states at once, the same operations with the same bits as `ir/interpret.py` has one by one.

Statements of one operation that do not wait for each other run as one operation on arrays: a kernel of ten thousand
statements has a few hundred such groups.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

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
from symgen.verify.given import entry
from symgen.verify.lane_arithmetic import TYPES, LaneArithmetic, Lanes, number

_Places: TypeAlias = Any


def run_many(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, arguments: Sequence[Mapping[str, Sequence[float]]]
) -> list[tuple[Status, list[float]]]:
    """The status of each state and, where it is OK, the outputs; `arguments` hold the parameters `p`, too."""
    if not arguments:
        return []
    with np.errstate(all="ignore"):
        return _KernelRun(kernel, sincos, scalar, arguments).outcomes()


class _KernelRun:
    """Values stand in a row for each local and each number."""

    def __init__(
        self, kernel: Kernel, sincos: Function | None, scalar: Scalar, given: Sequence[Mapping[str, Sequence[float]]]
    ) -> None:
        self._arithmetic, self._count = LaneArithmetic(scalar, sincos), len(given)
        self._plan = plan = _PLANS.of(kernel, lambda: _Plan(kernel))
        self._values = np.empty((plan.rows, len(given)), TYPES[scalar])
        for load in kernel.loads:
            self._values[plan.loaded[load.local]] = [entry(one, load) for one in given]
        places, numbers = plan.rounded(scalar)
        self._values[places] = numbers[:, None]

    def outcomes(self) -> list[tuple[Status, list[float]]]:
        """Of all states."""
        status = np.zeros(self._count, dtype=int)
        for block in self._plan.blocks:
            status = np.where(status == 0, self._block(block), status)
        outputs = self._values[self._plan.outputs]
        status = np.where((status == 0) & ~np.isfinite(outputs).all(axis=0), Status.NOT_FINITE, status)
        found = zip(status.tolist(), outputs.T.tolist(), strict=True)
        return [(Status(code), entries if code == 0 else []) for code, entries in found]

    def _block(self, block: _BlockPlan) -> Lanes:
        """The first status of each state."""
        values = self._values
        for group in block.groups:
            made = self._arithmetic.apply(group.operation, [values[places] for places in group.operands])
            for places, result in zip(group.targets, made, strict=True):
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


@dataclass(frozen=True)
class _StatementGroup:
    """Statements of one operation: places of their first operands, of their second ones; likewise targets."""

    operation: OperationName
    operands: tuple[_Places, ...]
    targets: tuple[_Places, ...]


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
    """Where values stand, and what runs together."""

    def __init__(self, kernel: Kernel) -> None:
        # of each place, how many groups of its block come before it at least
        self._depth: list[int] = []
        self._numbers: list[tuple[int, Literal]] = []
        self._rounded: dict[Scalar, tuple[_Places, Lanes]] = {}
        # by identity: the values of numbers take longer to compare than to store twice
        self._placed: dict[int, int] = {}
        self.loaded = {load.local: self._new(0) for load in kernel.loads}
        known = dict(self.loaded)
        self.blocks = [self._block(block, known) for block in kernel.blocks]
        self.outputs = [self._place(output, known) for output in kernel.outputs]

    @property
    def rows(self) -> int:
        """How many there are."""
        return len(self._depth)

    def rounded(self, scalar: Scalar) -> tuple[_Places, Lanes]:
        """Where numbers stand, and what they are in a scalar type."""
        if scalar not in self._rounded:
            numbers = [number(literal, scalar) for _, literal in self._numbers]
            places = [place for place, _ in self._numbers]
            self._rounded[scalar] = np.array(places, int), np.array(numbers, TYPES[scalar])
        return self._rounded[scalar]

    def _new(self, depth: int) -> int:
        self._depth.append(depth)
        return len(self._depth) - 1

    def _place(self, operand: Operand, known: Mapping[str, int]) -> int:
        if not isinstance(operand, Literal):
            return known[operand.name]
        place = self._placed.get(id(operand))
        if place is None:
            place = self._placed[id(operand)] = self._new(0)
            self._numbers.append((place, operand))
        return place

    def _block(self, block: Block, known: dict[str, int]) -> _BlockPlan:
        """`known` are the places of locals, to which those of the block are added."""
        groups = self._groups(block.statements, known)
        return _BlockPlan(groups, tuple(self._check(check, known) for check in block.checks))

    def _groups(self, statements: Iterable[Statement], known: dict[str, int]) -> tuple[_StatementGroup, ...]:
        depth = self._depth
        found: dict[tuple[int, OperationName], list[tuple[list[int], list[int]]]] = {}
        for statement in statements:
            operands = [
                known[o.name] if o.__class__ is Local else self._place(o, known) for o in statement.operands
            ]
            level = 1 + max([depth[place] for place in operands])
            targets = []
            for target in statement.targets:
                known[target] = len(depth)
                targets.append(len(depth))
                depth.append(level)
            found.setdefault((level, statement.operation), []).append((operands, targets))
        groups = []
        for (_, operation), members in sorted(found.items(), key=lambda item: item[0]):
            read, made = (tuple(np.array(places).T) for places in zip(*members, strict=True))
            groups.append(_StatementGroup(operation, read, made))
        return tuple(groups)

    def _check(self, check: Check, known: Mapping[str, int]) -> _CheckPlan:
        # what a failure looks at is nobody else's
        first = None if check.first is None else self._block(check.first, dict(known))
        value, limit = self._place(check.value, known), self._place(check.limit, known)
        return _CheckPlan(check.status, check.inclusive, value, limit, first)


# Every step looks at all kernels of a model in turn: short ones stay until the next.
_PLANS = LastKernels[_Plan](4, statements=150_000)
