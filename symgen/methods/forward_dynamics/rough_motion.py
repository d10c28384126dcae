"""q_ddot and lambda with friction that grows with the reactions it changes itself (Remark 3).

G q_ddot + B^T lambda = f - D(lambda), B q_ddot = -a: both are affine in the loads of rough places, as u is, with other
reactions for a unit of friction: the masses take part in them.  Where these return half of it there is a status; beyond
1 such equations have several solutions or none (Painleve).
"""

from __future__ import annotations

from symgen.linear_algebra.refinement import of_motion, refined
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.friction_loads import FrictionLoads
from symgen.methods.rough_columns import RoughColumns
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.symbolic.traverse import substitute


def rough_motion(derivation: Derivation) -> Motion:
    """The motion under the inputs, friction included, along a null space."""
    mechanics, graph, space, inertia = derivation.mechanics, derivation.graph, derivation.space, derivation.inertia
    problem, rough = Problem(mechanics, space.guards), RoughColumns(mechanics)

    def solve(f: Vector, c: Vector) -> tuple[Vector, Vector]:
        lifted = space.lift(c)
        along = inertia.solve(subtract_vectors(f, matvec(graph, mechanics.mass_matrix, lifted)))
        q_ddot = tuple(x + y for x, y in zip(along, lifted, strict=True))
        rest = subtract_vectors(f, matvec(graph, mechanics.mass_matrix, q_ddot))
        return q_ddot, space.lift_transposed(rest) if mechanics.r else ()

    def solved(f: Vector, c: Vector) -> tuple[Vector, Vector]:
        left_over = of_motion(graph, mechanics.mass_matrix, problem.rows, f, c)
        return refined(graph, solve(f, c), left_over, solve)

    still, unmoved = (graph.zero,) * mechanics.r, (graph.zero,) * mechanics.m
    smooth, multipliers = solved(problem.force, tuple(-a for a in problem.bias))
    beside = substitute(graph, rough.balance, dict(zip(mechanics.qdd, smooth, strict=True)))
    free = rough.reactions(tuple(beside), mechanics.u, multipliers)
    units = [solved(tuple(-x for x in column), still) for column in rough.columns]
    answers = []
    for (accelerations, pressing), along in zip(units, rough.beside, strict=True):
        inertial = matvec(graph, rough.masses, accelerations)
        answers.append(rough.reactions(tuple(x + y for x, y in zip(along, inertial, strict=True)), unmoved, pressing))
    steps = mechanics.model.motion_steps
    point = FrictionLoads(graph, free, answers, rough.sizes, rough.directions, steps)
    own = tuple(guard for guard in inertia.guards if guard not in space.guards)
    return Motion(
        point.added(smooth, [unit[0] for unit in units], point.loads),
        point.added(multipliers, [unit[1] for unit in units], point.loads),
        (*space.guards, *own, *point.guards),
    )
