"""q_ddot and lambda by (22) as corrected, in which G stands between projections.

It loses digits with the square of the condition number of B, and is taken only where verification rejects all others.
"""

from __future__ import annotations

from symgen.linear_algebra.constrained_inverse import Cholesky, diagonal_sizes
from symgen.linear_algebra.null_space.null_spaces import NullSpace
from symgen.methods.forward_dynamics.along_spaces import along_space, reactions
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import AlongNullSpace, constraints
from symgen.methods.method import Method
from symgen.symbolic.matrix import identity, matmul, matvec

_THEOREM = (
    "its matrix is positive definite where G is so along the constraints; it loses digits with the square of the "
    "condition of B"
)


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


SHIFTED: Method = AlongNullSpace(along_space(shifted), _THEOREM, constraints)
