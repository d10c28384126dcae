"""q_ddot and lambda by elimination of the accelerations: G = L D L^T, then the constraints in the metric of G^-1.

With A = L^-1 B^T the system G q_ddot + B^T lambda = f, B q_ddot = -a becomes x + A lambda = L^-1 f, A^T D^-1 x = -a
for x = D L^T q_ddot.  `schur_qr` factorises A by reflections that are orthogonal in the metric D^-1, so that the
squared condition number of A^T D^-1 A is never met; `schur_ldl` forms that matrix, which is shorter and loses it
(Golub and Van Loan, Matrix Computations, 4.1 and 5.2; Bjorck, Least Squares Problems, 2.8 for weights).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from symgen.dynamics.forms.motion import Motion, Problem
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
    """By A = Q R with reflections: valid wherever G is positive definite and B has full rank."""
    factor = Cholesky(problem.graph, problem.mass_matrix, diagonal_sizes(problem.graph, problem.mass_matrix))
    columns = [factor.lowered(row) for row in problem.rows]
    return along_factor(problem, factor, columns, factor.lowered(problem.force))


def along_factor(problem: Problem, factor: Factor, columns: Sequence[Vector], force: Vector) -> Motion:
    """The same for any factor of G; `columns` are those of A, `force` is L^-1 f."""
    graph, r = problem.graph, problem.r
    weights = tuple(1 / pivot for pivot in factor.pivots)
    turned = WeightedReflections(graph, columns, factor.pivots, weights)
    free = turned.apply_transposed(force)
    # R^T D^-1 z = a, with the first r weights of D^-1
    given = _solve_lower(graph, turned.triangle, factor.pivots, problem.bias)
    multipliers = _solve_upper(turned.triangle, [f + z for f, z in zip(free, given, strict=False)])
    x = turned.apply((*(-z for z in given), *free[r:]))
    accelerations = factor.raised(tuple(entry * weight for entry, weight in zip(x, weights, strict=True)))
    # with many rows the rank of B is measured where they are reflected anyway
    regular = (turned.regularity(),) if r > LONGEST_PRODUCT else problem.guards
    return Motion(accelerations, multipliers, (*regular, *factor.guards))


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


class WeightedReflections:
    """Reflections x -> x - 2 v (v, x)/(v, v) in the metric (x, y) = sum_i x_i y_i / d_i that make columns triangular.

    They are Householder's for the rows divided by sqrt(d_i), without the roots.
    """

    def __init__(self, graph: Graph, columns: Sequence[Vector], d: Sequence[Scalar], weights: Sequence[Scalar]) -> None:
        self._graph = graph
        self._columns = columns
        self._weights = weights
        self._reflectors: list[tuple[int, Vector, Scalar]] = []
        self.triangle: list[Vector] = []
        for k, column in enumerate(columns):
            y = self.apply_transposed(column)
            tail = y[k:]
            head = tail[0]
            if all(entry.is_zero for entry in tail[1:]):
                self.triangle.append((*y[:k], head))
                continue
            # the length that the first component must have: reach^2/d_k = (tail, tail)
            squared = head * head + d[k] * graph.sum(
                x * x * w for x, w in zip(tail[1:], weights[k + 1 :], strict=True)
            )
            length = graph.function("sqrt", (squared,))
            signed = length if head.is_zero else graph.function("copysign", (length, head))
            # (v, v)/2 = length (length + |head|) / d_k
            factor = d[k] / (squared + length * graph.function("abs", (head,)))
            self._reflectors.append((k, (head + signed, *tail[1:]), factor))
            self.triangle.append((*y[:k], -signed))

    def regularity(self) -> Guard:
        """det(A^T D^-1 A) over the squared lengths of the columns: 0 exactly where columns depend on each other."""
        graph, weights = self._graph, self._weights
        quotients = []
        for k, (column, reflected) in enumerate(zip(self._columns, self.triangle, strict=True)):
            pivot = reflected[k]
            length = graph.sum(x * x * w for x, w in zip(column, weights, strict=True))
            quotients.append(pivot * pivot * weights[k] / length)
        return Guard(Status.CONSTRAINT_RANK, graph.product(quotients), 2, scale=graph.one)

    def apply_transposed(self, x: Vector) -> Vector:
        """The reflections in the order in which they were made."""
        for reflector in self._reflectors:
            x = self._reflect(reflector, x)
        return x

    def apply(self, x: Vector) -> Vector:
        """The reflections in the opposite order: the inverse."""
        for reflector in reversed(self._reflectors):
            x = self._reflect(reflector, x)
        return x

    def _reflect(self, reflector: tuple[int, Vector, Scalar], x: Vector) -> Vector:
        k, v, factor = reflector
        weighted = tuple(a * w for a, w in zip(v, self._weights[k:], strict=True))
        share = dot(self._graph, weighted, x[k:]) * factor
        return (*x[:k], *(entry - share * component for entry, component in zip(x[k:], v, strict=True)))


def _solve_lower(
    graph: Graph, triangle: Sequence[Vector], d: Sequence[Scalar], right: Sequence[Scalar]
) -> list[Scalar]:
    """z with sum_i R_ik z_i / d_i = right_k."""
    z: list[Scalar] = []
    weighted: list[Scalar] = []
    for k, column in enumerate(triangle):
        rest = right[k] - dot(graph, column[:k], weighted)
        weighted.append(rest / column[k])
        z.append(weighted[k] * d[k])
    return z


def _solve_upper(triangle: Sequence[Vector], right: Sequence[Scalar]) -> Vector:
    """x with sum_k R_ik x_k = right_i."""
    x = list(right)
    for k in reversed(range(len(triangle))):
        x[k] = x[k] / triangle[k][k]
        for i in range(k):
            x[i] = x[i] - triangle[k][i] * x[k]
    return tuple(x)
