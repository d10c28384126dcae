"""Hundreds of states beside those of a verification, in float64: where to look for the worst, not what is right there.

A state is what a sample of the verification, or a configuration in some assembly mode, becomes by a step along V; its
parameters are that sample's, or the default ones.  Rates and accelerations satisfy the constraints in every other one,
as there.  The dice do not depend on what was looked at before.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import cached_property
from math import hypot, prod

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.loops_in_lanes import DEPENDENT, LoopsInLanes, lengths_of
from symgen.verify.lanes.masses_in_lanes import MassesInLanes
from symgen.verify.lanes.ranks_in_lanes import is_regular, matrices, measures, ranked_parts
from symgen.verify.lanes.rates_in_lanes import RatesInLanes
from symgen.verify.lanes.small_matrices import products, pseudoinverses
from symgen.verify.powers_of_ten import power_of_ten
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.nearby_states import Nearby, of_samples
from symgen.verify.sampling.plain_values import values_at
from symgen.verify.sampling.reach import reachable, unstated_lengths
from symgen.verify.sampling.states import Sample
from symgen.verify.sampling.task_ahead import TaskInLanes

# Shares of the ranges of coordinates: how far states are drawn from samples, and moved from where they are.
REACH = 0.2
# Shares of ranges that states move by, a step further from where they are.
FURTHER = 0.05
QUARTER = np.pi / 2
# Of each kind fewer states where decompositions of large parts take longest: the cube of their coordinates counts.
CUBES, FEWEST = 200_000_000, 8
# Powers of ten: how far an angle is from a multiple of a quarter turn.
OFF = (1.0, 5.0)
# Powers of ten by which inputs of half of the states are smaller than those of samples, as where a machine coasts:
# inputs that move its heaviest body hide what rounding does to light ones that weights, springs or rates alone move.
LITTLE_INPUT = (1.0, 4.0)
# Powers of ten by which a machine that all but rests is slower than samples are, its inputs as much smaller.
SLOWER = (1.0, 4.0)
# Powers of ten by which inputs are smaller where weights or springs alone drive a machine that all but rests: what
# these leave of a result that they do not load is all there is then.
HARDLY_ANY_INPUT = (4.0, 9.0)
# How often a state is led on along a line that is drawn, how far that goes at most in shares of ranges, how much of the
# way is left, and the steps that show the slope, shares of that.
LED_STEPS, LONGEST_LED, WAY_LEFT, PROBED = 8, 0.4, 0.3, 1e-2
# Of its range: a coordinate that is so near to 0 may be next to it as well, by so many powers of ten.
SMALL, NEXT_TO_ZERO = 1e-2, 11
# In how many samples that is looked at, and how large these forces are beside inputs.
SAMPLES_LOOKED_AT, LEAST_DRIVE = 8, 0.1


class Surroundings:
    """What lies near the samples of a verification."""

    def __init__(
        self, reference: Reference, samples: Sequence[Sample], modes: Sequence[Sequence[float]] = ()
    ) -> None:
        self._system, self._parts = reference.system, ranked_parts(reference.system, reference.ranks)
        literals = self._literals = [float(x) for x in reference.literals()]
        self._loops, self._task = LoopsInLanes(reference.system, literals), TaskInLanes(reference.system, literals)
        self._rates_in_lanes = RatesInLanes(reference.system, self._parts, self._loops)
        self.samples = of_samples(samples)
        parts = self.samples.parts
        self._modes = np.array([list(q) for q in modes]).reshape(len(modes), reference.model.n)
        self._defaults = np.array([float(x) for x in default_parameters(reference.model)])
        coordinates = self._coordinates = reference.model.coordinates
        self._widths = np.array([float(c.range[1] - c.range[0]) for c in coordinates])
        self._unstated = unstated_lengths(coordinates)
        # ranges that nobody told may be left by every configuration there is
        low, high = reachable(coordinates)
        met = [parts["q"], self._modes]
        self._low = np.minimum(low, np.concatenate(met).min(axis=0, initial=np.inf))
        self._high = np.maximum(high, np.concatenate(met).max(axis=0, initial=-np.inf))
        self._stated = np.array([c.has_range for c in coordinates], dtype=bool)
        angles = np.array([c.is_angle for c in coordinates])
        self._beyond = np.where(self._stated, np.where(angles, np.pi, self._widths), 0.0)
        self._rates = np.array([float(c.rate_range[1]) for c in coordinates])
        self._accelerations = np.array([float(c.acceleration_range[1]) for c in coordinates])
        self._inputs = np.abs(parts["u"]).max(axis=1, initial=1.0)[:, None]
        looked_at = samples[:SAMPLES_LOOKED_AT]
        self._driven_by_itself = any(_driven_by_itself(reference, sample.state) for sample in looked_at)

    def affordable(self, count: int) -> int:
        """So many states, or as many as large parts leave time for."""
        cubes = sum(len(part.coordinates) ** 3 for part in self._system.parts)
        return min(count, max(FEWEST, CUBES // cubes))

    def drawn(self, count: int) -> Nearby:
        """About so many: a step off each sample in turn, with other rates, accelerations and inputs."""
        start = self.samples.only(np.arange(count) % len(self.samples))
        return self._stepped(start, REACH, 1.0, random.Random("nearby"), afresh=True)

    def in_modes(self, count: int) -> Nearby:
        """About so many: a step off each assembly mode in turn, for default parameters and for those of samples."""
        start = self.samples.only(np.arange(count) % len(self.samples))
        if not len(self._modes):
            return start.only(slice(0))
        turn = np.arange(count) // len(self._modes)
        q, p = self._modes[np.arange(count) % len(self._modes)], start.parts["p"]
        p = np.where((turn % 4 != 3)[:, None], self._defaults, p)
        start = Nearby({**start.parts, "q": q, "p": p}, start.admissible, start.origins)
        return self._stepped(start, REACH, 1.0, random.Random("modes"), afresh=True)

    def at_modes(self, count: int) -> Nearby:
        """So many assembly modes as they are, that of the file first, for default parameters; rates are of samples."""
        q = self._modes[:count]
        start = self.samples.only(np.arange(len(q)) % len(self.samples))
        p = np.tile(self._defaults, (len(q), 1))
        return Nearby({**start.parts, "q": q, "p": p}, start.admissible, start.origins)

    def further_out(self, count: int) -> Nearby:
        """So many where lengths without a range are anywhere that they may reach; none where every length has one."""
        start = self.samples.only(np.arange(count) % len(self.samples))
        if not self._unstated.any():
            return start.only(slice(0))
        shares = (1 + _shifts(random.Random("further out"), start.parts["q"])) / 2
        q = np.where(self._unstated, self._low + shares * (self._high - self._low), start.parts["q"])
        return self._led(start, q, 1.0, random.Random("out"), afresh=True)

    def aligned(self, count: int) -> Nearby:
        """About so many with an angle near a multiple of a quarter turn, where a sine or cosine vanishes.

        What divides by one of them loses digits there, and states at random do not come near.
        """
        start = self.samples.only(np.arange(count) % len(self.samples))
        angles = [place for place, c in enumerate(self._coordinates) if c.unit == "rad"]
        if not angles:
            return start.only(slice(0))
        dice = random.Random("aligned")
        places = np.array([dice.choice(angles) for _ in range(count)])
        before = start.parts["q"][np.arange(count), places]
        off = np.array([dice.choice((-1, 1)) * power_of_ten(-dice.uniform(*OFF)) for _ in range(count)])
        held = (places, np.round(before / QUARTER) * QUARTER + off)
        with np.errstate(all="ignore"):
            q, _ = self._loops.newton(start.parts["q"], start.parts["p"], held)
            parts = {**start.parts, "q": q}
            return self._settled(Nearby(parts, start.admissible, start.origins), start.parts["q"])

    def resting(self, count: int) -> Nearby:
        """So many samples that all but rest, where what cancels of weights and of inputs is all there is."""
        start = self.samples.only(np.arange(count) % len(self.samples))
        dice = random.Random("resting")
        pace = np.array([power_of_ten(-dice.uniform(*SLOWER)) for _ in range(count)])[:, None]
        slow = {name: start.parts[name] * pace for name in ("qd", "qdd", "u")}
        with np.errstate(all="ignore"):
            return self._settled(Nearby({**start.parts, **slow}, start.admissible, start.origins), start.parts["q"])

    def hardly_driven(self, count: int) -> Nearby:
        """So many that all but rest, with next to no inputs; none where inputs alone drive the machine."""
        start = self.resting(count)
        if not self._driven_by_itself:
            return start.only(slice(0))
        dice = random.Random("hardly driven")
        little = np.array([power_of_ten(-dice.uniform(*HARDLY_ANY_INPUT)) for _ in range(len(start))])[:, None]
        u = self.samples.parts["u"][start.origins] * little
        return Nearby({**start.parts, "u": u}, start.admissible, start.origins)

    def towards(self, count: int, least: Sequence[float]) -> Nearby:
        """So many nearer and nearer to where rows, or inputs, lose rank, as far as measures stay above the least."""
        return self._drawn_towards(count, least, random.Random("towards"), None)

    def out_of_ranges(self, count: int, least: Sequence[float]) -> Nearby:
        """The same out of the ranges of the file, half a turn or a width of these away: kernels answer there, too."""
        if not self._stated.any():
            return self.samples.only(slice(0))
        return self._outside(self._drawn_towards(count, least, random.Random("out of ranges"), None, self._beyond))

    def around_zero(self, count: int) -> Nearby:
        """So many on V where all coordinates are small; none where it leads elsewhere."""
        start = self.drawn(count)
        with np.errstate(all="ignore"):
            q, shut = self._loops.newton(
                SMALL * self._widths * _shifts(random.Random("zero"), start.parts["q"]), start.parts["p"]
            )
        small = shut.all(axis=1) & (np.abs(q) < SMALL * self._widths).all(axis=1)
        return Nearby({**start.parts, "q": q}, start.admissible, start.origins).only(small)

    def next_to_zero(self, states: Nearby) -> Nearby:
        """Where a coordinate of these states is small, some that are nearer to 0, one in each of eleven powers of ten.

        Floats are dense at 0 alone: if rows or inputs lose rank there, a state may be nearer to that than any other
        coordinate is to its own rounding.
        """
        dice = random.Random("next to zero")
        q = states.parts["q"]
        small = (np.abs(q) < SMALL * self._widths) & (q != 0)
        places = np.flatnonzero(small.any(axis=1)).repeat(NEXT_TO_ZERO)
        states, small = states.only(places), small[places]
        share = np.array([power_of_ten(-(1 + k % NEXT_TO_ZERO + dice.random())) for k in range(len(places))])
        q = np.where(small, states.parts["q"] * share[:, None], states.parts["q"])
        with np.errstate(all="ignore"):
            q, shut = self._loops.newton(q, states.parts["p"])
            led = Nearby({**states.parts, "q": q}, states.admissible, states.origins)
            return self._with_rates(led.only(shut.all(axis=1)))

    def towards_no_mass(self, count: int, least: Sequence[float], share: float) -> Nearby:
        """So many to where a direction loses its mass, as far as its share of the largest stays above one.

        The others stay as far from a drop of rank as measures say.
        """
        least = [*least, share * self._largest_share]
        return self._drawn_towards(count, least, random.Random("towards no mass"), self._masses)

    def no_mass_out_of_ranges(self, count: int, least: Sequence[float], share: float) -> Nearby:
        """The same out of the ranges of the file."""
        if not self._stated.any():
            return self.samples.only(slice(0))
        least, dice = [*least, share * self._largest_share], random.Random("no mass out of ranges")
        return self._outside(self._drawn_towards(count, least, dice, self._masses, self._beyond))

    def shares_of_mass(self, states: Nearby) -> Lanes:
        """The least inertia of a direction over the largest, beside the largest such share of samples."""
        return self._masses.shares(states.parts["q"], states.parts["p"]) / self._largest_share

    @cached_property
    def _masses(self) -> MassesInLanes:
        constraints = sum(part.constraints for part in self._parts)
        return MassesInLanes(self._system, constraints, self._loops, self._literals)

    @cached_property
    def _largest_share(self) -> float:
        return float(self._masses.shares(self.samples.parts["q"], self.samples.parts["p"]).max())

    def _outside(self, states: Nearby) -> Nearby:
        """Those with a coordinate out of the range that the file states."""
        q = states.parts["q"]
        return states.only((((q < self._low) | (q > self._high)) & self._stated).any(axis=1))

    def _drawn_towards(
        self,
        count: int,
        least: Sequence[float],
        dice: random.Random,
        masses: MassesInLanes | None,
        beyond: Lanes | float = 0.0,
    ) -> Nearby:
        start = self.drawn(count)
        lanes = np.arange(len(start))
        which, rounds = (lanes % 2, lanes // 2 % LED_STEPS) if masses is None else (0 * lanes + 2, lanes % LED_STEPS)
        q, p, low = start.parts["q"], start.parts["p"], np.array(least)

        def far(q: Lanes) -> tuple[Lanes, Lanes]:
            """Where that leads, and how far it is from a drop of rank: the root of a measure falls along a line."""
            q, shut = self._loops.newton(q, p)
            made = measures(self._parts, self._matrices(q, p), together=True)
            if masses is not None:
                made = np.concatenate((made, masses.shares(q, p)[:, None]), axis=1)
            inside = ((q >= self._low - beyond) & (q <= self._high + beyond)).all(axis=1)
            good = shut.all(axis=1) & inside & (made >= low).all(axis=1)
            # in seven digits: what is led there does not depend on the last bits of decompositions
            distance = np.sqrt(made[lanes, which]).astype(np.float32).astype(float)
            return q, np.where(good, distance, np.nan)

        with np.errstate(all="ignore"):
            now = far(q)[1]
            for number in range(LED_STEPS):
                probe = PROBED * np.minimum(LONGEST_LED, now)[:, None]
                beside, made = far(q + probe * _shifts(dice, q) * self._widths)
                # along V, so that a long step stays near it
                along = (beside - q) / probe
                share = (WAY_LEFT - 1) * now / ((made - now) / probe[:, 0])
                longest = LONGEST_LED / np.abs(along / self._widths).max(axis=1)
                led, made = far(q + np.clip(share, -longest, longest)[:, None] * along)
                nearer = (made < now) & (number < rounds)
                q, now = np.where(nearer[:, None], led, q), np.where(nearer, made, now)
        return self._with_rates(Nearby({**start.parts, "q": q}, start.admissible, start.origins))

    def measures(self, states: Nearby, together: bool) -> Lanes:
        """What tells how far rows and inputs are from a drop of rank, a row for each state; `together` as there."""
        return measures(self._parts, self._matrices(states.parts["q"], states.parts["p"]), together)

    def tangents(self, states: Nearby) -> Lanes:
        """What is left of changes of coordinates (n x n) along V, for each state."""
        n = self._system.n
        projectors = np.broadcast_to(np.eye(n), (len(states), n, n)).copy()
        blocks = self._matrices(states.parts["q"], states.parts["p"])
        for part, (rows, _) in zip(self._parts, blocks, strict=True):
            unit = np.nan_to_num(rows / lengths_of(rows))
            these = np.array(part.coordinates)
            projectors[:, these[:, None], these] -= products(pseudoinverses(unit, DEPENDENT), unit)
        return projectors

    def moved(self, states: Nearby, seed: str) -> Nearby:
        """States a step further, of which some are left out: those that are not regular or out of range."""
        return self._stepped(states, FURTHER, 2 * FURTHER, random.Random(f"nearby {seed}"), afresh=False)

    def _stepped(self, start: Nearby, reach: float, share: float, dice: random.Random, afresh: bool) -> Nearby:
        q = start.parts["q"] + reach * _shifts(dice, start.parts["q"]) * self._widths
        return self._led(start, np.clip(q, self._low, self._high), share, dice, afresh)

    def _led(self, start: Nearby, q: Lanes, share: float, dice: random.Random, afresh: bool) -> Nearby:
        """At other configurations, with rates, accelerations and inputs drawn afresh or changed by a share."""
        count, kept = len(start), 0.0 if afresh else 1.0
        parts = {**start.parts, "q": q}
        widths = {"qd": self._rates, "qdd": self._accelerations, "u": self._inputs_of(start, afresh)}
        for name, width in widths.items():
            parts[name] = kept * parts[name] + share * _shifts(dice, parts[name]) * width
        admissible = np.arange(count) // len(self.samples) % 2 == 0 if afresh else start.admissible
        with np.errstate(all="ignore"):
            return self._settled(Nearby(parts, admissible, start.origins), start.parts["q"])

    def _inputs_of(self, start: Nearby, afresh: bool) -> Lanes:
        """How large inputs are made, a row for each state; those of a state that goes on stay about as large."""
        if not afresh:
            return np.abs(start.parts["u"]).max(axis=1, initial=0.0)[:, None]
        dice = random.Random("inputs")
        little = np.array([power_of_ten(-dice.uniform(*LITTLE_INPUT)) for _ in range(len(start))])
        whole = np.arange(len(start)) // len(self.samples) // 2 % 2 == 0
        return self._inputs[start.origins] * np.where(whole, 1.0, little)[:, None]

    def _settled(self, states: Nearby, start: Lanes) -> Nearby:
        """Brought onto V, rates and accelerations too where they are to be.

        Of machines side by side those that a step leads nowhere stay where they were.
        """
        parts, p = dict(states.parts), states.parts["p"]
        q, shut = self._loops.newton(parts["q"], p)
        slack = 0.01 * self._widths
        inside = (q >= self._low - slack) & (q <= self._high + slack)
        good = np.ones(len(q), dtype=bool)
        for part, blocks in zip(self._parts, self._matrices(q, p), strict=True):
            these = list(part.coordinates)
            led = inside[:, these].all(axis=1) & shut[:, these].all(axis=1) & is_regular(part, *blocks)
            if len(self._parts) == 1:
                good = led
            else:
                q[:, these] = np.where(led[:, None], q[:, these], start[:, these])
        parts["q"] = q
        return self._with_rates(Nearby(parts, states.admissible, states.origins).only(good))

    def _with_rates(self, states: Nearby) -> Nearby:
        """Configurations on V with rates and accelerations that are brought onto it where they are to be."""
        qd, qdd, finite = self._rates_in_lanes.admissible(states.parts)
        on = states.admissible[:, None]
        rates = {name: np.where(on, made, states.parts[name]) for name, made in (("qd", qd), ("qdd", qdd))}
        parts = {**states.parts, **rates}
        parts["task"] = self._task.ahead(parts)
        return Nearby(parts, states.admissible, states.origins).only(finite)

    def _matrices(self, q: Lanes, p: Lanes) -> list[tuple[Lanes, Lanes]]:
        """B and M of each part."""
        return matrices(self._system, self._parts, self._loops, q, p)


def _driven_by_itself(reference: Reference, state: State) -> bool:
    """Whether the potential's force along the motion counts beside the inputs."""
    try:
        (force,) = values_at(reference, state, ["projected_potential_force"]).values()
    except ReferenceValueError:
        return False
    return hypot(*force) > LEAST_DRIVE * max(map(abs, state.u), default=0.0)


def _shifts(dice: random.Random, like: Lanes) -> Lanes:
    """Numbers between -1 and 1."""
    return np.array([2 * dice.random() - 1 for _ in range(prod(like.shape))]).reshape(like.shape)
