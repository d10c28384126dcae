"""How a machine is looked at: straight on where it stays in a plane, else from above and aside; its up points up."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from symgen.drawing.pose import NEXT_TO_NOTHING, MachinePose, Place
from symgen.model.expressions.walk import evaluate
from symgen.model.kinematics.triples import cross, inner

Flat: TypeAlias = tuple[float, float]
# Of the size of a machine: links that move in one plane may lie this far above each other, as they have to in a machine
# that is built, and are looked at straight on.
STACKED = 0.25
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
# Planes of the world as they are usually drawn: the direction towards the eye, and up.
USUAL_PLANES = ((Z, Y), ((0.0, -1.0, 0.0), Z), (X, Z))
# Radians from which a machine in space is looked at: beside its first axis, and above the ground.
ASIDE, ABOVE = math.radians(-62), math.radians(24)


@dataclass(frozen=True, slots=True)
class View:
    """Two directions of the picture, to the right and up, and the one towards the eye; in the axes of the world."""

    right: Place
    up: Place
    near: Place
    planar: bool

    def flat(self, place: Place) -> Flat:
        """Where a place is in the picture, y upwards."""
        return inner(place, self.right), inner(place, self.up)

    def depth(self, place: Place) -> float:
        """How near it is."""
        return inner(place, self.near)


def view_of(pose: MachinePose) -> View:
    """The view of a machine: against gravity is up, where there is any."""
    upward = _upward(pose)
    tilted = [(turn, Z) for joint in pose.joints for turn in joint.turns]
    for near, usual in (*USUAL_PLANES, *tilted[:1]):
        if _is_planar(pose, near):
            return _straight_on(near, upward or usual, usual)
    return _aside(upward or Z)


def views_along_axes(pose: MachinePose) -> tuple[View, ...]:
    """Straight onto planes of the world along which the machine moves, its links at any heights above them."""
    return tuple(_straight_on(near, up, up) for near, up in USUAL_PLANES if _moves_along(pose, near))


def _is_planar(pose: MachinePose, normal: Place) -> bool:
    """Whether what moves stays in a plane with this normal, but for the thickness of links."""
    moving = [joint for joint in pose.joints if joint.kind != "fixed"]
    places = [place for joint in moving for place in (joint.place, joint.foot)]
    heights = [inner(place, normal) for place in (*places, *(pose.places[one.name] for one in pose.mechanism.points))]
    return max(heights, default=0.0) - min(heights, default=0.0) <= STACKED * pose.size and _moves_along(pose, normal)


def _moves_along(pose: MachinePose, normal: Place) -> bool:
    """Whether all joints turn about this normal, and slide at right angles to it; wheels may be seen from the edge."""
    axles = [pose.axis(wheel.frame, wheel.axle) for wheel in pose.mechanism.wheels]
    turns = [turn for joint in pose.joints for turn in joint.turns]
    slides = [slide for joint in pose.joints for slide in joint.slides]
    square = all(abs(inner(axis, normal)) > 1 - NEXT_TO_NOTHING for axis in turns)
    straight = all(not NEXT_TO_NOTHING < abs(inner(axle, normal)) < 1 - NEXT_TO_NOTHING for axle in axles)
    return square and straight and all(abs(inner(slide, normal)) < NEXT_TO_NOTHING for slide in slides)


def _upward(pose: MachinePose) -> Place | None:
    """The axis of the world that points most against gravity; None without any."""
    gravity = [evaluate(entry, pose.parameters) for entry in pose.mechanism.gravity]
    strongest = max(range(3), key=lambda k: abs(gravity[k]))
    if not gravity[strongest]:
        return None
    x, y, z = (-math.copysign(1.0, gravity[k]) if k == strongest else 0.0 for k in range(3))
    return x, y, z


def _straight_on(near: Place, *upwards: Place) -> View:
    """On a plane, up being the steepest way in it towards the first of some directions that are not square to it."""
    rising = (_sum((1.0, up), (-inner(up, near), near)) for up in upwards)
    x, y, z = next(way for way in rising if math.hypot(*way) > NEXT_TO_NOTHING)
    length = math.hypot(x, y, z)
    up = x / length, y / length, z / length
    return View(cross(up, near), up, near, planar=True)


def _aside(up: Place) -> View:
    """From above and aside; the two level axes follow the one that points up."""
    first = abs(up[2]), abs(up[0]), abs(up[1])
    second = cross(up, first)
    level = _sum((-math.sin(ASIDE), first), (math.cos(ASIDE), second))
    towards = _sum((math.cos(ASIDE), first), (math.sin(ASIDE), second))
    low, high = math.sin(ABOVE), math.cos(ABOVE)
    return View(level, _sum((-low, towards), (high, up)), _sum((high, towards), (low, up)), planar=False)


def _sum(one: tuple[float, Place], other: tuple[float, Place]) -> Place:
    """Of two directions times numbers."""
    (a, left), (b, right) = one, other
    x, y, z = (a * p + b * q for p, q in zip(left, right, strict=True))
    return x, y, z
