"""Thresholds of rank above what rounding leaves of a pivot, for a kernel that does not hold what lies between.

Those of rows and inputs are raised apart from those of masses: where the ones are near, the others may be far.

A number that is hardly one of its type any more has lost its digits, however large it is beside what it is made of.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import count

from symgen.diagnostics import SymgenBug
from symgen.ir.kernel import UNIT_ROUNDOFF, Block, Check, Kernel, Literal, Local, Operand, Scalar, Statement, Status
from symgen.records import dataclass

# Of rows, and of inputs along what these leave free; and of masses along it.
RANKS = frozenset({Status.CONSTRAINT_RANK, Status.ACTUATION_RANK})
MASSES = frozenset({Status.MASS_RANK})
# The least normal number of each type.
LEAST_NORMAL: dict[Scalar, Fraction] = {"float64": Fraction(1, 2**1022), "float32": Fraction(1, 2**126)}


@dataclass(frozen=True, slots=True)
class Raised:
    """By how many decades thresholds of a kernel are raised: those of rows and inputs, and those of masses.

    By 0, too, there is a status where a number is too small to have digits; None leaves thresholds as they are.
    """

    ranks: int | None = None
    masses: int | None = None


def with_raised_thresholds(kernel: Kernel, scalar: Scalar, raised: Raised) -> Kernel:
    """The kernel with a status where what shows a rank is so many decades further from 0.

    Ranks that are looked at to name a cause once another is lost are looked at always: directions of rows that lose
    rank are as long as others.
    """
    for statuses, decades in ((RANKS, raised.ranks), (MASSES, raised.masses)):
        if decades is not None:
            kernel = _with_raised(kernel, scalar, statuses, decades)
    return kernel


def _with_raised(kernel: Kernel, scalar: Scalar, statuses: Container[Status], decades: int) -> Kernel:
    taken = {load.local for load in kernel.loads}
    for block in kernel.blocks:
        taken.update(target for statement in block.all_statements() for target in statement.targets)
    names = (name for k in count(1) if (name := f"raised_{k}") not in taken)
    least = Literal(LEAST_NORMAL[scalar] / UNIT_ROUNDOFF[scalar])
    raising = _Raising(statuses, Literal(Fraction(10) ** decades), least, names)
    return replace(kernel, blocks=tuple(map(raising.block, kernel.blocks)))


class _Raising:
    """Of the blocks of one kernel, in their order."""

    def __init__(self, statuses: Container[Status], factor: Literal, least: Literal, names: Iterator[str]) -> None:
        self._statuses, self._factor, self._least, self._names = statuses, factor, least, names
        self._known: dict[str, Statement] = {}

    def block(self, block: Block) -> Block:
        """With its thresholds raised, and what names a cause in line."""
        statements = [*self._new(block.statements)]
        checks: list[Check] = []
        limits: dict[Operand, Operand] = {}
        for check in block.checks:
            alone = check
            if check.first is not None and self._raises(check):
                cause = self.block(check.first)
                statements += cause.statements
                checks += cause.checks
                alone = replace(check, first=None, apart=False)
            if check.status not in self._statuses:
                checks.append(alone)
                continue
            if check.limit not in limits:
                limits[check.limit] = self._raised(check.limit, statements)
            checks += [replace(alone, limit=limit) for limit in (limits[check.limit], self._least)]
        return Block(tuple(statements), tuple(checks))

    def _raises(self, check: Check) -> bool:
        """Whether its threshold is raised, or one of those that name its cause: masses may be lost where rows are."""
        named = () if check.first is None else check.first.checks
        return check.status in self._statuses or any(map(self._raises, named))

    def _new(self, statements: Iterable[Statement]) -> Iterator[Statement]:
        """Those that nothing before has worked out: causes may do so for themselves."""
        for statement in statements:
            known = self._known.get(statement.targets[0])
            if known is not None and known != statement:
                raise SymgenBug(f"{statement.targets[0]} is worked out in two ways")
            self._known[statement.targets[0]] = statement
            if known is None:
                yield statement

    def _raised(self, limit: Operand, statements: list[Statement]) -> Operand:
        if isinstance(limit, Literal):
            return Literal(limit.value * self._factor.value)
        if self._factor.value == 1:
            return limit
        name = next(self._names)
        statements.append(Statement((name,), "mul", (limit, self._factor)))
        return Local(name)
