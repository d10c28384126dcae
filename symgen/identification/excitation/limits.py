"""What a motion keeps within: ranges of coordinates, rates and accelerations, drives, distances from singularities."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from symgen.identification.arrays import Array
from symgen.model.input_limits import input_limits
from symgen.model.model import Coordinate, Model
from symgen.records import dataclass

# Of the distance from singularities that the configuration of the model has, what a motion keeps at least.
KEPT_DISTANCE = 0.5
# Of its range, what a coordinate whose file limits no rate moves by in a second at most.
RANGES_A_SECOND = 1.0
MEASURES = ("constraints", "inputs")


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """Lower and upper ends (2, n) of places, rates and accelerations, (2, m) of inputs; least distances (2).

    `names` are those of all, in the order of shares; `taken` says what the file leaves open and was taken.
    """

    places: Array
    rates: Array
    accelerations: Array
    inputs: Array
    distances: Array
    names: tuple[str, ...]
    taken: tuple[str, ...]

    def shares(self, state: tuple[Array, Array, Array], u: Array, distances: Array) -> Array:
        """Of each limit what a state takes (N, l), 1 at the limit; from states (N, n), inputs (N, m), measures (N, 2).

        What lies between two ends has the share of its distance from the middle, a distance its inverse share.
        """
        parts = zip((*state, u), (self.places, self.rates, self.accelerations, self.inputs), strict=True)
        ranged = [_shares_of(values, ends) for values, ends in parts]
        near = self.distances / np.maximum(distances, 1e-300)
        return np.concatenate([*ranged, near], axis=-1)


def motion_limits(
    model: Model, values: dict[str, float], place: Array, distances: Array, asked: float | None
) -> MotionLimits:
    """Those of the file, and what is taken where it has none; `place` (n) and its `distances` (2) are where it starts.

    `asked` is the least distance from singularities, of both measures, where one was asked for.
    """
    coordinates = model.coordinates
    ends = [_range(c, x) for c, x in zip(coordinates, place, strict=True)]
    rates = [_rate_range(c, end) for c, end in zip(coordinates, ends, strict=True)]
    accelerations = [
        tuple(map(float, c.acceleration_range)) if c.has_acceleration_range else (-math.inf, math.inf)
        for c in coordinates
    ]
    least = KEPT_DISTANCE * distances if asked is None else np.full(2, asked)
    names = (
        *(c.name for c in coordinates),
        *(c.rate for c in coordinates),
        *(c.acceleration for c in coordinates),
        *(one.name for one in model.inputs),
        *(f"the distance from singularities of {what}" for what in MEASURES),
    )
    inputs = np.array(input_limits(model, values)).reshape(model.m, 2).T
    arrays = [np.array(one, dtype=np.float64).T for one in (ends, rates, accelerations)]
    return MotionLimits(arrays[0], arrays[1], arrays[2], inputs, least, names, _taken(coordinates, inputs))


def _range(c: Coordinate, start: float) -> tuple[float, float]:
    """The file's range, else one as wide as states are looked at, about where the machine stands."""
    low, high = map(float, c.range)
    return (low, high) if c.has_range else (start - (high - low) / 2, start + (high - low) / 2)


def _rate_range(c: Coordinate, ends: tuple[float, float]) -> tuple[float, float]:
    if c.has_rate_range:
        return float(c.rate_range[0]), float(c.rate_range[1])
    fastest = RANGES_A_SECOND * (ends[1] - ends[0])
    return -fastest, fastest


def _shares_of(values: Array, ends: Array) -> Array:
    """How far values (N, k) are from the middle of their ends (2, k), in halves of the distance of these."""
    finite = np.isfinite(ends).all(axis=0)
    low, high = np.where(finite, ends, np.array([[-1.0], [1.0]]))
    shares = np.abs(values - (low + high) / 2) / ((high - low) / 2)
    return np.asarray(np.where(finite, shares, np.where(np.isfinite(values), 0.0, values)), dtype=np.float64)


def _taken(coordinates: Sequence[Coordinate], inputs: Array) -> tuple[str, ...]:
    words = []
    if names := [c.name for c in coordinates if not c.has_range]:
        words.append(f"no range of {', '.join(names)}: half a turn or a unit about the configuration is taken")
    if names := [c.rate for c in coordinates if not c.has_rate_range]:
        words.append(f"no range of {', '.join(names)}: one range of the coordinate in a second is taken")
    if names := [c.acceleration for c in coordinates if not c.has_acceleration_range]:
        words.append(f"no range of {', '.join(names)}: accelerations are as the rates and the period have them")
    if not np.isfinite(inputs).all():
        words.append("no `limits` of all inputs under `allocation`: those without are not limited")
    return tuple(words)
