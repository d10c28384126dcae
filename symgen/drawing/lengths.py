"""Legs that equations speak of: rows that hold two places at a distance, which may be a coordinate.

A row is one of a distance where it contains the places of two points or frames alone, and its derivatives by them are
opposite and along the line between them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from symgen.drawing.pose import MachinePose, Place
from symgen.model.expressions.walk import names_in
from symgen.model.kinematics.triples import cross
from symgen.model.mechanism import WORLD, component, is_component
from symgen.model.model import ConstraintRow

# Of a derivative: what is less is rounding.
ROUNDED_AWAY = 1e-9


@dataclass(frozen=True, slots=True)
class DrawnLength:
    """A line between two owners, the coordinates that its length is made of, and the inputs that drive these."""

    ends: tuple[str, str]
    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]


def drawn_lengths(pose: MachinePose) -> Iterator[DrawnLength]:
    """One for each row of a distance that no rod, spring or cable is drawn for."""
    tied = {frozenset(tie.ends) for tie in pose.mechanism.ties}
    for row in pose.model.constraints:
        ends = _ends(pose, row) if row.kind == "geometric" else None
        if ends is not None and frozenset(ends) not in tied:
            yield _between(pose, row, ends)


def _ends(pose: MachinePose, row: ConstraintRow) -> tuple[str, str] | None:
    """The two owners whose distance a row is about."""
    names = dict.fromkeys(part.name for part in names_in(row.expression) if is_component(part.name))
    places = [component(name) for name in names]
    owners = list(dict.fromkeys(one.owner for one in places))
    if len(owners) != 2 or any(one.axes != WORLD or one.what not in ("x", "y", "z") for one in places):
        return None
    index = {one.name: k for k, one in enumerate(places)}
    _, gradient = pose.gradients(index).of(row.expression)
    first, second = (
        tuple(gradient.get(index.get(f"{owner}.{axis}", -1), 0.0) for axis in "xyz") for owner in owners
    )
    start, end = (pose.places[owner] for owner in owners)
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    size, far = math.hypot(*first), math.hypot(x, y, z)
    opposite = math.hypot(*(a + b for a, b in zip(first, second, strict=True)))
    across = math.hypot(*cross((x, y, z), _three(first)))
    nothing = ROUNDED_AWAY * size
    apart = size > 0 and not pose.is_same(start, end)
    return (owners[0], owners[1]) if apart and opposite <= nothing and across <= nothing * far else None


def _three(values: tuple[float, ...]) -> Place:
    x, y, z = values
    return x, y, z


def _between(pose: MachinePose, row: ConstraintRow, ends: tuple[str, str]) -> DrawnLength:
    moving = {name for joint in pose.joints for name in joint.coordinates}
    named = dict.fromkeys(part.name for part in names_in(row.expression))
    coordinates = tuple(c.name for c in pose.model.coordinates if c.name in named and c.name not in moving)
    acting = {one.name: {name for name, _ in one.acts_on} for one in pose.model.inputs}
    inputs = tuple(name for name, driven in acting.items() if driven and driven <= {*coordinates})
    return DrawnLength(ends, coordinates, inputs)
