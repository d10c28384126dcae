"""States of a verification with one parameter far from what it is there, loops closed and rates on the constraints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType

import numpy as np

from symgen.verify.expected import Expected
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.loops_in_lanes import CLOSED_IN_LANES, LoopsInLanes
from symgen.verify.lanes.ranks_in_lanes import is_regular, matrices, ranked_parts
from symgen.verify.lanes.rates_in_lanes import RatesInLanes
from symgen.verify.margins.far_errors import Far, joined
from symgen.verify.powers_of_ten import power_of_ten
from symgen.verify.sampling.nearby_states import joined as joined_states
from symgen.verify.sampling.nearby_states import of_samples
from symgen.verify.sampling.task_ahead import TaskInLanes

# Powers of ten by which a parameter is away at most: they are looked at one by one.
FURTHEST = 9
# Of a power of ten: steps in which loops are led on, and in which the first one that is too far is looked at again.
QUARTER = 0.25
# Below and above, as signs of powers.
SIDES = (-1, 1)
# States of the verification from which all of them come, and from which places are looked for where the loops close;
# where no loop has to close again, states near to these and assembly modes, that of the file the first.
FAR_STARTS, NEAR_STARTS, MODE_STARTS = 32, 448, 64
# Numbers that are held at a time.
NUMBERS_HELD = 4_000_000
# Coordinates that are kept of configurations with a parameter far away, and states of each that are kept in any case.
MOST_KEPT, LEAST_KEPT = 8_000_000, 8
# Rows and inputs this far from a drop of rank are no reason for a status: parameters are.
CLEAR = 1e-5
# Times the steps of Newton's method from a state to where its loops close with a parameter far away.
RENEWED = 5
# Starts, where none are chosen.
NO_PLACES: Lanes = np.array([], dtype=int)
NONE_CHOSEN: Mapping[tuple[int, int], Lanes] = MappingProxyType({})


class FarStates:
    """Those of one verification."""

    def __init__(self, expected: Expected) -> None:
        self._system, self._drawn = expected.reference.system, expected.drawn
        literals = [float(x) for x in expected.reference.literals()]
        self._loops, self._task = LoopsInLanes(self._system, literals), TaskInLanes(self._system, literals)
        self._near = expected.surroundings
        self._parts = ranked_parts(self._system, expected.reference.ranks)
        self._rates = RatesInLanes(self._system, self._parts, self._loops)

    def led(
        self,
        steps: Sequence[tuple[int, float]],
        states: int,
        chosen: Mapping[tuple[int, int], Lanes] = NONE_CHOSEN,
        led: int = 0,
    ) -> Far:
        """States with one parameter far away, for each step (which, and by what power of ten) as far as loops close.

        On a side of a parameter, `chosen` starts come before others.  Of those that move configurations as many as are
        `led` count, where these are more.
        """
        rows = []
        for which, power in steps:
            places = self._places(which, power)
            first = chosen.get((which, 1 if power > 0 else -1), NO_PLACES)
            places = np.concatenate((first[np.isin(first, places)], places[~np.isin(places, first)]))
            most = max(states, led) if which in self._moving else states
            rows += [(which, place, power) for place in places[:most].tolist()]
        system = self._system
        held = max(1, NUMBERS_HELD // (system.n * (system.n + system.m + system.r)))
        return joined([self._at(rows[start : start + held]) for start in range(0, max(1, len(rows)), held)])

    def _places(self, which: int, power: float) -> Lanes:
        """The states with which the loops close with a parameter away by a power of ten; of few where it moves them."""
        if which in self._moving:
            return np.flatnonzero(self._closed[1][(*_step(power), self._moving[which])])
        return np.arange(len(self._starts["q"]))

    def shifted(self, rows: Sequence[tuple[int, float]], states: int) -> dict[str, Lanes]:
        """The first of all states for each parameter, by a factor each, as if nothing else depended on it."""
        given = {name: np.tile(values[:states], (len(rows), 1)) for name, values in self._starts.items()}
        states = len(given["p"]) // len(rows)
        which, factors = (np.repeat(column, states) for column in zip(*rows, strict=True))
        given["p"][np.arange(len(which)), which] *= factors
        return given

    def _at(self, rows: Sequence[tuple[int, int, float]]) -> Far:
        """The states with a parameter, a start and a power of ten each."""
        which, place = np.array([row[:2] for row in rows], dtype=int).reshape(-1, 2).T
        far = np.array([row[2] for row in rows])
        given = {name: values[place] for name, values in self._starts.items()}
        given["p"][np.arange(len(which)), which] *= power_of_ten(far)
        for row, (parameter, start, power) in enumerate(rows):
            if parameter in self._moving:
                given["q"][row] = self._closed[0][(*_step(power), self._moving[parameter], start)]
        given["qd"], given["qdd"], finite = self._rates.admissible(given)
        with np.errstate(all="ignore"):
            given["task"] = self._task.ahead(given)
        return Far(which, far, place, given, self._regular(given)).only(finite)

    def _regular(self, given: Mapping[str, Lanes]) -> Lanes:
        """Whether neither rows nor inputs are near a drop of rank."""
        regular = np.ones(len(given["q"]), dtype=bool)
        with np.errstate(all="ignore"):
            blocks = matrices(self._system, self._parts, self._loops, given["q"], given["p"])
            for part, (rows, control) in zip(self._parts, blocks, strict=True):
                regular &= is_regular(part, rows, control, share=CLEAR)
        return regular

    @cached_property
    def leading(self) -> frozenset[int]:
        """The parameters that move configurations: beside other values the loops are open."""
        q, p = self._starts["q"][:1], self._starts["p"][:1]
        count = p.shape[1]
        moved = [p * np.where(np.eye(count, dtype=bool), power_of_ten(sign * QUARTER), 1.0) for sign in SIDES]
        with np.errstate(all="ignore"):
            still = [self._loops.shut(q.repeat(count, axis=0), one, CLOSED_IN_LANES) for one in moved]
        return frozenset(np.flatnonzero(~np.logical_and(*still)).tolist())

    @cached_property
    def _moving(self) -> dict[int, int]:
        """The places of the parameters that move configurations among themselves."""
        return {parameter: k for k, parameter in enumerate(sorted(self.leading))}

    @cached_property
    def _closed(self) -> tuple[Lanes, Lanes]:
        """Where the loops close with a parameter further and further away, and whether they do.

        By side, quarter of a power of ten, parameter that moves them and state: each step starts where the one before
        it ended.  Where that leads nowhere each power of ten is looked for from the state itself, and quarters beyond
        one at which a state does not close are left out; where none of the states closes, a parameter is not led
        further on that side.
        """
        leading, steps = [*self._moving], round(FURTHEST / QUARTER)
        n = self._starts["q"].shape[1]
        most = max(LEAST_KEPT, min(FAR_STARTS, MOST_KEPT // (len(SIDES) * steps * len(leading) * n)))
        starts = {name: values[:most] for name, values in self._starts.items()}
        count = len(starts["q"])
        shape = len(SIDES), steps, len(leading), count
        configurations, shut = np.empty((*shape, n)), np.zeros(shape, dtype=bool)
        # both sides of all parameters together: a few hundred states take hardly longer than half of them
        sides, which = np.divmod(np.arange(len(SIDES) * len(leading)), len(leading))
        moved, signs = np.array(leading)[which], np.array(SIDES)[sides]
        led = np.arange(len(which))
        q, lost = np.tile(starts["q"], (len(led), 1)), np.zeros(len(led) * count, dtype=bool)
        for step in range(steps):
            power, place = QUARTER * (step + 1), np.tile(np.arange(count), len(led))
            p = starts["p"][place]
            p[np.arange(len(place)), moved[led].repeat(count)] *= power_of_ten(signs[led] * power).repeat(count)
            whole = power.is_integer()
            closed, tried = np.zeros(len(q), dtype=bool), np.flatnonzero(~lost | whole)
            q[tried], closed[tried] = self._newton(q[tried], p[tried])
            for look in (self._loops.damped, self._further) if whole else ():
                still = np.flatnonzero(~closed)
                with np.errstate(all="ignore"):
                    reached = look(starts["q"][place[still]], p[still])
                q[still], closed[still] = self._newton(reached, p[still])
            q = np.where(closed[:, None], q, starts["q"][place])
            configurations[sides[led], step, which[led]] = q.reshape(len(led), count, n)
            shut[sides[led], step, which[led]] = by_parameter = closed.reshape(len(led), count)
            if whole:
                kept = by_parameter.any(axis=1).repeat(count)
                led, q, lost = led[kept[::count]], q[kept], ~closed[kept]
            if not len(led):
                break
        return configurations, shut

    def _newton(self, q: Lanes, p: Lanes) -> tuple[Lanes, Lanes]:
        """Where Newton's method leads, and whether all loops are closed there."""
        with np.errstate(all="ignore"):
            q, shut = self._loops.newton(q, p)
        return q, shut.all(axis=1)

    def _further(self, q: Lanes, p: Lanes) -> Lanes:
        """Where so many times the steps of Newton's method lead: it takes more of them to far larger lengths.

        Each step halves the way there; what is no nearer after all of them once goes nowhere.
        """
        q, moving = q.copy(), np.arange(len(q))
        left = self._loops.left_open(q, p)
        for _ in range(RENEWED):
            q[moving], shut = self._newton(q[moving], p[moving])
            before, left[moving] = left[moving], self._loops.left_open(q[moving], p[moving])
            moving = moving[~shut & (left[moving] < before / 2)]
        return q

    @cached_property
    def _starts(self) -> dict[str, Lanes]:
        modes_first = joined_states(self._near.at_modes(MODE_STARTS), self._near.drawn(NEAR_STARTS))
        return dict(joined_states(of_samples(self._drawn[:FAR_STARTS]), modes_first).parts)


def _step(power: float) -> tuple[int, int]:
    """The side of a power of ten, and which of its quarters it is."""
    return int(power > 0), round(abs(power) / QUARTER) - 1
