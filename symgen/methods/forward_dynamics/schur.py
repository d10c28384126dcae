"""q_ddot and lambda by elimination of the accelerations: G = L D L^T, then the constraints in the metric of G^-1.

With A = L^-1 B^T the system G q_ddot + B^T lambda = f, B q_ddot = -a becomes x + A lambda = L^-1 f, A^T D^-1 x = -a
for x = D L^T q_ddot.  A = V R is factorised with columns of V that are orthogonal in the metric D^-1, so that the
squared condition number of A^T D^-1 A is never met (Golub and Van Loan, Matrix Computations, 4.1 and 5.2).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from symgen.linear_algebra.constrained_inverse import Cholesky, diagonal_sizes
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import LONGEST_PRODUCT
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.linear_algebra.orthogonal import PivotedGramSchmidt, WeightedGramSchmidt
from symgen.linear_algebra.refinement import Solution, less_forces, missing, of_columns, refined
from symgen.mechanics.never_zero import Definite
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.symbolic.matrix import Matrix, Vector, subtract_vectors
from symgen.symbolic.scalar import Scalar


class MassMatrixFactor(Protocol):
    """G = L D L^T with the pivots D; L may be triangular in any order of the coordinates."""

    @property
    def pivots(self) -> Sequence[Scalar]:
        """D."""

    @property
    def guards(self) -> tuple[Guard, ...]:
        """What must not vanish for G to be definite."""

    def lowered(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L y = b."""

    def raised(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L^T x = b."""


class SchurQR:
    """By A = V R: valid wherever G is positive definite and B has its generic `rank`, for any right-hand sides.

    `factor` is that of G where it is known.
    """

    def __init__(self, problem: Problem, rank: int, factor: MassMatrixFactor | None = None) -> None:
        self._graph = problem.graph
        self._factor = OrderedCholesky(problem) if factor is None else factor
        columns = [self._factor.lowered(row) for row in problem.rows]
        self._elimination = SchurElimination(problem, self._factor, columns, rank)

    def motion(self, force: Vector, bias: Vector, refining: bool) -> Motion:
        """The solution of G q_ddot + B^T lambda = f, B q_ddot = -a; `refining` solves for what it leaves once more."""
        graph, factor, elimination, rows = self._graph, self._factor, self._elimination, self._elimination.rows
        asked = elimination.asked(bias)

        def left_over(x: Vector, multipliers: Vector) -> Solution:
            # by L and D, because an inner entry of G has lost what it holds of light bodies; by B, because its columns
            # may be of very different size, which L^-1 mixes
            forces = subtract_vectors(factor.lowered(less_forces(graph, force, rows, multipliers)), x)
            return forces, missing(graph, rows, asked, elimination.accelerations(x))

        return elimination.motion(factor.lowered(force), asked, left_over if refining else None)


def schur_qr(
    problem: Problem, rank: int, factor: MassMatrixFactor | None = None, refining: bool = False
) -> Motion:
    """q_ddot and lambda of a system's own right-hand sides."""
    return SchurQR(problem, rank, factor).motion(problem.force, problem.bias, refining)


class SchurElimination:
    """x + A lambda = L^-1 f, A^T D^-1 x = -a; `columns` are those of A.

    `guards` are the denominators.
    """

    def __init__(self, problem: Problem, factor: MassMatrixFactor, columns: Sequence[Vector], rank: int) -> None:
        graph, r = problem.graph, problem.r
        self._graph, self._r, self._factor = graph, r, factor
        self.weights: Vector = tuple(1 / pivot for pivot in factor.pivots)
        self._columns, self._again = columns, problem.rows_in_line
        self._orthogonal = (
            WeightedGramSchmidt(graph, columns, self.weights)
            if rank == r
            else PivotedGramSchmidt(graph, columns, self.weights, rank)
        )
        self._all_rows = problem.rows
        self.rows = self._orthogonal.chosen(problem.rows)
        # the rank of B is measured where its rows are made orthogonal anyway; of few rows it is told, once something is
        # lost, whether it is that, or light bodies leave nothing of a difference of rows that are far from parallel
        few = 1 < r <= min(rank, LONGEST_PRODUCT)
        causes = reflected(graph, problem.rows, problem.n, r).guards if few else ()
        self.guards: tuple[Guard, ...] = (*(self._orthogonal.regularity(causes) if r else ()), *factor.guards)

    def asked(self, bias: Vector) -> Vector:
        """What the rows that are solved with ask for."""
        return self._orthogonal.asked(self._all_rows, tuple(-a for a in bias))

    def accelerations(self, x: Vector) -> Vector:
        """q_ddot of x = D L^T q_ddot."""
        return self._factor.raised(tuple(entry * weight for entry, weight in zip(x, self.weights, strict=True)))

    def motion(
        self, force: Vector, asked: Vector, left_over: Callable[[Vector, Vector], Solution] | None
    ) -> Motion:
        """q_ddot and lambda for L^-1 f; `left_over` is what a solution leaves of the right-hand sides, to refine it."""
        x, multipliers = self._solution(force, asked, left_over)
        return Motion(self.accelerations(x), multipliers, self.guards)

    def by_columns(self, force: Vector, bias: Vector, refining: bool) -> Solution:
        """x and lambda for L^-1 f and a; `refining` by the columns of A."""
        asked, columns = self.asked(bias), self._orthogonal.chosen(self._columns)
        left_over = of_columns(self._graph, columns, self.weights, force, asked)
        return self._solution(force, asked, left_over if refining else None)

    def _solution(
        self, force: Vector, asked: Vector, left_over: Callable[[Vector, Vector], Solution] | None
    ) -> Solution:
        solution = self._solved(force, asked)
        if self._r and left_over is not None:
            solution = refined(self._graph, solution, left_over, self._solved)
        x, multipliers = solution
        if isinstance(self._orthogonal, PivotedGramSchmidt):
            multipliers = self._orthogonal.of_all(self._all_rows, multipliers)
        return x, multipliers

    def _solved(self, force: Vector, asked: Vector) -> Solution:
        return self._orthogonal.solve(force, asked, self._again)


def elimination_order(mass_matrix: Matrix) -> list[int]:
    """The coordinates from those that carry least to those that carry most: outer links before inner ones."""
    return sorted(range(len(mass_matrix)), key=lambda i: (mass_matrix[i][i].size, -i))


class OrderedCholesky:
    """G = L D L^T in the order of elimination.

    What an inner coordinate holds of the outer ones is taken off again as it stands, and exactly where nothing else is
    in between; the other way round the pivot of a light link is a difference of heavy ones.
    """

    def __init__(self, problem: Problem) -> None:
        graph, mass_matrix = problem.graph, problem.mass_matrix
        self.order = elimination_order(mass_matrix)
        turned = tuple(tuple(mass_matrix[i][j] for j in self.order) for i in self.order)
        self._factor = Cholesky(graph, turned, diagonal_sizes(graph, turned, Definite(problem.mechanics).adds_up))
        self.pivots: Sequence[Scalar] = self._factor.pivots
        self.guards = self._factor.guards

    def lowered(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L y = b."""
        return self._factor.lowered([b[i] for i in self.order])

    def raised(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L^T x = b."""
        by_coordinate = dict(zip(self.order, self._factor.raised(b), strict=True))
        return tuple(by_coordinate[i] for i in range(len(self.order)))
