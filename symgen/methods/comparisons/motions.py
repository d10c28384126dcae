"""q_ddot and lambda by (22) as corrected, by the Schur complement itself, and by the whole system at once.

The first two lose digits with the square of the condition number of B, the last is long: they are taken only where
verification rejects all others, and are there to be compared with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import Cholesky, diagonal_sizes
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_spaces import NullSpace
from symgen.linear_algebra.reflections import Reflections
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.along_spaces import reactions
from symgen.methods.forward_dynamics.held_lengths import completed_multipliers
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import POSITIVE, SQUARED, AlongNullSpace, constraints, independent_rows
from symgen.methods.method import Method
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, matvec
from symgen.symbolic.scalar import Scalar


def _completed(solved: Callable[[Problem, NullSpace], Motion]) -> Callable[[Derivation], Motion]:
    """Along the null space of a derivation, with the multipliers of rows that hold lengths."""

    def made(derivation: Derivation) -> Motion:
        completed = completed_multipliers(derivation.mechanics)
        found = solved(Problem(derivation.mechanics, derivation.space.guards), derivation.space)
        return replace(found, multipliers=completed(found.multipliers))

    return made


def shifted(problem: Problem, space: NullSpace) -> Motion:
    """(22) as corrected: (N G N + mu P) q_ddot = N f + N G l - mu l with l = B^+ a and mu = tr G / n (errata, C)."""
    graph, n, projector = problem.graph, problem.n, space.projector
    inner = matmul(graph, matmul(graph, projector, problem.mass_matrix, n), projector, n)
    mu = graph.sum(problem.mass_matrix[i][i] for i in range(n)) / n
    eye = identity(graph, n)
    system = tuple(
        tuple(inner[min(i, j)][max(i, j)] + mu * (eye[i][j] - projector[i][j]) for j in range(n)) for i in range(n)
    )
    g = diagonal_sizes(graph, problem.mass_matrix)
    scales = [
        graph.sum(x * x * size for x, size in zip(row, g, strict=True)) + mu * (1 - row[k])
        for k, row in enumerate(projector)
    ]
    factor = Cholesky(graph, system, scales)
    lifted = space.lift(problem.bias)
    pushed = matvec(graph, problem.mass_matrix, lifted)
    right = space.project(tuple(f + g for f, g in zip(problem.force, pushed, strict=True)))
    accelerations = factor.solve(tuple(x - mu * y for x, y in zip(right, lifted, strict=True)))
    multipliers = reactions(problem, space, problem.force, accelerations)
    return Motion(accelerations, multipliers, (*space.guards, *factor.guards))


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


def schur_ldl(problem: Problem, _: NullSpace) -> Motion:
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


SCHUR_LDL: Method = AlongNullSpace(_completed(schur_ldl), POSITIVE + SQUARED, independent_rows, free=True)
SHIFTED: Method = AlongNullSpace(
    _completed(shifted), "its matrix is positive definite where G is so along the constraints" + SQUARED, constraints
)
KKT: Method = AlongNullSpace(_completed(kkt), "its pivots are those of the whole system", independent_rows)
