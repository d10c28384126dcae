"""u by (18) and by the whole system: N_{B,G}^T tau = N_{B,G}^T M u, and the conditions of least norm.

Both work on matrices of the whole size and square the condition of B; they are here to be compared with.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import Cholesky, diagonal_sizes
from symgen.linear_algebra.exterior import ActuationForms, RowForms
from symgen.linear_algebra.guards import Guard
from symgen.methods.admission import OfInputs
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, matvec, subtract_vectors


def weighted_candidate(system: MethodInput) -> Candidate | str:
    """u = (N_{B,G}^T M)^+ N_{B,G}^T tau with N_{B,G}^T x = x - B^T (B G^-1 B^T)^-1 B G^-1 x (17)-(19).

    It needs G positive definite, independent rows and full actuation.
    """
    reason = system.driven or system.regular
    if reason is not None:
        return reason
    mechanics, generic = system.mechanics, system.generic
    graph, b = mechanics.graph, mechanics.constraint_jacobian
    whole = Cholesky(graph, mechanics.mass_matrix, diagonal_sizes(graph, mechanics.mass_matrix))
    schur = _Schur(graph, whole, b)
    columns = [schur.project(column) for column in mechanics.inputs]
    forms = ActuationForms(RowForms(graph, (), mechanics.n, 0), columns, generic.alpha)
    u = forms.solve(schur.project(mechanics.balance))
    # an oblique projection may lengthen a column or take it away
    squares = [
        dot(graph, projected, projected) + dot(graph, plain, plain)
        for projected, plain in zip(columns, mechanics.inputs, strict=True)
    ]
    scale = graph.sum(graph.product(squares[k] for k in subset) for subset in forms.subsets)
    denominator = forms.denominator()
    square = denominator * denominator if forms.single else denominator
    rank = Guard(Status.ACTUATION_RANK, square, 2, scale=scale, directions=generic.alpha)
    return solved_for_u(system, u, (*whole.guards, *schur.guards, rank))


def kkt_candidate(system: MethodInput) -> Candidate | str:
    """min |u|^2 with M u - B^T lambda = tau: [S, B^T; B, 0] (mu, -lambda) = (tau, 0) and u = M^T mu.

    S is M M^T + B^T B in place of M M^T, which changes nothing because B mu = 0.  S is positive definite exactly where
    [M, B^T] has rank n, so that L D L^T needs no pivoting; B S^-1 B^T is positive definite where B keeps its rank.
    Independent rows and full actuation are needed.
    """
    reason = system.driven or system.regular
    if reason is not None:
        return reason
    mechanics, n = system.mechanics, system.mechanics.n
    graph, b = mechanics.graph, mechanics.constraint_jacobian
    vectors = (*mechanics.inputs, *b)
    s = tuple(tuple(graph.sum(v[i] * v[j] for v in vectors) for j in range(n)) for i in range(n))
    whole = Cholesky(graph, s, diagonal_sizes(graph, s))
    mu = whole.solve(mechanics.balance)
    if mechanics.r:
        schur = _Schur(graph, whole, b)
        multipliers = schur.factor.solve(matvec(graph, b, mu))
        forces = tuple(dot(graph, [row[i] for row in b], multipliers) for i in range(n))
        mu = whole.solve(subtract_vectors(mechanics.balance, forces))
        guards = (*_as(Status.ACTUATION_RANK, whole.guards), *schur.guards)
    else:
        guards = _as(Status.ACTUATION_RANK, whole.guards)
    u = tuple(dot(graph, column, mu) for column in mechanics.inputs)
    return solved_for_u(system, u, guards)


class _Schur:
    """B A^-1 B^T for a factored positive definite A."""

    def __init__(self, graph: Graph, whole: Cholesky, b: Matrix) -> None:
        self._graph, self._whole, self._b = graph, whole, b
        solved = [whole.solve(row) for row in b]
        size = len(b)
        entries = {(i, j): dot(graph, b[i], solved[j]) for i in range(size) for j in range(i, size)}
        a = tuple(tuple(entries[min(i, j), max(i, j)] for j in range(size)) for i in range(size))
        # what a pivot is measured by: the diagonal entry it started from
        self.factor = Cholesky(graph, a, [a[i][i] for i in range(size)])
        self.guards = _as(Status.CONSTRAINT_RANK, self.factor.guards)

    def project(self, x: Vector) -> Vector:
        """x - B^T (B A^-1 B^T)^-1 B A^-1 x."""
        graph, b = self._graph, self._b
        if not b:
            return x
        weights = self.factor.solve(matvec(graph, b, self._whole.solve(x)))
        return tuple(value - dot(graph, [row[i] for row in b], weights) for i, value in enumerate(x))


def _as(status: Status, guards: tuple[Guard, ...]) -> tuple[Guard, ...]:
    return tuple(replace(guard, status=status) for guard in guards)


WEIGHTED: Method = OfInputs(lambda workspace: weighted_candidate(workspace.fresh()))
KKT: Method = OfInputs(lambda workspace: kkt_candidate(workspace.fresh()))
