"""How far out configurations are looked for: a length whose range the file does not say may be met further out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from symgen.model.model import Coordinate
from symgen.verify.lanes.lane_arithmetic import Lanes

# How far lengths without a range reach, in the ranges taken for granted.
LENGTH_REACH = 3.2
# Of the width of a range: nearer than that a coordinate is still in it.
SLACK = 0.01


def unstated_lengths(coordinates: Sequence[Coordinate]) -> Lanes:
    """A mask of the coordinates that are no angles and have no range in the file."""
    return np.array([not (c.has_range or c.is_angle) for c in coordinates], dtype=bool)


def reachable(coordinates: Sequence[Coordinate]) -> tuple[Lanes, Lanes]:
    """The lower and upper ends of where coordinates are looked for."""
    times = np.where(unstated_lengths(coordinates), LENGTH_REACH, 1.0)
    low, high = (np.array([float(c.range[side]) for c in coordinates]) for side in (0, 1))
    return low * times, high * times


def out_of_range(coordinates: Sequence[Coordinate], q: Sequence[Any]) -> list[int]:
    """The places of coordinates out of their ranges, be these stated or taken for granted."""
    outside = []
    for place, (x, coordinate) in enumerate(zip(q, coordinates, strict=True)):
        low, high = map(float, coordinate.range)
        slack = SLACK * (high - low)
        if not low - slack <= x <= high + slack:
            outside.append(place)
    return outside
