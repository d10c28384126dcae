"""How a machine is looked at: straight on where it stays in a plane, else from above and aside, its up pointing up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from symgen.drawing.pose import ORIGIN, MachinePose, Place
from symgen.model.expressions.walk import evaluate

Flat: TypeAlias = tuple[float, float]
# Radians from which a machine in space is looked at: beside its first axis, and above the ground.
ASIDE, ABOVE = math.radians(-62), math.radians(24)
# Of a direction: what is less of it is nothing.
ALONG = 1e-6


@dataclass(frozen=True, slots=True)
class View:
    """Two directions of the picture, to the right and up, and the one towards the eye; in the axes of the world."""

    right: Place
    up: Place
    near: Place
    planar: bool

    def flat(self, place: Place) -> Flat:
        """Where a place is in the picture, y upwards."""
        return _dot(place, self.right), _dot(place, self.up)

    def depth(self, place: Place) -> float:
        """How near it is."""
        return _dot(place, self.near)


def view_of(pose: MachinePose) -> View:
    """The view of a machine."""
    places = [pose.place(name) for name in pose.names] or [ORIGIN]
    for normal, right, up in ((2, 0, 1), (1, 0, 2), (0, 1, 2)):
        if _is_planar(pose, places, _basis(normal)):
            return View(_basis(right), _basis(up), _basis(normal, -1.0 if normal == 1 else 1.0), planar=True)
    tilted = next((joint.axis for joint in pose.joints if joint.kind == "turning"), None)
    if tilted is not None and _is_planar(pose, places, tilted):
        return _along(tilted, _basis(_upward(pose)))
    return _aside(_upward(pose))


def _is_planar(pose: MachinePose, places: Sequence[Place], normal: Place) -> bool:
    """Whether the machine stays in a plane with this normal."""
    heights = [_dot(place, normal) for place in places]
    if max(heights) - min(heights) > ALONG * pose.size:
        return False
    axles = [pose.axis(wheel.frame, wheel.axle) for wheel in pose.mechanism.wheels]
    turning = [joint.axis for joint in pose.joints if joint.kind == "turning"]
    sliding = [joint.axis for joint in pose.joints if joint.kind == "sliding"]
    if any(joint.kind == "ball" or (joint.kind == "free" and len(joint.coordinates) > 3) for joint in pose.joints):
        return False
    square = all(abs(_dot(axis, normal)) > 1 - ALONG for axis in (*turning, *axles))
    return square and all(abs(_dot(axis, normal)) < ALONG for axis in sliding)


def _along(normal: Place, upward: Place) -> View:
    """Straight on a plane that is tilted, up being the steepest way in it."""
    rise = _dot(upward, normal)
    up = _unit(tuple(u - rise * n for u, n in zip(upward, normal, strict=True)))
    x, y, z = (up[(k + 1) % 3] * normal[(k + 2) % 3] - up[(k + 2) % 3] * normal[(k + 1) % 3] for k in range(3))
    return View((x, y, z), up, normal, planar=True)


def _upward(pose: MachinePose) -> int:
    """The axis of the world that points up: against gravity, else z."""
    gravity = [abs(evaluate(entry, pose.parameters)) for entry in pose.mechanism.gravity]
    return gravity.index(max(gravity)) if any(gravity) else 2


def _aside(upward: int) -> View:
    """From above and aside; the two level axes follow the one that points up."""
    first, second = (upward + 1) % 3, (upward + 2) % 3
    level = -math.sin(ASIDE), math.cos(ASIDE)
    towards = math.cos(ASIDE), math.sin(ASIDE)

    def place(along: Flat, up: float) -> Place:
        entries = [0.0, 0.0, 0.0]
        entries[first], entries[second], entries[upward] = along[0], along[1], up
        return entries[0], entries[1], entries[2]

    low, high = math.sin(ABOVE), math.cos(ABOVE)
    near = place((towards[0] * high, towards[1] * high), low)
    return View(place(level, 0.0), place((-towards[0] * low, -towards[1] * low), high), near, planar=False)


def _basis(axis: int, sign: float = 1.0) -> Place:
    entries = [0.0, 0.0, 0.0]
    entries[axis] = sign
    return entries[0], entries[1], entries[2]


def _unit(vector: Sequence[float]) -> Place:
    length = math.hypot(*vector)
    return vector[0] / length, vector[1] / length, vector[2] / length


def _dot(a: Place, b: Place) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
