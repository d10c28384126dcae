"""B_dot q_dot of loops closed in space, by the accelerations of their points: R (a + U r) while no rate changes.

Frame by frame they are at hand from the equations of motion; the derivative of B q_dot along q_dot knows nothing of
them and turns every product of rotations anew.  In a plane the sums of angles carry places directly, which is shorter.
"""

from __future__ import annotations

from collections.abc import Mapping

from symgen.dynamics.bodies import Vector3
from symgen.dynamics.free_bodies import with_leaves
from symgen.dynamics.mechanics import Mechanics
from symgen.dynamics.newton_euler import Motion, frame_motions
from symgen.graph.calculus import gradient
from symgen.graph.scalar import Scalar
from symgen.graph.translate import translate
from symgen.graph.traverse import reached
from symgen.model.components import components_in
from symgen.model.mechanism import WORLD, component
from symgen.model.triples import applied, plus


def loop_accelerations(mechanics: Mechanics) -> dict[int, Scalar]:
    """Entries of B_dot q_dot by row: of geometric rows that are linear in places of points and hold nothing else."""
    graph = mechanics.graph
    owners = list(dict.fromkeys(component(name).owner for name in components_in(mechanics.model)))
    if not any(_in_space(mechanics, owner) for owner in owners):
        return {}
    rest = (graph.zero,) * mechanics.n
    motions = frame_motions(mechanics.bodies, mechanics.qd, rest, mechanics.bodies.gravity)
    accelerations = {
        owner: acceleration
        for owner in owners
        if (acceleration := _acceleration(mechanics, motions, owner)) is not None
    }
    names, leaves = with_leaves(mechanics, list(accelerations))
    known = {leaf: (owner, k) for owner, three in leaves.items() for k, leaf in enumerate(three)}
    found = {}
    rows = [row.expression for row in mechanics.model.constraints if row.kind == "geometric"]
    for i, expression in enumerate(rows):
        residual = translate(graph, expression, names)
        slopes = gradient(graph, residual, list(known))
        held = [(slope, *place) for slope, place in zip(slopes, known.values(), strict=True) if not slope.is_zero]
        moves = not reached([residual]).isdisjoint(mechanics.q)
        in_space = any(_in_space(mechanics, owner) for _, owner, _ in held)
        if in_space and not moves and all(slope.constant is not None for slope, _, _ in held):
            falls = graph.sum(
                graph.sum(slope for slope, _, j in held if j == k) * g for k, g in enumerate(mechanics.bodies.gravity)
            )
            found[i] = graph.sum(slope * accelerations[owner][k] for slope, owner, k in held) + falls
    return found


def _acceleration(mechanics: Mechanics, motions: Mapping[str, Motion], owner: str) -> Vector3 | None:
    """Of a point that is fixed in a frame with bodies, or of its origin, less gravity, in world axes."""
    kinematics = mechanics.bodies.kinematics
    point = kinematics.points.get(owner)
    frame = owner if point is None else point.frame
    at = kinematics.space.origin if point is None else kinematics.space.values(point.at)
    if frame not in motions or not all(map(mechanics.factoring.fixed, at)):
        return None
    motion = motions[frame]
    return applied(kinematics.axes(frame), plus(motion.linear, applied(motion.field, at)))


def _in_space(mechanics: Mechanics, owner: str) -> bool:
    kinematics = mechanics.bodies.kinematics
    point = kinematics.points.get(owner)
    return kinematics.plane(WORLD, owner if point is None else point.frame) is None
