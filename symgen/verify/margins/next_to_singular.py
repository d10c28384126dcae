"""How near to a drop of rank a kernel holds what status 0 says, where a threshold leaves more room than it has digits.

Floats are dense at 0 alone.  Where rows or inputs lose rank in a configuration whose coordinates are 0, a state may be
nearer to that than coordinates are to their own rounding elsewhere, rounding moves the result by next to nothing, and
digits that a kernel loses count.  States are led there; where a kernel that holds everywhere else is beyond what is
allowed, its thresholds are raised until it has a status.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np

from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.raised import with_raised_thresholds
from symgen.model.quantities import MAIN
from symgen.runtime.activity import working
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.margins.lost_digits import LostDigits
from symgen.verify.reference.reference import State
from symgen.verify.sampling.nearby import Nearby, Surroundings, joined
from symgen.verify.sampling.searched import NUMBERS
from symgen.verify.sampling.settling import Settling
from symgen.verify.sampling.states import rounded
from symgen.verify.tolerance import FACTOR

# States that are led to a drop of rank, of which those with a coordinate near 0 go on, and how far measures of these,
# which are squares, may be below the least of the verification: 1e-12 of the way is left.
LED, NEAREST = 256, 1e-24
# States with small coordinates, where rows may vanish that keep their directions.
AROUND_ZERO = 32
# Rounding errors above so many units are judged, the furthest from a drop of rank first, so many at most; of those that
# are beyond what is allowed so many show how far a threshold has to go.
DOUBTFUL, JUDGED, SHOWING = FACTOR / 2, 24, 4
# Decades by which thresholds are raised at a time and at most, and how many more to keep a distance.
DECADES_RAISED, MOST_DECADES, MARGIN = 2, 24, 2


class NextToSingular:
    """Those states of one verification."""

    def __init__(self, expected: Expected) -> None:
        self._expected, self._digits = expected, LostDigits(expected)

    def decades(self, kernels: Mapping[Scalar, Kernel], programs: Mapping[Scalar, Program]) -> dict[Scalar, int]:
        """By how many decades the thresholds of the kernels of a quantity are to be raised, by scalar type.

        By none at all where a number that is too small to have digits is all there is to be refused.
        """
        made = {}
        with working("next to singular states"):
            for scalar, kernel in kernels.items():
                if kernel.name not in MAIN or not self._digits.are_measured(kernel, scalar):
                    continue
                if len(self._states):
                    made[scalar] = self._decades(kernel, programs, scalar)
        return {scalar: decades for scalar, decades in made.items() if decades is not None}

    def _decades(self, kernel: Kernel, programs: Mapping[Scalar, Program], scalar: Scalar) -> int | None:
        sincos = programs[scalar].sincos
        lost = list(self._lost(kernel, programs, scalar))
        regular = [sample.state for sample in self._expected.samples(scalar)]
        before = [one.status for one in outcomes(kernel, sincos, scalar, regular)]
        for decades in range(0, MOST_DECADES if lost else 0, DECADES_RAISED):
            raised = with_raised_thresholds(kernel, scalar, decades)
            if not any(one.valid for one in outcomes(raised, sincos, scalar, lost)):
                more = decades + MARGIN if decades else 0
                raised = with_raised_thresholds(kernel, scalar, more)
                after = [one.status for one in outcomes(raised, sincos, scalar, regular)]
                return more if after == before else None
        return None

    def _lost(self, kernel: Kernel, programs: Mapping[Scalar, Program], scalar: Scalar) -> Iterator[State]:
        """States of status 0 at which the reference finds more lost than is allowed, the furthest first."""
        states = self._states
        # of long kernels fewer states are looked at
        count = min(len(states), NUMBERS // (len(kernel.statements) + 1))
        places = np.linspace(0, len(states), count, endpoint=False).astype(int)
        doubtful = places[self._digits.units(kernel, programs, scalar, states.only(places)) > DOUBTFUL]
        order = doubtful[np.argsort(-self._measures[doubtful], kind="stable")][:JUDGED]
        showing = 0
        for place in order.tolist():
            sample = self._settling.sample(states.state(place), bool(states.admissible[place]), kernel.name)
            if sample is None:
                continue
            state = rounded(sample, scalar).state
            if self._digits.is_lost(kernel, programs[scalar], state, "next to singular"):
                yield state
                showing += 1
            if showing == SHOWING:
                return

    @property
    def _around(self) -> Surroundings:
        return self._expected.surroundings

    @cached_property
    def _settling(self) -> Settling:
        return Settling(self._expected.reference, self._expected.drawn, NEAREST)

    @cached_property
    def _states(self) -> Nearby:
        led = self._around.towards(self._around.affordable(LED), self._settling.measures)
        states = self._around.next_to_zero(joined(led, self._around.around_zero(self._around.affordable(AROUND_ZERO))))
        count = self._around.affordable(len(states))
        return states.only(np.linspace(0, len(states), count, endpoint=False).astype(int))

    @cached_property
    def _measures(self) -> Lanes:
        return self._around.measures(self._states, together=True).min(axis=1)
