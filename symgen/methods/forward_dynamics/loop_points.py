"""Rows that hold places of points in space, along the axes of any frame: their forces and their accelerations.

Along the axes of a platform each row of a leg's ball joint holds three of its six motions, in world axes up to all of
them.  B_dot q_dot is R (a + U r) of the points while no rate changes: at hand from the equations of motion
frame by frame; the derivative of B q_dot along q_dot knows nothing of them and turns every product of rotations anew.
In a plane the sums of angles carry places directly, which is shorter.
"""

from __future__ import annotations

from collections.abc import Mapping

from symgen.mechanics.held_rows import with_leaves
from symgen.mechanics.rigid_bodies.articulated_inertias import Six
from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.mechanics.rigid_bodies.newton_euler import FrameMotion
from symgen.mechanics.system import System
from symgen.model.kinematics.components import components_in
from symgen.model.kinematics.triples import applied, cross, plus, transposed, triple
from symgen.model.mechanism import WORLD, component
from symgen.records import dataclass
from symgen.symbolic.calculus import gradient
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import reached


@dataclass(frozen=True, slots=True)
class HeldPoint:
    """A place that is fixed in a frame; `weight` times it stands in the rows."""

    weight: Scalar
    frame: str
    at: Vector3


@dataclass(frozen=True, slots=True)
class LoopPoint:
    """The rows that hold the same sum of places of points and nothing else that moves, in the order of their axes."""

    rows: Mapping[int, int]
    points: tuple[HeldPoint, ...]

    @property
    def frames(self) -> tuple[str, ...]:
        """The frames of the points."""
        return tuple(dict.fromkeys(point.frame for point in self.points))


def loop_points(mechanics: System, in_planes: bool = False) -> list[LoopPoint]:
    """The geometric rows that hold points, those of one loop together: in space, and where asked for in planes."""
    graph, kinematics = mechanics.graph, mechanics.bodies.kinematics
    components = [component(name) for name in components_in(mechanics.model)]
    held = {one.owner: place for one in components if (place := _fixed(mechanics, one.owner)) is not None}
    if not in_planes and all(kinematics.plane(WORLD, frame) is not None for frame, _ in held.values()):
        return []
    names, leaves = with_leaves(mechanics, list(held))
    places = {leaf: (owner, axis) for owner, three in leaves.items() for axis, leaf in enumerate(three)}
    by_weights: dict[tuple[tuple[str, Scalar], ...], dict[int, int]] = {}
    rows = [row.expression for row in mechanics.model.constraints if row.kind == "geometric"]
    for i, expression in enumerate(rows):
        residual = translate(graph, expression, names)
        slopes = zip(gradient(graph, residual, list(places)), places.values(), strict=True)
        own = [(owner, axis, slope) for slope, (owner, axis) in slopes if not slope.is_zero]
        axes = {axis for _, axis, _ in own}
        moves = not reached([residual]).isdisjoint(mechanics.q)
        taken = in_planes or any(kinematics.plane(WORLD, held[owner][0]) is None for owner, _, _ in own)
        if taken and len(axes) == 1 and not moves and all(slope.constant is not None for _, _, slope in own):
            by_weights.setdefault(tuple((owner, slope) for owner, _, slope in own), {})[axes.pop()] = i
    return [
        LoopPoint(dict(sorted(by_axis.items())), tuple(HeldPoint(slope, *held[owner]) for owner, slope in weights))
        for weights, by_axis in by_weights.items()
    ]


def wrenches(mechanics: System, loop: LoopPoint, axes: str) -> tuple[dict[str, Six], ...]:
    """What multipliers of 1 along these axes put on frames: moment and force in the frame's axes."""
    along_axes: tuple[dict[str, Six], ...] = ({}, {}, {})
    for point in loop.points:
        directions = transposed(mechanics.bodies.kinematics.axes(axes, point.frame))
        for loads, direction in zip(along_axes, directions, strict=True):
            force = triple([point.weight * x for x in direction])
            load = (*cross(point.at, force), *force)
            before = loads.get(point.frame)
            loads[point.frame] = load if before is None else tuple(a + b for a, b in zip(before, load, strict=True))
    return along_axes


def acceleration(mechanics: System, motions: Mapping[str, FrameMotion], loop: LoopPoint, axes: str) -> Vector3:
    """The rows' part of B_dot q_dot, along these axes, by how frames move while no rate changes."""
    kinematics, graph = mechanics.bodies.kinematics, mechanics.graph
    parts = []
    for point in loop.points:
        motion = motions[point.frame]
        own = plus(motion.linear, applied(motion.field, point.at))
        turned = applied(transposed(kinematics.axes(axes, point.frame)), own)
        parts.append([point.weight * x for x in turned])
    # motions fall with gravity, which matters only where weights do not add up to 0
    falling = graph.sum(point.weight for point in loop.points)
    gravity = applied(transposed(kinematics.axes(axes)), mechanics.working_gravity)
    return triple([graph.sum((*terms, falling * g)) for *terms, g in zip(*parts, gravity, strict=True)])


def _fixed(mechanics: System, owner: str) -> tuple[str, Vector3] | None:
    """Frame and place of a point that does not move in its frame, or of a frame's origin."""
    kinematics = mechanics.bodies.kinematics
    point = kinematics.points.get(owner)
    if point is None:
        return owner, kinematics.space.origin
    at = kinematics.space.values(point.at)
    return (point.frame, at) if all(map(mechanics.factoring.fixed, at)) else None
