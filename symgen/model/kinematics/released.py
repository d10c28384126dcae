"""A mechanism whose rough joints are let go: coordinates along which frames could leave their parents, kept at 0.

What keeps them there is the reaction of the joint, by the principle of virtual power: the balance of all bodies beyond
it, with weights, springs, forces, inputs and loops that act there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.combine import plus
from symgen.model.expressions.expression import Name
from symgen.model.mechanism import NO_VECTOR, Frame, Quaternion
from symgen.model.model import Coordinate, Model, ReleasedJoint

# Of coordinates that are kept at 0.
KEPT_AT_ZERO = (Fraction(0), Fraction(0))


def released_model(model: Model) -> Model:
    """The model with the coordinates of its `released` joints after its own; where all of them are 0 it is the same.

    Nothing is left in it that is not part of its equations of motion.
    """
    further = [name for joint in model.released for name, _ in joint.coordinates]
    ranges = (KEPT_AT_ZERO, KEPT_AT_ZERO, KEPT_AT_ZERO)
    coordinates = (Coordinate(name, "m", "of a joint let go", False, *ranges) for name in further)
    by_frame = {joint.frame: joint for joint in model.released}
    frames = [
        own
        for frame in model.mechanism.frames
        for own in (_let_go(frame, by_frame[frame.name]) if frame.name in by_frame else (frame,))
    ]
    return replace(
        model,
        coordinates=(*model.coordinates, *coordinates),
        mechanism=replace(model.mechanism, frames=tuple(frames)),
        released=(),
        allocation=None,
        assembly=None,
        task=(),
        measured=(),
        published=(),
        paths=(),
    )


def _let_go(frame: Frame, joint: ReleasedJoint) -> Iterator[Frame]:
    """The frame, behind another one where fixed turns come before the joint's own."""
    assert not isinstance(frame.rotation, Quaternion)
    fixed = frame.rotation[: len(frame.rotation) - joint.turns]
    own = frame.rotation[len(fixed) :]
    parent, shift = frame.parent, list(frame.translation)
    if fixed:
        parent, shift = f"{frame.name}.held", list(NO_VECTOR)
        yield Frame(parent, frame.parent, frame.translation, fixed)
    for name, axis in joint.coordinates:
        shift[axis] = plus(shift[axis], Name(name))
    yield replace(frame, parent=parent, translation=(shift[0], shift[1], shift[2]), rotation=own)
