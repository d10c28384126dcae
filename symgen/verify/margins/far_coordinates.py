"""How far coordinates may be out of the ranges that the file states before a kernel loses digits.

A method is taken for what it does in these ranges.  Kernels answer out of them, too: where rows, inputs or masses lose
rank there, results lose digits with status 0.  States are led there, the reference judges those nearest to the ranges
first, and where it finds a loss a coordinate is bounded half of the way to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import floor, log10

import numpy as np

from symgen.ir.bounded_coordinates import CoordinateBound
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.runtime.activity import working
from symgen.verify.expected import Expected
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.margins.lost_digits import LostDigits
from symgen.verify.sampling.nearby_states import Nearby
from symgen.verify.sampling.states import rounded
from symgen.verify.tolerance import FACTOR

# Units that leave a doubt, and how many doubtful states are judged.
DOUBTFUL_OUTSIDE, JUDGED_OUTSIDE = FACTOR / 2, 24
# Of the way from a range to a loss: where the bound is.
BEFORE_A_LOSS_OUTSIDE = 0.5
# Digits to which a bound is rounded, of that part of the way.
DIGITS_OF_A_BOUND = 1


class FarCoordinates:
    """The search for one verification."""

    def __init__(self, expected: Expected) -> None:
        self._expected, self._digits = expected, LostDigits(expected)
        self._coordinates = expected.reference.model.coordinates
        ends = [(float(c.range[0]), float(c.range[1])) for c in self._coordinates]
        self._low, self._high = np.array(ends).reshape(-1, 2).T
        self._stated = np.array([c.has_range for c in self._coordinates], dtype=bool)

    def bounds(
        self, kernels: Mapping[Scalar, Kernel], programs: Mapping[Scalar, Program]
    ) -> dict[Scalar, tuple[CoordinateBound, ...]]:
        """Those of the kernels of a quantity, by scalar type; none where every range is taken for granted."""
        made = {}
        with working("out of the ranges of coordinates"):
            for scalar, kernel in kernels.items():
                ends: dict[tuple[int, int], float] = {}
                for states in self._expected.outside.of(kernel.name):
                    for q in self._lost(kernel, programs, scalar, states, ends):
                        place, side, end = self._end(q)
                        ends[place, side] = end
                made[scalar] = tuple(self._bounds(ends))
        return made

    def _lost(
        self,
        kernel: Kernel,
        programs: Mapping[Scalar, Program],
        scalar: Scalar,
        states: Nearby,
        ends: Mapping[tuple[int, int], float],
    ) -> Iterator[Lanes]:
        """Configurations at which the reference finds more lost than is allowed, within bounds that come closer."""
        units = self._digits.units(kernel, programs, scalar, states)
        doubtful = np.flatnonzero(units > DOUBTFUL_OUTSIDE)
        nearest = doubtful[np.argsort(self._beyond(states.parts["q"][doubtful]).max(axis=1), kind="stable")]
        judged = 0
        for place in nearest.tolist():
            q = states.parts["q"][place]
            if any((q[k] - end) * side > 0 for (k, side), end in ends.items()):
                continue
            sample = self._expected.outside.settled(states, place, kernel.name)
            judged += 1
            if sample is not None:
                state = rounded(sample, scalar).state
                q = np.array([float(x) for x in state.q])
                # one that the constraints lead back into the ranges is no reason for a bound
                outside = self._beyond(q).max(initial=-np.inf) > 0
                if outside and self._digits.is_lost(kernel, programs[scalar], state, "out of ranges"):
                    yield q
            if judged == JUDGED_OUTSIDE:
                return

    def _beyond(self, q: Lanes) -> Lanes:
        """How far coordinates are out of ranges that are stated, in widths of these."""
        outside = np.maximum(self._low - q, q - self._high)
        return np.where(self._stated, outside / (self._high - self._low), -np.inf)

    def _end(self, q: Lanes) -> tuple[int, int, float]:
        """The coordinate that is furthest out, on which side, and its bound."""
        place = int(np.argmax(self._beyond(q)))
        side, edge = (-1, self._low[place]) if q[place] < self._low[place] else (1, self._high[place])
        way = float(BEFORE_A_LOSS_OUTSIDE * (q[place] - edge))
        digits = DIGITS_OF_A_BOUND - floor(log10(abs(way))) if way else 0
        return place, side, round(float(edge) + way, digits)

    def _bounds(self, ends: Mapping[tuple[int, int], float]) -> Iterator[CoordinateBound]:
        for place in sorted({place for place, _ in ends}):
            low, high = (
                None if (end := ends.get((place, side))) is None else Fraction(str(end)) for side in (-1, 1)
            )
            yield CoordinateBound(self._coordinates[place].name, low, high)
