"""q_ddot and lambda by the null space of B."""

from __future__ import annotations

from symgen.linear_algebra.constrained_inverse import ConstrainedInertia
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_spaces import NullSpace
from symgen.linear_algebra.refinement import of_motion, refined
from symgen.methods.forward_dynamics.motion import MotionMethod, Problem
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors


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
        return q_ddot, reactions(problem, space, f, q_ddot)

    asked = tuple(-a for a in problem.bias)
    first = solve(problem.force, asked)
    left_over = of_motion(problem.graph, problem.mass_matrix, problem.rows, problem.force, asked)
    accelerations, multipliers = refined(problem.graph, first, left_over, solve)
    return MotionMethod(accelerations, multipliers, (*space.guards, *_own(space, inertia)))


def _own(space: NullSpace, inertia: ConstrainedInertia) -> tuple[Guard, ...]:
    return tuple(guard for guard in inertia.guards if guard not in space.guards)


def reactions(problem: Problem, space: NullSpace, force: Vector, accelerations: Vector) -> Vector:
    """lambda = (B^+)^T (f - G q_ddot)."""
    inertial = matvec(problem.graph, problem.mass_matrix, accelerations)
    return space.lift_transposed(subtract_vectors(force, inertial))
