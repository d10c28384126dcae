"""Thresholds of rank above what rounding leaves of a pivot, for a kernel that does not hold what lies between.

A number that is hardly one of its type any more has lost its digits, however large it is beside what it is made of.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import count

from symgen.ir.kernel import UNIT_ROUNDOFF, Block, Kernel, Literal, Local, Operand, Scalar, Statement, Status

# Of rows, and of inputs along what these leave free.
RANKS = frozenset({Status.CONSTRAINT_RANK, Status.ACTUATION_RANK})
# The least normal number of each type.
LEAST_NORMAL: dict[Scalar, Fraction] = {"float64": Fraction(1, 2**1022), "float32": Fraction(1, 2**126)}


def with_raised_thresholds(kernel: Kernel, scalar: Scalar, decades: int) -> Kernel:
    """The kernel with a status where what shows the rank of rows or inputs is so many decades further from 0.

    Without any, too, it has a status where that is too small a number to have digits.
    """
    taken = {load.local for load in kernel.loads}
    for block in kernel.blocks:
        taken.update(target for statement in block.all_statements() for target in statement.targets)
    names = (name for k in count(1) if (name := f"raised_{k}") not in taken)
    factor, least = Literal(Fraction(10) ** decades), Literal(LEAST_NORMAL[scalar] / UNIT_ROUNDOFF[scalar])
    return replace(kernel, blocks=tuple(_raised(block, factor, least, names) for block in kernel.blocks))


def _raised(block: Block, factor: Literal, least: Literal, names: Iterator[str]) -> Block:
    statements, checks = list(block.statements), []
    limits: dict[Operand, Operand] = {}
    for check in block.checks:
        first = None if check.first is None else _raised(check.first, factor, least, names)
        if check.status in RANKS and check.limit not in limits:
            if isinstance(check.limit, Literal):
                limits[check.limit] = Literal(check.limit.value * factor.value)
            elif factor.value == 1:
                limits[check.limit] = check.limit
            else:
                name = next(names)
                statements.append(Statement((name,), "mul", (check.limit, factor)))
                limits[check.limit] = Local(name)
        limit = limits[check.limit] if check.status in RANKS else check.limit
        checks.append(replace(check, limit=limit, first=first))
        if check.status in RANKS:
            checks.append(replace(check, limit=least, first=first))
    return Block(tuple(statements), tuple(checks))
