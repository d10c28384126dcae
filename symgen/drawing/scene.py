"""Where frames, points, bodies and wheels are at each moment of a motion: what the animation draws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from symgen.drawing.pose import Place, kinematics_at
from symgen.model.expressions.walk import evaluate
from symgen.model.mechanism import WORLD, Mechanism
from symgen.model.model import Model


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
class Scene:
    """What is drawn, and where it is at each moment.

    `names` are those of the frames, then of the points; `lines` join a frame to its parent, `arms` a point to its
    frame, `ties` are rods, springs and cables.  `turned` are the frames whose axes are drawn.  `places` (m) and the
    rows of the rotation matrices `axes` follow the motion.
    """

    names: tuple[str, ...]
    lines: tuple[tuple[int, int], ...]
    arms: tuple[tuple[int, int], ...]
    ties: tuple[tuple[int, int], ...]
    turned: tuple[int, ...]
    balls: tuple[Ball, ...]
    hoops: tuple[Hoop, ...]
    places: tuple[tuple[Place, ...], ...]
    axes: tuple[tuple[tuple[float, ...], ...], ...]


def scene(model: Model, parameters: Mapping[str, float], motion: Sequence[Sequence[float]]) -> Scene | None:
    """The mechanism along the motion; None for a model without frames."""
    mechanism = model.mechanism
    if not mechanism.frames:
        return None
    names = (*(frame.name for frame in mechanism.frames), *(point.name for point in mechanism.points))
    number = {name: k for k, name in enumerate(names)}
    carriers = {body.frame for body in mechanism.bodies} | {wheel.frame for wheel in mechanism.wheels}
    turned = tuple(k for k, frame in enumerate(mechanism.frames) if frame.name in carriers)
    places, axes = [], []
    for q in motion:
        at = dict(zip((coordinate.name for coordinate in model.coordinates), q, strict=True))
        kinematics = kinematics_at(model, {**parameters, **at})
        places.append(tuple(map(kinematics.position, names)))
        axes.append(tuple(tuple(chain(*kinematics.axes(names[k]))) for k in turned))
    return Scene(
        names,
        tuple((number[f.parent], number[f.name]) for f in mechanism.frames if f.parent != WORLD),
        tuple((number[p.frame], number[p.name]) for p in mechanism.points if p.frame != WORLD),
        tuple((number[tie.ends[0]], number[tie.ends[1]]) for tie in mechanism.ties),
        turned,
        _balls(mechanism, parameters, number),
        tuple(Hoop(number[w.frame], evaluate(w.radius, parameters), w.axle) for w in mechanism.wheels),
        tuple(places),
        tuple(axes),
    )


def _balls(mechanism: Mechanism, parameters: Mapping[str, float], number: Mapping[str, int]) -> tuple[Ball, ...]:
    """Bodies with mass, but those that stand in the world."""
    heavy = [body for body in mechanism.bodies if body.frame != WORLD and evaluate(body.mass, parameters) > 0]
    largest = max((evaluate(body.mass, parameters) for body in heavy), default=1.0)
    balls = []
    for body in heavy:
        x, y, z = (evaluate(entry, parameters) for entry in body.com)
        balls.append(Ball(number[body.frame], (x, y, z), evaluate(body.mass, parameters) / largest))
    return tuple(balls)
