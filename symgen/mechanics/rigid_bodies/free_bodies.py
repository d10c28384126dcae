"""Bodies that six coordinates of their own move, three along the axes of the world and three turns, and nothing else.

What is needed for twists in place of rates (`body_axes`): the six coordinates stand in nothing but the place and the
attitude of one frame, on the way to which nothing has mass, and of that frame only places of points are used, in
geometric constraints.  No input, spring, friction, rotor or energy that is written out knows them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from symgen.mechanics.held_rows import with_leaves
from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.components import components_in
from symgen.model.mechanism import WORLD, component
from symgen.records import dataclass
from symgen.symbolic.calculus import gradient
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import reached


@dataclass(frozen=True, slots=True)
class FreeBody:
    """A frame that three coordinates move along the axes of the world and three others turn.

    `places` and `angles` are the numbers of these coordinates, `points` the points (or the frame itself) that geometric
    constraints hold, with their places in the frame.
    """

    frame: str
    places: tuple[int, int, int]
    angles: tuple[int, int, int]
    points: tuple[tuple[str, Vector3], ...]

    @property
    def coordinates(self) -> tuple[int, ...]:
        """Where force and moment stand among the rows."""
        return (*self.places, *self.angles)


def free_bodies(mechanics: System) -> tuple[FreeBody, ...]:
    """The frames whose six coordinates do nothing but move them, driven and braked by nothing but constraints."""
    if not mechanics.model.mechanism.has_mass or mechanics.change is not None:
        return ()
    parents = {frame.parent for frame in mechanics.bodies.mechanism.frames}
    frames = [frame.name for frame in mechanics.bodies.mechanism.frames if frame.name not in parents]
    return tuple(body for name in frames if (body := _free_body(mechanics, name)) is not None)


def _free_body(mechanics: System, frame: str) -> FreeBody | None:
    q, qd, kinematics = mechanics.q, mechanics.qd, mechanics.bodies.kinematics
    places = [_moved_along(mechanics, x) for x in kinematics.position(frame)]
    turned = reached(kinematics.twist(frame).angular)
    angles = [j for j, rate in enumerate(qd) if rate in turned]
    if None in places or len(angles) != 3 or len({*places, *angles}) != 6:
        return None
    first, second, third = (j for j in places if j is not None)
    body = FreeBody(frame, (first, second, third), (angles[0], angles[1], angles[2]), ())
    symbols = {x for j in body.coordinates for x in (q[j], qd[j])}
    if not _carries_alone(mechanics, frame, symbols):
        return None
    points = _held_points(mechanics, frame)
    held = None if points is None else replace(body, points=points)
    return held if held is not None and _only_held(mechanics, held) else None


def _moved_along(mechanics: System, place: Scalar) -> int | None:
    """The one coordinate that this component of a place grows with; None where it is not that simple."""
    slopes = {j: slope for j, slope in enumerate(gradient(mechanics.graph, place, mechanics.q)) if not slope.is_zero}
    return next(iter(slopes)) if len(slopes) == 1 and all(slope.is_one for slope in slopes.values()) else None


def _carries_alone(mechanics: System, frame: str, symbols: set[Scalar]) -> bool:
    """Whether the frames on the way are there for this one only, without bodies, and no other frame moves with them."""
    mechanism, kinematics = mechanics.bodies.mechanism, mechanics.bodies.kinematics
    line = {*kinematics.lineage(frame)} - {WORLD}
    if any(body.frame in line - {frame} for body in mechanism.bodies):
        return False
    for other in mechanism.frames:
        if other.name not in line:
            joint = kinematics.joint(other.name)
            if other.parent in line or symbols & reached((*joint.place, *(x for row in joint.axes for x in row))):
                return False
    return True


def _held_points(mechanics: System, frame: str) -> tuple[tuple[str, Vector3], ...] | None:
    """The points of the frame whose places are used; None where anything else of the frame is."""
    kinematics = mechanics.bodies.kinematics
    line = {*kinematics.lineage(frame)} - {WORLD}
    points: dict[str, Vector3] = {}
    for name in components_in(mechanics.model):
        one = component(name)
        point = kinematics.points.get(one.owner)
        if line.isdisjoint((one.axes, *((one.owner,) if point is None else (point.frame, point.carrier)))):
            continue
        at = kinematics.space.origin if point is None else kinematics.space.values(point.at)
        placed = (one.owner if point is None else point.frame) == frame and all(map(mechanics.factoring.fixed, at))
        if one.axes != WORLD or one.what not in ("x", "y", "z") or not placed:
            return None
        points[one.owner] = at
    return tuple(points.items())


def _only_held(mechanics: System, body: FreeBody) -> bool:
    """Whether geometric constraints depend on the six coordinates by places of points only, and nothing else does."""
    model, graph = mechanics.model, mechanics.graph
    names, leaves = with_leaves(mechanics, [owner for owner, _ in body.points])
    coordinates = {x for j in body.coordinates for x in (mechanics.q[j], mechanics.qd[j])}
    moved = {model.coordinates[j].name for j in body.coordinates}
    whole = coordinates | {leaf for three in leaves.values() for leaf in three}

    def depends_on(expression: Expression, symbols: Iterable[Scalar]) -> bool:
        return not reached([translate(graph, expression, names)]).isdisjoint(symbols)

    driven = [
        *(name for control in model.inputs for name, _ in control.acts_on),
        *(force.coordinate for force in model.applied_forces),
        *(rotor.coordinate for rotor in model.mechanism.rotor_inertias),
    ]
    works = [
        model.kinetic_energy,
        model.potential_energy,
        *(control.velocity for control in model.inputs if control.velocity is not None),
        *(force.velocity for force in model.forces),
        *(row.expression for row in model.constraints if row.kind != "geometric"),
    ]
    held = [row.expression for row in model.constraints if row.kind == "geometric"]
    return (
        moved.isdisjoint(driven)
        and not any(depends_on(expression, whole) for expression in works)
        and not any(depends_on(expression, coordinates) for expression in held)
    )
