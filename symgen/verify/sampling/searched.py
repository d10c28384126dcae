"""States at which a kernel is worst, searched for: a few dozen drawn ones do not meet them.

Rounding errors are estimated at hundreds of states near those of the verification, then some steps further from the
worst of these.  Only where the estimate leaves a doubt are states brought onto V, what rounding does there is measured,
and the worst are judged, in units of d + eps |y*| by the reference, as at any state of the verification.  A status
there is an answer.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from math import dist

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Function, Kernel, Scalar
from symgen.ir.pairs.wide import paired
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.model.quantities import MAIN
from symgen.runtime.activity import working
from symgen.verify.certificate import SearchRecord
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.running.compile import Outcome
from symgen.verify.sampling.inertias import DIVIDED_BY_MASSES, REGULAR_INERTIA
from symgen.verify.sampling.judged import numbers_hide, worst_judged
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.nearby_states import Nearby, joined, of_samples
from symgen.verify.sampling.settling import NEARER, Settling
from symgen.verify.sampling.states import Sample, rounded
from symgen.verify.single_precision import lost_in_float32
from symgen.verify.tolerance import FACTOR, GrowingUnit

# States drawn; fewer of long kernels, so that no more numbers are held at a time.
DRAWN, ALIGNED, IN_MODES, RESTING, FURTHER_OUT, TOWARDS, HARDLY_DRIVEN = 512, 256, 256, 128, 256, 256, 64
# Numbers that are held at a time; of long kernels fewer states are looked at together.
NUMBERS = 4_000_000
# Of the worst of them, how many go further, in how many directions, and how often.
KEPT, DIRECTIONS, STEPS_FURTHER = 32, 8, 3
# Units; what is estimated counts every rounding with all that it may do, and d for less than it is.
DOUBTFUL = FACTOR / 2
# How many are judged, and how many are brought onto V at most: not all that lie near come to a regular state.
JUDGED, SETTLED = 8, 32
# How many more are, of those at which float32 is measured to lose most.
MEASURED = 4


@dataclass(frozen=True)
class _Estimates:
    """States, the rounding errors that are estimated there, the unit of d + eps |y| for a roundoff of 1, and where
    nothing speaks against a regular state: elsewhere errors are 0, others would take the places of these.

    Where rows depend on each other there are two units, one of them along V.  d of the reference is near the one for
    some machines and near the other for others: worst states of both are looked at.
    """

    states: Nearby
    own: Lanes
    units: tuple[Lanes, ...]
    regular: Lanes

    def __add__(self, other: _Estimates) -> _Estimates:
        own, regular = (np.concatenate(pair) for pair in ((self.own, other.own), (self.regular, other.regular)))
        units = tuple(np.concatenate(pair) for pair in zip(self.units, other.units, strict=True))
        return _Estimates(joined(self.states, other.states), own, units, regular)

    def in_units(self, errors: Lanes) -> list[Lanes]:
        """Errors, for a roundoff of 1, at regular states."""
        return [np.where(self.regular, errors / unit, 0.0) for unit in self.units]

    @property
    def estimated(self) -> list[Lanes]:
        """What rounding may do, in each unit."""
        return self.in_units(self.own)


class WorstStateSearch:
    """The worst states of the quantities of a model, those of every method that was looked at."""

    def __init__(self, expected: Expected) -> None:
        self._expected = expected
        self._states: defaultdict[str, list[Sample]] = defaultdict(list)
        self._looked_at: set[tuple[str, str]] = set()
        # None where there is no value once the state is rounded
        self._units_there: dict[tuple[str, int, Scalar], GrowingUnit | None] = {}

    def look(self, quantity: str, method: str, plain: Callable[[], Kernel]) -> None:
        """Adds the worst states of a method, by its kernel of plain numbers, once.

        However its numbers are grouped, and with how many digits it works: it is worst where it was.
        """
        if (quantity, method) in self._looked_at:
            return
        self._looked_at.add((quantity, method))
        with working("estimates beside samples"):
            kernel = plain()
            errors = RoundingErrors(kernel)
            self._add(kernel, errors, self._estimated(kernel, errors))

    def _add(self, kernel: Kernel, errors: RoundingErrors, made: _Estimates) -> None:
        samples = self._brought(kernel, made.states, made.estimated, SETTLED)
        chosen = self._worst_of(kernel, errors, samples) if len(samples) > JUDGED else samples
        if "float32" in self._expected.scalars:
            # beside those that estimates tell of, not in their places
            lost = lost_in_float32(kernel, made.states.parts) / float(UNIT_ROUNDOFF["float32"])
            chosen += self._brought(kernel, made.states, made.in_units(lost), MEASURED)
        doubtful = np.max(made.estimated, axis=0) > DOUBTFUL
        if doubtful.any() and numbers_hide(self._expected, kernel, errors):
            chosen += worst_judged(self._expected, self._settling(kernel.name), kernel, made.states, doubtful)
        known = self._states[kernel.name]
        known += [sample for sample in dict.fromkeys(chosen) if sample not in known]

    def _brought(self, kernel: Kernel, states: Nearby, units: Sequence[Lanes], count: int) -> list[Sample]:
        """So many of the worst in each unit that leave a doubt, where they can be brought onto V."""
        settling = self._settling(kernel.name)
        doubtful = (place for ranked in units for place in _worst(ranked, count) if ranked[place] > DOUBTFUL)
        tried = (
            settling.sample(states.state(place), bool(states.admissible[place]), kernel.name)
            for place in dict.fromkeys(doubtful)
        )
        return [sample for sample in tried if sample is not None]

    def _worst_of(self, kernel: Kernel, errors: RoundingErrors, samples: Sequence[Sample]) -> list[Sample]:
        """Those that a kernel of plain numbers does worst at, half of them in each scalar type.

        Estimates are what rounding may do; what it does is measured beside twice the digits, or beside float64.
        """
        states = of_samples(samples)
        _, *units = errors.with_both(states.parts, self._tangents(states))
        double, single = ([rounded(sample, scalar).state for sample in samples] for scalar in UNIT_ROUNDOFF)
        made, exact = (outcomes(one, None, "float64", double) for one in (kernel, paired(kernel, "float64")))
        short, long = (outcomes(kernel, None, scalar, single) for scalar in ("float32", "float64"))
        apart = _apart(made, exact), _apart(short, long)
        units = units[: self._count_of_units]
        rankings = [_worst(off / unit, len(samples)).tolist() for unit in units for off in apart]
        worst = dict.fromkeys(chain.from_iterable(zip(*rankings, strict=True)))
        return [samples[place] for place in islice(worst, JUDGED * len(units))]

    def largest(self, kernel: Kernel, sincos: Function | None, scalar: Scalar) -> float:
        """The largest error with status 0, in units of d + eps |y*|, at the states that were found for its quantity.

        They are those of every method that was looked at.
        """
        states = [rounded(sample, scalar).state for sample in self._states[kernel.name]]
        worst, judged = 0.0, self._judged(kernel, scalar)
        for place, made in enumerate(outcomes(kernel, sincos, scalar, states)):
            if made.valid and judged[place]:
                worst = self._units_above(kernel.name, place, scalar, made.entries, worst)
        return worst

    def _judged(self, kernel: Kernel, scalar: Scalar) -> Lanes:
        """Whether each state is one for a kernel.

        Pairs of float32 hardly have digits for a direction that all but has no mass: how near to that they hold is
        looked at later, and where they do not they have a status (`verify/margins/next_to_singular.py`).
        """
        samples = self._states[kernel.name]
        if scalar == "float64" or not samples or not works_with_pairs(kernel) or kernel.name not in DIVIDED_BY_MASSES:
            return np.ones(len(samples), dtype=bool)
        return self._surroundings.shares_of_mass(of_samples(samples)) >= REGULAR_INERTIA

    def _units_above(
        self, quantity: str, place: int, scalar: Scalar, entries: Sequence[float], least: float
    ) -> float:
        """The error of entries in units where that is above the least; where there is no value there is none."""
        key = quantity, place, scalar
        try:
            if key not in self._units_there:
                state = rounded(self._states[quantity][place], scalar).state
                seed = f"{scalar} searched {place}"
                self._units_there[key] = GrowingUnit(self._expected.reference, state, quantity, scalar, seed)
            there = self._units_there[key]
            return least if there is None else there.units_above(entries, least)
        except ReferenceValueError:
            self._units_there[key] = None
            return least

    def _estimated(self, kernel: Kernel, errors: RoundingErrors) -> _Estimates:
        """What is estimated at states near those of the verification."""
        count = NUMBERS // (len(kernel.statements) + 1)
        states = self._beside_singular if kernel.name in MAIN else self._drawn
        if kernel.name in DIVIDED_BY_MASSES.intersection(MAIN):
            states = joined(states, self._all_but_massless)
        near = len(states)
        if near > count:
            samples = len(self._surroundings.samples)
            others = np.linspace(samples, near, max(0, count - samples), endpoint=False).astype(int)
            states = states.only(np.append(np.arange(samples), others))
        self._expected.record_search(SearchRecord(kernel.name, "worst states", len(states), near))
        least = self._settling(kernel.name).measures
        made = self._units(errors, states, least, kernel.name in MAIN)
        going = min(self._affordable(KEPT * DIRECTIONS), max(count, DIRECTIONS))
        for step in range(STEPS_FURTHER if max(units.max() for units in made.estimated) > DOUBTFUL else 0):
            rankings = [_worst(units, KEPT).tolist() for units in made.estimated]
            places = islice(dict.fromkeys(chain.from_iterable(zip(*rankings, strict=True))), KEPT)
            worst = made.states.only(np.array(list(places)))
            starts = worst.only(np.arange(len(worst)).repeat(DIRECTIONS)[:going])
            further = self._surroundings.moved(starts, f"{kernel.name} {step}")
            if len(further):
                made += self._units(errors, further, least, kernel.name in MAIN)
        return made

    def _tangents(self, states: Nearby) -> Lanes | None:
        """Of V, where rows depend on each other."""
        return self._surroundings.tangents(states) if self._count_of_units > 1 else None

    @cached_property
    def _count_of_units(self) -> int:
        reference = self._expected.reference
        return 1 + (reference.ranks.constraints < reference.system.r)

    def _units(self, errors: RoundingErrors, states: Nearby, least: Sequence[float], together: bool) -> _Estimates:
        own, *units = errors.with_both(states.parts, self._tangents(states))
        regular = (self._surroundings.measures(states, together) >= least).all(axis=1)
        return _Estimates(states, own, tuple(units[: self._count_of_units]), regular)

    @property
    def _surroundings(self) -> Surroundings:
        return self._expected.surroundings

    @cached_property
    def _drawn(self) -> Nearby:
        around = self._surroundings
        states = joined(around.samples, around.aligned(self._affordable(ALIGNED)))
        states = joined(states, around.in_modes(self._affordable(IN_MODES)))
        states = joined(states, around.resting(self._affordable(RESTING)))
        states = joined(states, around.further_out(self._affordable(FURTHER_OUT)))
        states = joined(states, around.drawn(self._affordable(DRAWN)))
        return joined(states, around.hardly_driven(self._affordable(HARDLY_DRIVEN)))

    @cached_property
    def _beside_singular(self) -> Nearby:
        """These and others that are led towards a drop of rank."""
        _, nearest = self._settlings
        return joined(self._drawn, self._surroundings.towards(self._affordable(TOWARDS), nearest.measures))

    @cached_property
    def _all_but_massless(self) -> Nearby:
        """Others that are led to where a direction loses its mass."""
        _, nearest = self._settlings
        count = self._affordable(TOWARDS)
        return self._surroundings.towards_no_mass(count, nearest.measures, NEARER * REGULAR_INERTIA)

    def _affordable(self, count: int) -> int:
        return self._surroundings.affordable(count)

    def _settling(self, quantity: str) -> Settling:
        return self._settlings[quantity in MAIN]

    @cached_property
    def _settlings(self) -> tuple[Settling, Settling]:
        """For other quantities, and for the main ones."""
        reference, samples = self._expected.reference, self._expected.drawn
        return Settling(reference, samples), Settling(reference, samples, NEARER)


def _worst(units: Lanes, count: int) -> Lanes:
    """The places of the largest."""
    return np.argsort(-units, kind="stable")[:count]


def _apart(results: Sequence[Outcome], exact: Sequence[Outcome]) -> Lanes:
    """How far results are apart; 0 where one of them is none."""
    pairs = zip(results, exact, strict=True)
    return np.nan_to_num([dist(one.entries, other.entries) for one, other in pairs], posinf=0.0)
