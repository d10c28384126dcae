"""q_ddot and lambda by the null space of B, by (22) as corrected, and by the whole system at once."""

from __future__ import annotations

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import Cholesky, ConstrainedInertia, diagonal_sizes
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_spaces import NullSpace, Reflections
from symgen.linear_algebra.refinement import of_motion, refined
from symgen.methods.forward_dynamics.motion import MotionMethod, Problem
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, matvec, subtract_vectors
from symgen.symbolic.scalar import Scalar


def nullspace(problem: Problem, space: NullSpace, inertia: ConstrainedInertia) -> MotionMethod:
    """q_ddot = K (f + G B^+ a) - B^+ a, lambda = (B^+)^T (f - G q_ddot), with one step of refinement.

    It needs G positive definite on ker B only.  Both expressions lose what masses are apart by, in f - G q_ddot most of
    all; what the equations still ask for is solved for once more.
    """

    def solve(f: Vector, c: Vector) -> tuple[Vector, Vector]:
        lifted = space.lift(c)
        pushed = matvec(problem.graph, problem.mass_matrix, lifted)
        along = inertia.solve(subtract_vectors(f, pushed))
        q_ddot = tuple(x + y for x, y in zip(along, lifted, strict=True))
        return q_ddot, _reactions(problem, space, f, q_ddot)

    asked = tuple(-a for a in problem.bias)
    first = solve(problem.force, asked)
    left_over = of_motion(problem.graph, problem.mass_matrix, problem.rows, problem.force, asked)
    accelerations, multipliers = refined(problem.graph, first, left_over, solve)
    return MotionMethod(accelerations, multipliers, (*space.guards, *_own(space, inertia)))


def _own(space: NullSpace, inertia: ConstrainedInertia) -> tuple[Guard, ...]:
    return tuple(guard for guard in inertia.guards if guard not in space.guards)


def _reactions(problem: Problem, space: NullSpace, force: Vector, accelerations: Vector) -> Vector:
    inertial = matvec(problem.graph, problem.mass_matrix, accelerations)
    return space.lift_transposed(subtract_vectors(force, inertial))


def shifted(problem: Problem, space: NullSpace) -> MotionMethod:
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
    multipliers = _reactions(problem, space, problem.force, accelerations)
    return MotionMethod(accelerations, multipliers, (*space.guards, *factor.guards))


def kkt(problem: Problem) -> MotionMethod:
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
    return MotionMethod(tuple(solution[:n]), multipliers, (*problem.guards, *guards))


def _square(problem: Problem, column: Vector) -> Scalar:
    return dot(problem.graph, column, column)
