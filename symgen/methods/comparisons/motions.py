"""q_ddot and lambda by the whole system at once: long, to be compared with, and valid wherever they are determined."""

from __future__ import annotations

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import NullSpace
from symgen.linear_algebra.reflections import Reflections
from symgen.methods.forward_dynamics.along_spaces import along_space
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import AlongNullSpace, independent_rows
from symgen.methods.method import Method
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.scalar import Scalar


def kkt(problem: Problem, _: NullSpace) -> Motion:
    """The whole system [G, s B^T; s B, 0] by reflections, s = tr G / n: valid wherever it is regular."""
    graph, n, r = problem.graph, problem.n, problem.r
    zero = graph.zero
    size = graph.sum(problem.mass_matrix[i][i] for i in range(n)) / n
    columns: Matrix = (
        *((*problem.mass_matrix[j], *(row[j] * size for row in problem.rows)) for j in range(n)),
        *((*(x * size for x in row), *(zero,) * r) for row in problem.rows),
    )
    turned = Reflections(graph, columns, n + r)
    right = turned.apply_transposed((*problem.force, *(-a * size for a in problem.bias)))
    solution = list(right)
    for k in reversed(range(n + r)):
        solution[k] = solution[k] / turned.triangle[k][k]
        for i in range(k):
            solution[i] = solution[i] - turned.triangle[k][i] * solution[k]
    pairs = zip(turned.pivots, columns, strict=True)
    guards = tuple(Guard(Status.MASS_RANK, pivot, 2, scale=_square(problem, column)) for pivot, column in pairs)
    multipliers = tuple(x * size for x in solution[n:])
    return Motion(tuple(solution[:n]), multipliers, (*problem.guards, *guards))


def _square(problem: Problem, column: Vector) -> Scalar:
    return dot(problem.graph, column, column)


KKT: Method = AlongNullSpace(along_space(kkt), "its pivots are those of the whole system", independent_rows)
