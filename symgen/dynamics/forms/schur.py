"""q_ddot and lambda by elimination of the accelerations: G = L D L^T, then the constraints in the metric of G^-1.

With A = L^-1 B^T the system G q_ddot + B^T lambda = f, B q_ddot = -a becomes x + A lambda = L^-1 f, A^T D^-1 x = -a
for x = D L^T q_ddot.  `schur_qr` factorises A = V R with columns of V that are orthogonal in the metric D^-1, so that
the squared condition number of A^T D^-1 A is never met; `schur_ldl` forms that matrix, which is shorter and loses it
(Golub and Van Loan, Matrix Computations, 4.1 and 5.2; Bjorck, Numerical Methods for Least Squares Problems, 2.4 and
4.4).

A = V R comes by the modified Gram-Schmidt process, not by reflections: where masses are far apart the rows of A are of
very different size, and reflections mix them unless they are sorted.  Here each entry changes by a multiple of the
entry of the column that is taken out, in its own row.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from symgen.dynamics.forms.motion import Motion, Problem
from symgen.dynamics.forms.refinement import refined
from symgen.dynamics.guards import Guard
from symgen.dynamics.inertia import Cholesky, diagonal_sizes
from symgen.dynamics.spaces import LONGEST_PRODUCT
from symgen.graph.matrix import Matrix, Vector, dot
from symgen.graph.scalar import Graph, Scalar
from symgen.ir.kernel import Status


class Factor(Protocol):
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


def schur_qr(problem: Problem) -> Motion:
    """By A = V R, with one step of refinement: valid wherever G is positive definite and B has full rank.

    Where masses are far apart the lightest ones decide, in the metric of G^-1, on what the others are lost beside; what
    the equations still ask for is solved for once more (Higham, Accuracy and Stability of Numerical Algorithms, 12.2).
    """
    g = problem.mass_matrix
    factor = Cholesky(problem.graph, g, diagonal_sizes(problem.graph, g))
    elimination = _Elimination(problem, factor, [factor.lowered(row) for row in problem.rows])
    solution = elimination.solve(problem.force, tuple(-a for a in problem.bias))
    if problem.r:
        solution = refined(problem, solution, elimination.solve)
    return Motion(*solution, elimination.guards)


def along_factor(problem: Problem, factor: Factor, columns: Sequence[Vector], force: Vector) -> Motion:
    """The same without refinement for any factor of G; `columns` are those of A, `force` is L^-1 f."""
    elimination = _Elimination(problem, factor, columns)
    accelerations, multipliers = elimination.solve_lowered(force, tuple(-a for a in problem.bias))
    return Motion(accelerations, multipliers, elimination.guards)


class _Elimination:
    """G q_ddot + B^T lambda = f, B q_ddot = c for any f and c."""

    def __init__(self, problem: Problem, factor: Factor, columns: Sequence[Vector]) -> None:
        self._factor = factor
        self._weights = tuple(1 / pivot for pivot in factor.pivots)
        self._orthogonal = WeightedGramSchmidt(problem.graph, columns, self._weights)
        # with many rows the rank of B is measured where they are made orthogonal anyway
        regular = (self._orthogonal.regularity(),) if problem.r > LONGEST_PRODUCT else problem.guards
        self.guards = (*regular, *factor.guards)

    def solve(self, f: Vector, c: Vector) -> tuple[Vector, Vector]:
        """q_ddot and lambda."""
        return self.solve_lowered(self._factor.lowered(f), c)

    def solve_lowered(self, force: Vector, c: Vector) -> tuple[Vector, Vector]:
        """q_ddot and lambda from L^-1 f."""
        x, multipliers = self._orthogonal.solve(force, c)
        return self._factor.raised(tuple(y * w for y, w in zip(x, self._weights, strict=True))), multipliers


def schur_ldl(problem: Problem) -> Motion:
    """By L D L^T of A^T D^-1 A = B G^-1 B^T: shorter, with an error that grows with the square of B's condition."""
    graph = problem.graph
    factor = Cholesky(graph, problem.mass_matrix, diagonal_sizes(graph, problem.mass_matrix))
    weights = tuple(1 / pivot for pivot in factor.pivots)
    columns = [factor.lowered(row) for row in problem.rows]
    weighted = [tuple(x * w for x, w in zip(column, weights, strict=True)) for column in columns]
    upper = {
        (i, j): dot(graph, weighted[i], columns[j]) for i in range(len(columns)) for j in range(i, len(columns))
    }
    schur: Matrix = tuple(
        tuple(upper[min(i, j), max(i, j)] for j in range(len(columns))) for i in range(len(columns))
    )
    inner = Cholesky(graph, schur, [schur[i][i] for i in range(len(schur))])
    force = factor.lowered(problem.force)
    right = [dot(graph, column, force) + a for column, a in zip(weighted, problem.bias, strict=True)]
    multipliers = inner.solve(right)
    rest = [
        f - graph.sum(column[i] * x for column, x in zip(columns, multipliers, strict=True))
        for i, f in enumerate(force)
    ]
    accelerations = factor.raised(tuple(entry * weight for entry, weight in zip(rest, weights, strict=True)))
    return Motion(accelerations, multipliers, (*problem.guards, *factor.guards))


