"""How near to a drop of rank a kernel holds what status 0 says, where a threshold leaves more room than it has digits.

Floats are dense at 0 alone.  Where rows or inputs lose rank in a configuration whose coordinates are 0, or a direction
its mass, a state may be nearer to that than coordinates are to their own rounding elsewhere, rounding moves the result
by next to nothing, and digits that a kernel loses count.  States are led there; where a kernel that holds everywhere
else is beyond what is allowed, its thresholds are raised until it has a status.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.raised import MASSES, Raised, with_raised_thresholds
from symgen.model.quantities import MAIN
from symgen.runtime.activity import working
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.margins.lost_digits import LostDigits
from symgen.verify.reference.reference import State
from symgen.verify.sampling.inertias import DIVIDED_BY_MASSES, REGULAR_INERTIA
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.nearby_states import Nearby, joined
from symgen.verify.sampling.searched import NUMBERS
from symgen.verify.sampling.settling import NEARER, Settling
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


@dataclass(frozen=True)
class _Led:
    """States that are led to where something is lost, how far each is from that, and which thresholds tell."""

    field: str
    states: Nearby
    distances: Lanes


class NextToSingular:
    """Those states of one verification."""

    def __init__(self, expected: Expected) -> None:
        self._expected, self._digits = expected, LostDigits(expected)

    def raised(
        self, kernels: Mapping[Scalar, Kernel], programs: Mapping[Scalar, Program]
    ) -> dict[Scalar, Raised | None]:
        """By how much the thresholds of the kernels of a quantity are to be raised, by scalar type.

        By no decade where a number that is too small to have digits is all there is to be refused; None where digits
        are lost and no threshold refuses that, or none that leaves regular states what they are.
        """
        made: dict[Scalar, Raised | None] = {}
        with working("next to singular states"):
            for scalar, kernel in kernels.items():
                if kernel.name in MAIN and self._digits.are_measured(kernel, scalar):
                    made[scalar] = self._raised(kernel, programs, scalar)
        return {scalar: raised for scalar, raised in made.items() if raised != Raised()}

    def _raised(self, kernel: Kernel, programs: Mapping[Scalar, Program], scalar: Scalar) -> Raised | None:
        raised, sincos = Raised(), programs[scalar].sincos
        by_field = {led.field: list(self._lost(kernel, programs, scalar, led)) for led in self._led(kernel)}
        for field, lost in by_field.items():
            if lost:
                raised = replace(raised, **{field: self._decades(kernel, programs, scalar, field, lost)})
        every = [state for lost in by_field.values() for state in lost]
        # what is lost on the way to one may be refused by the thresholds of the other: masses have a place there, too
        for field in by_field:
            made = outcomes(with_raised_thresholds(kernel, scalar, raised), sincos, scalar, every)
            left = [state for state, one in zip(every, made, strict=True) if one.valid]
            if not left:
                return raised
            if getattr(raised, field) is None:
                raised = replace(raised, **{field: self._decades(kernel, programs, scalar, field, left)})
        made = outcomes(with_raised_thresholds(kernel, scalar, raised), sincos, scalar, every)
        return None if any(one.valid for one in made) else raised

    def _led(self, kernel: Kernel) -> Iterator[_Led]:
        if len(self._next_to_a_drop.states):
            yield self._next_to_a_drop
        divided = any(check.status in MASSES for block in kernel.blocks for check in block.checks)
        if divided and kernel.name in DIVIDED_BY_MASSES and len(self._next_to_no_mass.states):
            yield self._next_to_no_mass

    def _decades(
        self,
        kernel: Kernel,
        programs: Mapping[Scalar, Program],
        scalar: Scalar,
        field: str,
        lost: Sequence[State],
    ) -> int | None:
        """By how many all of the states at which digits are lost are refused, and no regular one; None by none."""
        sincos = programs[scalar].sincos
        regular = [sample.state for sample in self._expected.samples(scalar)]
        before = [one.status for one in outcomes(kernel, sincos, scalar, regular)]
        for decades in range(0, MOST_DECADES, DECADES_RAISED):
            raised = with_raised_thresholds(kernel, scalar, Raised(**{field: decades}))
            if not any(one.valid for one in outcomes(raised, sincos, scalar, lost)):
                more = decades + MARGIN if decades else 0
                raised = with_raised_thresholds(kernel, scalar, Raised(**{field: more}))
                after = [one.status for one in outcomes(raised, sincos, scalar, regular)]
                return more if after == before else None
        return None

    def _lost(
        self, kernel: Kernel, programs: Mapping[Scalar, Program], scalar: Scalar, led: _Led
    ) -> Iterator[State]:
        """States of status 0 at which the reference finds more lost than is allowed, the furthest first."""
        states = led.states
        # of long kernels fewer states are looked at
        count = min(len(states), NUMBERS // (len(kernel.statements) + 1))
        places = np.linspace(0, len(states), count, endpoint=False).astype(int)
        doubtful = places[self._digits.units(kernel, programs, scalar, states.only(places)) > DOUBTFUL]
        order = doubtful[np.argsort(-led.distances[doubtful], kind="stable")][:JUDGED]
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
    def _next_to_a_drop(self) -> _Led:
        led = self._around.towards(self._around.affordable(LED), self._settling.measures)
        around_zero = self._around.around_zero(self._around.affordable(AROUND_ZERO))
        states = self._affordable(self._around.next_to_zero(joined(led, around_zero)))
        return _Led("ranks", states, self._around.measures(states, together=True).min(axis=1))

    @cached_property
    def _next_to_no_mass(self) -> _Led:
        """Those, too, that are led there alone: pairs of float32 lose digits before."""
        count, least = self._around.affordable(LED), NEARER * REGULAR_INERTIA
        led = self._around.towards_no_mass(count, self._settling.measures, least)
        states = self._affordable(joined(led, self._around.next_to_zero(led)))
        return _Led("masses", states, self._around.shares_of_mass(states))

    def _affordable(self, states: Nearby) -> Nearby:
        count = self._around.affordable(len(states))
        return states.only(np.linspace(0, len(states), count, endpoint=False).astype(int))
