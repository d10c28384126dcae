"""q_ddot and lambda with friction that grows with the reactions it changes itself (Remark 3).

G q_ddot + B^T lambda = f - D(lambda), B q_ddot = -a: both are affine in the loads of rough places, as u is, with other
reactions for a unit of friction: the masses take part in them.  Where these return half of it there is a status; beyond
1 such equations have several solutions or none (Painleve).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from symgen.linear_algebra.constrained_inverse import ConstrainedInertia
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import NullSpace
from symgen.linear_algebra.refinement import of_motion, refined
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.minor_motion import MinorMotion, minor_motion
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.schur import SchurQR
from symgen.methods.friction.loads import FrictionLoads
from symgen.methods.friction.rough_columns import RoughColumns
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.symbolic.traverse import substitute

Solver: TypeAlias = Callable[[Vector, Vector], tuple[Vector, Vector]]
"""q_ddot and lambda for f and a."""


def rough_by_minors(derivation: Derivation) -> Motion:
    """The motion under the inputs, friction included, by the minors of B."""
    problem = Problem(derivation.mechanics, derivation.space.guards)
    minors = minor_motion(problem)
    return _with_friction(problem, _by_minors(problem, minors), minors.guards)


def rough_by_elimination(derivation: Derivation, refining: bool) -> Motion:
    """The same by elimination of the accelerations; `refining` solves for what it leaves once more."""
    problem = Problem(derivation.mechanics, derivation.space.guards)
    schur = SchurQR(problem, derivation.generic.rank)

    def solved(f: Vector, a: Vector) -> tuple[Vector, Vector]:
        made = schur.motion(f, a, refining)
        return made.accelerations, made.multipliers

    return _with_friction(problem, solved, schur.motion(problem.force, problem.bias, False).guards)


def rough_by_basis(derivation: Derivation) -> Motion:
    """The same by an orthonormal basis of the null space."""
    space, inertia = derivation.space, derivation.inertia
    problem = Problem(derivation.mechanics, space.guards)
    guards = (*space.guards, *(guard for guard in inertia.guards if guard not in space.guards))
    return _with_friction(problem, _by_basis(problem, space, inertia), guards)


def _by_minors(problem: Problem, minors: MinorMotion) -> Solver:
    def solved(f: Vector, a: Vector) -> tuple[Vector, Vector]:
        if f is problem.force and a is problem.bias:
            return minors.motion.accelerations, minors.motion.multipliers
        return minors.solve(f), minors.press(f)

    return solved


def _by_basis(problem: Problem, space: NullSpace, inertia: ConstrainedInertia) -> Solver:
    graph, mass_matrix = problem.graph, problem.mass_matrix

    def solve(f: Vector, c: Vector) -> tuple[Vector, Vector]:
        lifted = space.lift(c)
        along = inertia.solve(subtract_vectors(f, matvec(graph, mass_matrix, lifted)))
        q_ddot = tuple(x + y for x, y in zip(along, lifted, strict=True))
        return q_ddot, space.lift_transposed(subtract_vectors(f, matvec(graph, mass_matrix, q_ddot)))

    def solved(f: Vector, a: Vector) -> tuple[Vector, Vector]:
        asked = tuple(-x for x in a)
        return refined(graph, solve(f, asked), of_motion(graph, mass_matrix, problem.rows, f, asked), solve)

    return solved


def _with_friction(problem: Problem, solved: Solver, guards: tuple[Guard, ...]) -> Motion:
    """The motion that friction of the reactions which come of it leaves."""
    mechanics, graph, rough = problem.mechanics, problem.graph, RoughColumns(problem.mechanics)
    smooth, multipliers = solved(problem.force, problem.bias)
    beside = tuple(substitute(graph, rough.balance, dict(zip(mechanics.qdd, smooth, strict=True))))
    free = rough.loaded(rough.reactions(beside, mechanics.u, multipliers))
    unmoved = (graph.zero,) * mechanics.m
    units = [solved(tuple(-x for x in column), (graph.zero,) * mechanics.r) for column in rough.columns]
    answers = []
    for (accelerations, pressing), along in zip(units, rough.beside, strict=True):
        inertial = matvec(graph, rough.masses, accelerations)
        held = tuple(x + y for x, y in zip(along, inertial, strict=True))
        answers.append(rough.unloaded(rough.reactions(held, unmoved, pressing)))
    point = FrictionLoads(graph, free, answers, rough.sizes, rough.directions, mechanics.model.motion_steps)
    return Motion(
        point.added(smooth, [unit[0] for unit in units], point.loads),
        point.added(multipliers, [unit[1] for unit in units], point.loads),
        (*guards, *point.guards),
    )
