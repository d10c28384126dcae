"""Rows of numbers, such as gears and what keeps a hand level, solved for one unknown each before anything else is.

With the unknown replaced in all other rows, what its link does and what undoes it cancel there: of the rows of an arm
whose hand stays level nothing of the hand is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.records import dataclass
from symgen.symbolic.matrix import Matrix, Vector, flatten
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

# Unknowns of a row up to which each is tried as the one that it is solved for.
MOST_PIVOTS_TRIED = 6


@dataclass(frozen=True, slots=True)
class _SolvedRow:
    """A row and the column of the unknown that it was solved for, in the numbers of what was left then."""

    row: int
    column: int
    coefficients: tuple[Fraction, ...]
    beside: Vector


class ConstantRows:
    """The system without the unknowns that rows of numbers give; `matrix` is what is left of it."""

    def __init__(self, matrix: Matrix) -> None:
        self._steps: list[_SolvedRow] = []
        self.matrix = matrix
        while (step := _next(self.matrix)) is not None:
            self._steps.append(step)
            self.matrix = _reduced(self.matrix, step)

    def of(self, right: Sequence[Scalar]) -> list[Scalar]:
        """The right-hand sides of what is left."""
        return self._sides(right)[1]

    def completed(self, values: Sequence[Scalar], right: Sequence[Scalar]) -> Vector:
        """All unknowns, from those that are left."""
        unknowns, sides = list(values), self._sides(right)[0]
        for step, side in zip(reversed(self._steps), reversed(sides), strict=True):
            others = [c for k, c in enumerate(step.coefficients) if k != step.column]
            rest = side.graph.sum(x * c for x, c in zip(unknowns, others, strict=True) if c)
            unknowns.insert(step.column, (side - rest) * (1 / step.coefficients[step.column]))
        return tuple(unknowns)

    def _sides(self, right: Sequence[Scalar]) -> tuple[list[Scalar], list[Scalar]]:
        """The right-hand side of each row that was solved, as it was then, and those of what is left."""
        sides, left = [], list(right)
        for step in self._steps:
            sides.append(left.pop(step.row))
            own = sides[-1] * (1 / step.coefficients[step.column])
            left = [x - factor * own for x, factor in zip(left, step.beside, strict=True)]
        return sides, left

    def kept(self, values: Sequence[Scalar]) -> list[Scalar]:
        """Of the unknowns those that are left."""
        left = list(values)
        for step in self._steps:
            del left[step.column]
        return left


def _next(matrix: Matrix) -> _SolvedRow | None:
    """A row of numbers with the unknown whose replacement leaves least."""
    for i, row in enumerate(matrix):
        numbers = [x.constant for x in row]
        coefficients = tuple(x for x in numbers if x is not None)
        if len(coefficients) < len(numbers) or not any(coefficients):
            continue
        pivots = [j for j, x in enumerate(coefficients) if x][:MOST_PIVOTS_TRIED]
        steps = [
            _SolvedRow(i, j, coefficients, tuple(other[j] for k, other in enumerate(matrix) if k != i)) for j in pivots
        ]
        return min(steps, key=lambda step: cost(flatten(_reduced(matrix, step)) or (matrix[0][0],)).weight)
    return None


def _reduced(matrix: Matrix, step: _SolvedRow) -> Matrix:
    """The other rows without the unknown."""
    pivot = step.coefficients[step.column]
    shares = [(k, c / pivot) for k, c in enumerate(step.coefficients) if k != step.column]
    rows = (row for i, row in enumerate(matrix) if i != step.row)
    return tuple(tuple(row[k] - row[step.column] * c if c else row[k] for k, c in shares) for row in rows)
