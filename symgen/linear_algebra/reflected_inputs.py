"""Input equations solved by reflections where determinants would be too many: their number doubles with each direction.

In coordinates along an orthonormal null-space basis the equations are A u = f with A = F^T M.  u = A^+ f comes from
reflections of the rows of A, or of its columns where the inputs span fewer directions (Golub and Van Loan, 5.5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, Restriction
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, transpose
from symgen.symbolic.scalar import Scalar


class ReflectedInputs:
    """A u = f for the columns of A, with as much rank as `degree` says; in the interface of `ActuationForms`.

    With `weights` w the columns are A_j / sqrt(w_j), and u_j their factors by the `shares` 1 / sqrt(w_j).
    `by_columns`: each pivot is what is left of one of the columns, otherwise of a component of all of them.
    """

    single = False
    minors: frozenset[Scalar] = frozenset()

    def __init__(
        self,
        graph: Graph,
        columns: Sequence[Vector],
        size: int,
        degree: int,
        everywhere: bool,
        weights: Sequence[Scalar] = (),
    ) -> None:
        self.graph, self.degree = graph, degree
        self._given = (tuple(columns), size, degree, everywhere)
        self.shares = [1 / graph.function("sqrt", (weight,)) for weight in weights] or [graph.one] * len(columns)
        self._columns = tuple(
            tuple(entry * share for entry in column) for column, share in zip(columns, self.shares, strict=True)
        )
        self.by_columns = degree == len(self._columns) < size
        rows = self._columns if self.by_columns else transpose(self._columns, size)
        self._space: HouseholderSpace = reflected(graph, rows, len(rows[0]), degree, everywhere, own=False)

    def cancelled(self, _cancel: Callable[[Scalar], Scalar]) -> ReflectedInputs:
        """Nothing is multiplied out."""
        return self

    def weighted(self, weights: Sequence[Scalar]) -> ReflectedInputs:
        """The same with weights of the inputs."""
        columns, size, degree, everywhere = self._given
        return ReflectedInputs(self.graph, columns, size, degree, everywhere, weights)

    def lengths(self, squares: Sequence[Scalar]) -> list[Scalar]:
        """The squared lengths of the columns from those without weights."""
        return [square * share * share for square, share in zip(squares, self.shares, strict=True)]

    def combinations(self, lengths: Sequence[Scalar]) -> list[Scalar]:
        """By columns: of each pivot the squared lengths of the columns that it is made of."""
        return self._space.reflections.combinations(lengths)

    def solve(self, force: Vector) -> Vector:
        """A^+ f; with weights the one of least weighted norm."""
        factors = self._space.lift_transposed(force) if self.by_columns else self._space.lift(force)
        return self._shared(factors)

    def internal_force(self) -> tuple[Vector, Scalar]:
        """Of one input more than directions: inputs of weighted norm 1 that move nothing.

        Their sign is that of (-1)^k det[A without column k]: with A^T = Q R they are the last column of Q, which
        stands first beside A^T in a determinant of det Q det R.
        """
        (axis,) = transpose(self._space.basis, 1)
        sign = self._space.reflections.determinant_sign * (-1 if self.degree & 1 else 1)
        return self._shared(tuple(sign * entry for entry in axis)), self.graph.one

    def internal_forces(self) -> Matrix:
        """Inputs that move nothing (m x (m - degree)), orthonormal in the weights."""
        return tuple(
            tuple(share * entry for entry in row) for share, row in zip(self.shares, self._space.basis, strict=True)
        )

    def _shared(self, factors: Vector) -> Vector:
        return tuple(factor * share for factor, share in zip(factors, self.shares, strict=True))

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

    @property
    def rank_measures(self) -> list[Scalar]:
        """All pivots, of a second factorisation too: none is 0 where A has the rank `degree`."""
        return self._space.rank_measures


def reflected_inputs(
    space: HouseholderSpace, inputs: Sequence[Vector], degree: int, weights: Sequence[Scalar] = ()
) -> tuple[ReflectedInputs, Restriction]:
    """The input equations along a null space by reflections, however few their determinants are."""
    restriction = space.restriction
    columns = [restriction(column) for column in inputs]
    made = ReflectedInputs(space.graph, columns, space.delta, degree, space.reflections.everywhere, weights)
    return made, restriction
