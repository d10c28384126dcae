"""Joints let go: a model with a frame between each of them and its parent, in which the rest may be shifted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.expression import Name, Number
from symgen.model.mechanism import Frame
from symgen.model.model import Coordinate, Model

# The range of what is 0.
NOWHERE = (Fraction(0), Fraction(0))


def with_joints_released(model: Model) -> Model:
    """The model's equations of motion with further coordinates, m, by which joints with rough places come apart."""
    names = [name for joint in model.released for name, _ in joint.coordinates]
    shifts = tuple(Coordinate(name, None, "", False, NOWHERE, NOWHERE, NOWHERE) for name in names)
    frames = tuple(one for frame in model.mechanism.frames for one in _apart(model, frame))
    return replace(
        model,
        coordinates=(*model.coordinates, *shifts),
        mechanism=replace(model.mechanism, frames=frames),
        released=(),
        assembly=None,
        allocation=None,
        task=(),
        measured=(),
    )


def _apart(model: Model, frame: Frame) -> Iterator[Frame]:
    joint = next((one for one in model.released if one.frame == frame.name), None)
    if joint is None or not isinstance(frame.rotation, tuple):
        yield frame
        return
    fixed = len(frame.rotation) - joint.turns
    seat = replace(frame, name=f"{frame.name} seat", rotation=frame.rotation[:fixed])
    shift = {axis: Name(name) for name, axis in joint.coordinates}
    x, y, z = (shift.get(axis, Number(Fraction(0))) for axis in range(3))
    yield from (seat, replace(frame, parent=seat.name, translation=(x, y, z), rotation=frame.rotation[fixed:]))
