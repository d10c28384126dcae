"""The machine along a motion: its links, joints, wheels and points, and where they are at each moment."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, product

from symgen.drawing.lengths import drawn_lengths
from symgen.drawing.links import LinkPlaces
from symgen.drawing.pose import Kind, MachinePose, Place, kinematics_at
from symgen.drawing.view import ABOVE, View, view_of
from symgen.model.expressions.walk import evaluate
from symgen.model.kinematics.triples import applied, transposed
from symgen.model.mechanism import WORLD, Mechanism
from symgen.model.model import Model

# The number of the world among frames.
IN_WORLD = -1


@dataclass(frozen=True, slots=True)
class Ball:
    """A body as a ball at its centre of mass, in the axes of a turned frame; `share` of the largest mass."""

    frame: int
    com: Place
    share: float


@dataclass(frozen=True, slots=True)
class Hoop:
    """A wheel of that radius (m) about the axis `axle` (0, 1, 2) of a turned frame."""

    frame: int
    radius: float
    axle: int


@dataclass(frozen=True, slots=True)
class MovingLink:
    """A link by its places in the axes of a turned frame, from its origin; those of the world are where it stands.

    One that solids stand for is not `shown`: its places say how far it reaches.
    """

    frame: int
    places: tuple[Place, ...]
    shown: bool = True


@dataclass(frozen=True, slots=True)
class MovingSolid:
    """What a part looks like: corners in the axes of a turned frame, and faces by the numbers of their corners."""

    frame: int
    corners: tuple[Place, ...]
    faces: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class MovingJoint:
    """The joint at the origin of a frame; a slide goes from `foot` along a direction, in the axes of its `carrier`."""

    frame: int
    kind: Kind
    driven: bool
    carrier: int
    foot: Place
    along: Place


@dataclass(frozen=True, slots=True)
class MovingTie:
    """A rod, spring or part of a cable between two names."""

    kind: str
    ends: tuple[int, int]


@dataclass(frozen=True, slots=True)
class Stand:
    """From where a motion is looked at first: directions of the picture, and how far (rad) the eye is above them."""

    right: Place
    up: Place
    near: Place
    above: float
    planar: bool


@dataclass(frozen=True, slots=True)
class Scene:
    """What is drawn, and where it is at each moment.

    `names` are those of the frames, then of as many `points`; `chains` join a frame to its parent and a point to its
    frame.  `turned` are the frames whose axes are known.  `places` (m) and the rows of the rotation matrices `axes`
    follow the motion.
    """

    names: tuple[str, ...]
    points: int
    chains: tuple[tuple[int, int], ...]
    links: tuple[MovingLink, ...]
    joints: tuple[MovingJoint, ...]
    ties: tuple[MovingTie, ...]
    turned: tuple[int, ...]
    balls: tuple[Ball, ...]
    hoops: tuple[Hoop, ...]
    solids: tuple[MovingSolid, ...]
    stand: Stand
    places: tuple[tuple[Place, ...], ...]
    axes: tuple[tuple[tuple[float, ...], ...], ...]


def scene(model: Model, parameters: Mapping[str, float], motion: Sequence[Sequence[float]]) -> Scene | None:
    """The mechanism along the motion; None for a model without frames."""
    mechanism = model.pictured
    if not mechanism.frames:
        return None
    names = (*(frame.name for frame in mechanism.frames), *(point.name for point in mechanism.points))
    number = {name: k for k, name in enumerate(names)} | {WORLD: IN_WORLD}
    pose = MachinePose(model, parameters, motion[0])
    links = LinkPlaces(pose)
    used = {*links.places, *links.root.values(), *(body.frame for body in mechanism.bodies)}
    used |= {wheel.frame for wheel in mechanism.wheels} | {frame.parent for frame in mechanism.frames}
    used |= {solid.frame for solid in mechanism.solids}
    turned = tuple(k for k, frame in enumerate(mechanism.frames) if frame.name in used)
    places, axes = [], []
    for q in motion:
        at = dict(zip((coordinate.name for coordinate in model.coordinates), q, strict=True))
        kinematics = kinematics_at(model, {**parameters, **at})
        places.append(tuple(kinematics.position(name) for name in names))
        axes.append(tuple(tuple(chain(*kinematics.axes(names[k]))) for k in turned))
    return Scene(
        names,
        len(mechanism.points),
        tuple(
            (number[carrier], number[name])
            for carrier, name in (
                *((frame.parent, frame.name) for frame in mechanism.frames),
                *((point.frame, point.name) for point in mechanism.points),
            )
            if carrier != WORLD
        ),
        tuple(_links(pose, links, number)),
        tuple(_joints(pose, number)),
        (
            *(MovingTie(tie.kind, (number[tie.ends[0]], number[tie.ends[1]])) for tie in mechanism.ties),
            *(MovingTie("rod", (number[leg.ends[0]], number[leg.ends[1]])) for leg in drawn_lengths(pose)),
        ),
        turned,
        _balls(mechanism, parameters, number),
        tuple(Hoop(number[w.frame], evaluate(w.radius, parameters), w.axle) for w in mechanism.wheels),
        tuple(MovingSolid(number[one.frame], one.corners, one.faces) for one in mechanism.solids),
        _stand(view_of(pose)),
        tuple(places),
        tuple(axes),
    )


def _links(pose: MachinePose, links: LinkPlaces, number: Mapping[str, int]) -> Iterator[MovingLink]:
    """Bars and plates, and boxes around solids, which stand for the links that they belong to."""
    solids = pose.mechanism.solids
    covered = {links.root[solid.frame] for solid in solids} - {WORLD}
    for name, places in links.places.items():
        yield MovingLink(number[name], _in_axes(pose, name, places), name not in covered)
    for solid in solids:
        low, high = (tuple(map(end, zip(*solid.corners, strict=True))) for end in (min, max))
        corners = ((x, y, z) for x, y, z in product(*zip(low, high, strict=True)))
        yield MovingLink(number[solid.frame], tuple(corners), shown=False)


def _in_axes(pose: MachinePose, frame: str, places: Sequence[Place]) -> tuple[Place, ...]:
    """Places of the world in the axes of a frame, from its origin."""
    return tuple(pose.in_frame(frame, place) for place in places)


def _joints(pose: MachinePose, number: Mapping[str, int]) -> Sequence[MovingJoint]:
    """Those of frames that move, but for what moves freely."""
    parents = {frame.name: frame.parent for frame in pose.mechanism.frames}
    moving = [joint for joint in pose.joints if joint.kind not in ("fixed", "free")]
    drawn = []
    for joint in moving:
        parent = parents[joint.frame]
        along = joint.slides[0] if joint.kind == "sliding" else (0.0, 0.0, 0.0)
        if parent != WORLD:
            along = applied(transposed(pose.all_axes(parent)), along)
        foot = pose.in_frame(parent, joint.foot)
        drawn.append(MovingJoint(number[joint.frame], joint.kind, bool(joint.inputs), number[parent], foot, along))
    return drawn


def _stand(view: View) -> Stand:
    """The directions of a view, level where the eye is above the machine."""
    if view.planar:
        return Stand(view.right, view.up, view.near, 0.0, True)
    low, high = math.sin(ABOVE), math.cos(ABOVE)
    pairs = [(high * u + low * n, high * n - low * u) for u, n in zip(view.up, view.near, strict=True)]
    (a, d), (b, e), (c, f) = pairs
    return Stand(view.right, (a, b, c), (d, e, f), ABOVE, False)


def _balls(mechanism: Mechanism, parameters: Mapping[str, float], number: Mapping[str, int]) -> tuple[Ball, ...]:
    """Bodies with mass, but those that stand in the world."""
    heavy = [body for body in mechanism.bodies if body.frame != WORLD and evaluate(body.mass, parameters) > 0]
    largest = max((evaluate(body.mass, parameters) for body in heavy), default=1.0)
    balls = []
    for body in heavy:
        x, y, z = (evaluate(entry, parameters) for entry in body.com)
        balls.append(Ball(number[body.frame], (x, y, z), evaluate(body.mass, parameters) / largest))
    return tuple(balls)
