"""Worst states where the numbers of a file hide how far off a kernel is: judged one by one, not estimated.

A file that holds the same length twice may close for no other pair; the unit of error moves both apart, and is many
times what arguments and parameters do.  Estimates leave these numbers out.  A kernel is worst where they hardly count.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.sampling.nearby_states import Nearby, of_samples
from symgen.verify.sampling.settling import Settling
from symgen.verify.sampling.states import Sample, affordable_states, rounded
from symgen.verify.tolerance import GrowingUnit

# Times as large as estimated that a unit of error is at some sample: from there on its size hides what is worst.
HIDDEN = 4.0
# States that are judged, fewer where the reference takes long.
JUDGED_AT_MOST = 128
# Of the worst of them, how many go further, in how many directions, and how often.
GOING_ON, WAYS, FURTHER_ROUNDS = 4, 8, 3


def numbers_hide(expected: Expected, kernel: Kernel, errors: RoundingErrors) -> bool:
    """Whether units of error at samples are far above what arguments and parameters make them."""
    for scalar in expected.scalars:
        samples, values = expected.samples(scalar), expected.values(scalar)
        _, estimated, _ = errors.with_both(of_samples(samples).parts, None)
        units = np.array([value[kernel.name].unit for value in values]) / float(UNIT_ROUNDOFF[scalar])
        if (units > HIDDEN * estimated).any():
            return True
    return False


def worst_judged(
    expected: Expected, settling: Settling, kernel: Kernel, states: Nearby, doubtful: Lanes
) -> list[Sample]:
    """The worst of states that leave a doubt, looked at as evenly as they were drawn, and of some beside these."""
    count = affordable_states(expected.reference, [kernel.name], JUDGED_AT_MOST)
    places = np.flatnonzero(doubtful)
    places = np.unique(places[np.linspace(0, len(places) - 1, min(count, len(places))).astype(int)])
    worst = _Worst(expected, kernel)
    worst.judge(_settled(settling, kernel.name, states.only(places)))
    for number in range(FURTHER_ROUNDS):
        starts = of_samples(worst.kept)
        starts = starts.only(np.arange(len(starts)).repeat(min(WAYS, count)))
        moved = expected.surroundings.moved(starts, f"{kernel.name} judged {number}")
        worst.judge(_settled(settling, kernel.name, moved))
    return list(worst.kept)


def _settled(settling: Settling, quantity: str, states: Nearby) -> Iterator[Sample]:
    tried = (settling.sample(states.state(k), bool(states.admissible[k]), quantity) for k in range(len(states)))
    return (sample for sample in tried if sample is not None)


class _Worst:
    """The few states at which a kernel is worst, in any scalar type, of those that were judged."""

    def __init__(self, expected: Expected, kernel: Kernel) -> None:
        self._expected, self._kernel = expected, kernel
        self._known: list[tuple[float, Sample]] = []

    @property
    def kept(self) -> Sequence[Sample]:
        """They themselves, the worst first."""
        return [sample for _, sample in self._known]

    def judge(self, samples: Iterator[Sample]) -> None:
        """Looks at more."""
        for sample in samples:
            units = max(chain((0.0,), self._units(sample)))
            if units > self._least:
                self._known = sorted([*self._known, (units, sample)], key=lambda one: -one[0])[:GOING_ON]

    @property
    def _least(self) -> float:
        return self._known[-1][0] if len(self._known) == GOING_ON else 0.0

    def _units(self, sample: Sample) -> Iterator[float]:
        """In each type; no more is looked at than shows that a state is none of them."""
        name = self._kernel.name
        for scalar in self._expected.scalars:
            state = rounded(sample, scalar).state
            (made,) = outcomes(self._kernel, None, scalar, [state])
            if made.valid and all(map(math.isfinite, made.entries)):
                try:
                    unit = GrowingUnit(self._expected.reference, state, name, scalar, f"{scalar} judged")
                    yield unit.units_above(made.entries, self._least)
                except ReferenceValueError:
                    continue