class WeightedGramSchmidt:
    """A = V R by the modified Gram-Schmidt process in the metric (x, y) = sum_i x_i y_i w_i; R has a unit diagonal.

    No roots are taken: V keeps the lengths that are left of the columns.
    """

    def __init__(self, graph: Graph, columns: Sequence[Vector], weights: Sequence[Scalar]) -> None:
        self._graph, self._columns, self._metric = graph, columns, weights
        left = list(columns)
        self._directions: list[Vector] = []
        self._weighted: list[Vector] = []
        self._squares: list[Scalar] = []
        self._inverses: list[Scalar] = []
        self._upper: list[list[Scalar]] = [[] for _ in columns]  # column j of R above the diagonal
        for k, direction in enumerate(left):
            weighted = tuple(x * w for x, w in zip(direction, weights, strict=True))
            square = dot(graph, weighted, direction)
            inverse = 1 / square
            self._directions.append(direction)
            self._weighted.append(weighted)
            self._squares.append(square)
            self._inverses.append(inverse)
            for j in range(k + 1, len(left)):
                share = dot(graph, weighted, left[j]) * inverse
                self._upper[j].append(share)
                left[j] = _less(left[j], share, direction)

    def regularity(self) -> Guard:
        """det(A^T D^-1 A) over the squared lengths of the columns: 0 exactly where columns depend on each other."""
        graph = self._graph
        lengths = (graph.sum(x * x * w for x, w in zip(c, self._metric, strict=True)) for c in self._columns)
        quotients = [square / length for square, length in zip(self._squares, lengths, strict=True)]
        return Guard(Status.CONSTRAINT_RANK, graph.product(quotients), 2, scale=graph.one)

    def solve(self, b: Vector, c: Sequence[Scalar]) -> tuple[Vector, Vector]:
        """y and l of y + A l = b, A^T W y = c.

        Components along V are taken out of b one by one, and given back in the opposite order from what is there: what
        rounding has left of them on the way does not stay (Bjorck and Paige, SIAM J. Matrix Anal. Appl. 15, 1994).
        """
        graph, count = self._graph, len(self._directions)
        asked: list[Scalar] = []  # (V^T W y)_k
        for k in range(count):
            asked.append(c[k] - dot(graph, self._upper[k], asked))
        y, shares = b, list[Scalar]()
        for k in range(count):
            along = dot(graph, self._weighted[k], y)
            y = _less(y, along * self._inverses[k], self._directions[k])
            shares.append((along - asked[k]) * self._inverses[k])
        for k in reversed(range(count)):
            surplus = dot(graph, self._weighted[k], y) - asked[k]
            y = _less(y, surplus * self._inverses[k], self._directions[k])
        for k in reversed(range(count)):
            for i, entry in enumerate(self._upper[k]):
                shares[i] = shares[i] - entry * shares[k]
        return y, tuple(shares)


def _less(x: Vector, share: Scalar, direction: Vector) -> Vector:
    return tuple(entry - share * component for entry, component in zip(x, direction, strict=True))
