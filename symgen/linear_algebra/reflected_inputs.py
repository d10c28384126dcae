"""Input equations solved by reflections where determinants would be too many: their number doubles with each direction.

In coordinates along an orthonormal null-space basis the equations are A u = f with A = F^T M.  u = A^+ f comes from
reflections of the rows of A, or of its columns where the inputs span fewer directions (Golub and Van Loan, 5.5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from symgen.linear_algebra.null_spaces import HouseholderSpace
from symgen.linear_algebra.pivoted import reflected
from symgen.symbolic.matrix import Vector, transpose
from symgen.symbolic.scalar import Graph, Scalar


class ReflectedInputs:
    """A u = f for the columns of A, with as much rank as `degree` says; in the interface of `ActuationForms`.

    `by_columns`: each pivot is what is left of one of the columns, otherwise of a component of all of them.
    """

    single = False
    minors: frozenset[Scalar] = frozenset()

    def __init__(self, graph: Graph, columns: Sequence[Vector], size: int, degree: int, everywhere: bool) -> None:
        self.graph, self.degree = graph, degree
        self._columns = tuple(columns)
        self.by_columns = degree == len(self._columns) < size
        rows = self._columns if self.by_columns else transpose(self._columns, size)
        self._space: HouseholderSpace = reflected(graph, rows, len(rows[0]), degree, everywhere, own=False)

    def cancelled(self, _cancel: Callable[[Scalar], Scalar]) -> ReflectedInputs:
        """Nothing is multiplied out."""
        return self

    def solve(self, force: Vector) -> Vector:
        """A^+ f."""
        return self._space.lift_transposed(force) if self.by_columns else self._space.lift(force)

    def square(self) -> Scalar:
        """The sum of the squared minors of A."""
        return self._space.square

    def denominator(self) -> Scalar:
        """The same: its factors are what is divided by."""
        return self.square()

    @property
    def pivots(self) -> list[Scalar]:
        """Their product is the square, or one of the squared minors where A is short of rank both ways."""
        return self._space.reflections.pivots
