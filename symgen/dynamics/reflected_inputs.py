"""Input equations solved by reflections where determinants would be too many: their number doubles with each direction.

In coordinates along an orthonormal null-space basis the equations are A u = f with A = F^T M.  u = A^+ f comes from
reflections of the rows of A, or of its columns where the inputs span fewer directions (Golub and Van Loan, 5.5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property

from symgen.dynamics.guards import Guard, magnitude
from symgen.dynamics.pivoted import elementary_symmetric, reflected
from symgen.dynamics.spaces import HouseholderSpace
from symgen.graph.matrix import Vector, dot, transpose
from symgen.graph.scalar import Graph, Scalar
from symgen.ir.kernel import Status


class ReflectedInputs:
    """A u = f for the columns of A, with as much rank as `degree` says; in the interface of `ActuationForms`."""

    single = False
    minors: frozenset[Scalar] = frozenset()

    def __init__(self, graph: Graph, columns: Sequence[Vector], size: int, degree: int, everywhere: bool) -> None:
        self.graph, self.degree = graph, degree
        self._columns = tuple(columns)
        self._by_columns = degree == len(self._columns) < size
        rows = self._columns if self._by_columns else transpose(self._columns, size)
        self._space: HouseholderSpace = reflected(graph, rows, len(rows[0]), degree, everywhere, own=False)

    def cancelled(self, _cancel: Callable[[Scalar], Scalar]) -> ReflectedInputs:
        """Nothing is multiplied out."""
        return self

    def solve(self, force: Vector) -> Vector:
        """A^+ f."""
        return self._space.lift_transposed(force) if self._by_columns else self._space.lift(force)

    def square(self) -> Scalar:
        """The sum of the squared minors of A."""
        return self._space.square

    def denominator(self) -> Scalar:
        """The same: its factors are what is divided by."""
        return self.square()

    @cached_property
    def pivots(self) -> list[Scalar]:
        """Their product is the square, or one of the squared minors where A is short of rank both ways."""
        return self._space.reflections.pivots

    def guards(self, status: Status, before: tuple[Guard, ...], columns: Sequence[Vector]) -> tuple[Guard, ...]:
        """That the rank is `degree`: beside the lengths of the inputs' own `columns`, and these beside their bounds.

        What bounds the length of a moment about a turned lever is several times the length; of six columns
        together that is more than float32 can tell from a drop of the rank.
        """
        graph = self.graph
        lengths = [dot(graph, column, column) for column in columns]
        bounds = magnitude(graph, lengths)
        usual = graph.sum(bounds) * Fraction(1, len(bounds))
        own, largest = (elementary_symmetric(graph, [x / usual for x in xs], self.degree) for xs in (lengths, bounds))
        directions = Guard(status, graph.product(pivot / usual for pivot in self.pivots), 2, before, own)
        return (directions,) if own is largest else (Guard(status, own, 2, before, largest), directions)
