"""Regular configurations on the constraint manifold V: from starts all over the ranges, then by steps along V.

Parameters are drawn from their ranges and, in two of five states, those of the file: lengths that are equal or zero
there make a mechanism special, and users start with them.
Where a mechanism moves there are as many as are asked for, however little of V the starts reach: from one that is
known a step along an admissible direction, closed again, leads to the next.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import inf, isfinite, pi, sqrt
from typing import Any

from symgen.model.expressions.names import shown_names
from symgen.verify.reference.arithmetic.tape import ball
from symgen.verify.reference.configurations.closing import admissible, closed
from symgen.verify.reference.configurations.manifold import exceeds, starts
from symgen.verify.reference.configurations.parts import Part
from symgen.verify.reference.parameter_values import ParameterValues, default_parameters
from symgen.verify.reference.reference import BeyondLimitsError, LocksError, Reference, ReferenceValueError, State
from symgen.verify.sampling.plain_values import SAMPLING_BITS, floats, in_floats, measured, settled
from symgen.verify.sampling.reach import out_of_range
from symgen.verify.sampling.within_limits import driven_within_limits

# Regular states that a verification needs.
FEWEST_STATES = 8
# Of usual lengths of rows, and of the largest singular value: with less a state is near singular ones.
REGULAR_SHARE = 1e-3
# Of a coordinate, by which every fourth state is moved off V at most.
DRIFT = 1e-3
# How far angles may lie outside of their ranges in states, and how many times as far out as the ranges and the
# configurations that are known all others may.
TURNS, FAR_OUT = 2, 10
# Configurations that tell how large measures and rows usually are.
MEASURED_POINTS = 8
# Steps along V, in widths of the ranges.
LONGEST_STEP, SHORTEST_STEP = 0.2, 1e-5
# Of so many starts one is drawn where loops have to be closed; others lie beside the state before.
FRESH = 4
# Of so many starts one lies in an assembly mode, and in some the parameters are those of the file.
CYCLE, MODE, DEFAULTS = 5, 2, (2, 3)
# Starts of the loops of a system that lead elsewhere than to regular states, while the others stay.
LOOP_RESTARTS = 12
# Where of the first starts less than a share leads to regular states in the ranges, steps along V look for the others.
PROBES, POOR = 40, 8
CLOSED, BRANCH, AWAY = "do not close", "lie on other branches", "lie far outside of the ranges"
VALUE, SINGULAR, BEYOND = "have no value", "are singular", "need inputs beyond their limits"
LOCKED = "lock by friction"


@dataclass(frozen=True, slots=True)
class Regular:
    """A regular state as drawn, rates and accelerations not projected yet, and the inputs as shares of their size."""

    state: State
    shares: tuple[float, ...]
    admissible: bool
    values: dict[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class _Sizes:
    """What tells how far from singular a configuration is: both measures of each part, the length of each row of B."""

    measures: Sequence[float]
    rows: Sequence[float]

    @property
    def finite(self) -> bool:
        return all(map(isfinite, (*self.measures, *self.rows)))


class RegularStateSearch:
    """The search for `count` regular states of a model, the same for the same seed; `explanation` says what it met."""

    def __init__(
        self, reference: Reference, count: int, seed: int, modes: Sequence[Sequence[float]] = ()
    ) -> None:
        self._reference, self._system, self._modes = reference, reference.system, modes
        self._count = count
        self._generator = random.Random(f"states {seed}")
        self._points = starts(self._system, self._generator, 6 * count + 60)
        self._literals = reference.literals()
        self._known = reference.model.assembly
        tied = () if self._known is None else self._known.tied
        ranged = [p.name for p in reference.model.parameters if p.range is not None and p.name not in tied]
        self._varied = ParameterValues(reference.model, ranged)
        self._owners: Sequence[Part] = ()
        self._least = self._limits()
        self._kept = {True: 0, False: 0}
        self._met: list[_Sizes] = []
        # where the last start led, and coordinates of the parts that are not to stay there
        self._reached: list[Any] = []
        self._wanting: set[int] = set()
        self._ends: Counter[str] = Counter()
        self._lost: Counter[str] = Counter()

    def candidates(self) -> Iterator[tuple[Regular, bool]]:
        """Regular states, and whether the coordinates lie in their ranges."""
        last: list[Any] | None = None
        inside: list[Any] | None = None
        for index, point in enumerate(self._points):
            if index == PROBES and self._system.r_geometric and self._kept[True] < PROBES // POOR:
                break
            parameters = self._parameters(vary=index > 0 and index % CYCLE not in DEFAULTS)
            if self._modes and index % CYCLE == MODE:
                start: Sequence[Any] = self._modes[index // CYCLE % len(self._modes)]
            elif last is not None and index % FRESH and self._system.r_geometric:
                start = self._step(last)
            else:
                start = point
            reached = self._reached_from(start, parameters)
            if reached is not None:
                last = reached[0]
                inside = last if reached[2] else inside
                yield reached[1:]
        if self._kept[True] < FEWEST_STATES and self._system.r_geometric:
            yield from self._along(inside)

    def has_no_value(self) -> None:
        """A state that was found is none: some quantity has no value there."""
        self._ends[VALUE] += 1

    def explanation(self) -> str:
        """What became of the others, as the end of a sentence."""
        if not self._ends:
            return ""
        ends = ", ".join(f"{count} {end}" for end, count in self._ends.most_common())
        lost = f", where {shown_names(sorted(self._lost))} lose rank or vanish" if self._lost else ""
        return f": of the others looked at {ends}{lost}"

    def _along(self, last: list[Any] | None) -> Iterator[tuple[Regular, bool]]:
        """Most of V are other branches or singular, or its size is far from that of the ranges: steps along it.

        Where all but nothing was regular the closest to it that is met counts.
        """
        known = [list(place.q) for place in self._known.places] if self._known is not None else []
        known = known or [list(self._points[0])]
        reach = LONGEST_STEP
        for index in range(len(self._points)):
            if self._kept[True] >= self._count:
                return
            here = known[index % len(known)] if last is None or reach <= SHORTEST_STEP else last
            reach = LONGEST_STEP if reach <= SHORTEST_STEP else reach
            if self._met and sum(self._kept.values()) < FEWEST_STATES:
                measures = (max(column) for column in zip(*(one.measures for one in self._met), strict=True))
                rows = (max(column) for column in zip(*(one.rows for one in self._met), strict=True))
                self._least = _Sizes(
                    [min(low, most / 10) for low, most in zip(self._least.measures, measures, strict=True)],
                    [min(low, REGULAR_SHARE * most) for low, most in zip(self._least.rows, rows, strict=True)],
                )
            # other lengths may leave no room to move
            parameters = self._parameters(vary=index % 2 > 0)
            reached = self._reached_from(self._shifted(here, parameters, reach), parameters)
            if reached is None:
                reach /= 2
                continue
            if reached[2]:
                last, reach = reached[0], min(LONGEST_STEP, 2 * reach)
            else:  # on from where it left the ranges
                reach /= 2
            yield reached[1:]

    def _reached_from(self, start: Sequence[Any], exact: Sequence[Any]) -> tuple[list[Any], Regular, bool] | None:
        """The point of V that a start leads to, the state there, and whether it lies in the ranges.

        Where parts of the system lead elsewhere these are started anew while the others stay: that all of many
        machines lead to a regular state at once is rare.
        """
        several = len(self._system.loops or self._system.parts) > 1
        for left in reversed(range(LOOP_RESTARTS if several else 1)):
            self._wanting.clear()
            reached = self._led_to(start, exact, left > 0)
            if reached is not None or not self._wanting:
                return reached
            anew = [self._generator.uniform(*map(float, c.range)) for c in self._reference.model.coordinates]
            start = [y if j in self._wanting else x for j, (x, y) in enumerate(zip(self._reached, anew, strict=True))]
        return None

    def _wants(self, coordinates: Iterable[int]) -> None:
        """The parts of these coordinates are not to stay where they are."""
        these = set(coordinates)
        for part in self._system.parts:
            if not these.isdisjoint(part.coordinates):
                self._wanting.update(part.coordinates)

    def _led_to(
        self, start: Sequence[Any], exact: Sequence[Any], again: bool
    ) -> tuple[list[Any], Regular, bool] | None:
        """The same of one start; what lies out of the ranges is looked at where parts are not started again."""
        reference = self._reference
        # lengths that others follow from are rounded afterwards: a linkage may close for their exact values alone
        q, still_open = closed(self._system, start, exact, self._literals, rounded=reference.ranks.rounded)
        self._reached = q
        if still_open:
            self._ends[CLOSED] += 1
            self._wants(j for part in still_open for j in part.coordinates)
            return None
        if exceeds(self._system, reference.ranks, q, exact, self._literals):
            self._ends[BRANCH] += 1
            return None
        if away := self._far_away(q):
            self._ends[AWAY] += 1
            self._wants(away)
            return None
        outside = out_of_range(reference.model.coordinates, q)
        if outside and again:
            self._wants(outside)
            return None
        in_range = not outside
        # what lies outside is rarely needed
        needed = measured(reference) if in_range else ()
        regular = self._regular(
            settled(q, [c.range for c in reference.model.coordinates]),
            [float(x) for x in exact],
            self._kept[in_range],
            needed,
        )
        if regular is None:
            return None
        self._kept[in_range] += 1
        return q, regular, in_range

    def _limits(self) -> _Sizes:
        """What measures and rows must be at a regular state.

        Measures are products of about delta numbers between 0 and 1; many rows, or units that make columns of very
        different size, leave them small everywhere, so that no more than a tenth of the largest found is asked for.
        """
        reference, known = self._reference, self._known
        parameters = [float(x) for x in self._parameters(vary=False)]
        points = self._points[:MEASURED_POINTS]
        on_it = points if known is None else [place.q for place in known.places[:MEASURED_POINTS]]
        rows = self._row_lengths(points, parameters)
        if known is not None and reference.ranks.constraints < reference.model.r:
            # of rows that depend on each other some have no gradient anywhere on V, and are no drop of rank there
            here = self._row_lengths(on_it, parameters)
            rows = [0.0 if there < REGULAR_SHARE * x else x for there, x in zip(here, rows, strict=True)]
        free = [reference.model.n - reference.ranks.constraints]
        if known_apart := len(reference.ranks.of_parts) == len(self._system.parts):
            pairs = zip(self._system.parts, reference.ranks.of_parts, strict=True)
            free = [len(part.coordinates) - constraints for part, (constraints, _) in pairs]
        self._owners = self._system.parts if known_apart else ()
        usual = [REGULAR_SHARE ** max(1.0, count / 2) for count in free for _ in range(2)]
        sampled = []
        for q in on_it:
            try:
                measures = reference.measured(_at_rest(reference, q, parameters), (), SAMPLING_BITS)[1]
                sampled.append([float(x) for x in measures])
            except ReferenceValueError:
                continue
        largest = [max((x for x in column if isfinite(x)), default=1.0) for column in zip(*sampled, strict=True)]
        pairs_of_limits = zip(usual, largest or [1.0] * len(usual), strict=True)
        return _Sizes([min(low, x / 10) for low, x in pairs_of_limits], [REGULAR_SHARE * x for x in rows])

    def _row_lengths(self, points: Sequence[Sequence[float]], parameters: Sequence[float]) -> list[float]:
        """The largest length of each row of B over some points, on V or off it."""
        reference = self._reference
        lengths = [0.0] * reference.model.r
        for q in points:
            try:
                state = _at_rest(reference, q, parameters)
                rows = reference.matrices(state, ["constraint_jacobian"], SAMPLING_BITS)["constraint_jacobian"]
            except ReferenceValueError:
                continue
            at_point = _lengths(floats(rows), reference.model.n)
            lengths = [max(pair) if isfinite(pair[1]) else pair[0] for pair in zip(lengths, at_point, strict=True)]
        return lengths

    def _parameters(self, vary: bool) -> list[Any]:
        """Parameter values as balls: those with a range drawn from it."""
        chosen = {
            parameter.name: self._generator.uniform(float(parameter.range[0]), float(parameter.range[1]))
            for parameter in self._varied.model.parameters
            if parameter.range is not None
        }
        return self._varied(chosen) if vary else default_parameters(self._varied.model)

    def _step(self, q: Sequence[Any]) -> list[float]:
        """A start near q: a random step, a tenth of the ranges wide, that the projection brings back to V."""
        return [
            float(x) + self._generator.gauss(0, 0.1) * float(c.range[1] - c.range[0])
            for x, c in zip(q, self._reference.model.coordinates, strict=True)
        ]

    def _shifted(self, q: Sequence[Any], parameters: Sequence[Any], reach: float) -> list[float]:
        """A start off q in a direction that the geometric constraints allow, at most about `reach` ranges away."""
        widths = [float(c.range[1] - c.range[0]) for c in self._reference.model.coordinates]
        share = reach * self._generator.random()
        shift = [share * self._generator.gauss(0, 1) * width for width in widths]
        allowed = admissible(self._system, q, shift, parameters, self._literals)
        return [float(x) + float(a) for x, a in zip(q, allowed, strict=True)]

    def _regular(
        self, q: Sequence[float], parameters: Sequence[float], index: int, needed: Sequence[str]
    ) -> Regular | None:
        """A state at q with what is `needed` of it, or None near a singularity."""
        model, generator = self._reference.model, self._generator
        rates = tuple(generator.uniform(*map(float, c.rate_range)) for c in model.coordinates)
        accelerations = tuple(generator.uniform(*map(float, c.acceleration_range)) for c in model.coordinates)
        shares = tuple(generator.uniform(-1, 1) for _ in model.inputs)
        shifts = [generator.uniform(-1, 1) for _ in model.coordinates]
        places = [q]
        if index % 4 == 3 and self._system.r_geometric and self._reference.ranks.constraints == model.r:
            moved = [x + DRIFT * s * max(abs(x), 0.1) for x, s in zip(q, shifts, strict=True)]
            given = [*map(ball, moved)], [*map(ball, parameters)]
            if not exceeds(self._system, self._reference.ranks, *given, self._literals):
                places.insert(0, moved)
        for place in places:  # on V where a thousandth of the coordinates is more than a small mechanism moves
            state = State(tuple(place), rates, accelerations, (0.0,) * model.m, tuple(parameters))
            if (reached := self._in_motion(state, shares, needed)) is not None:
                state, values, driven = reached
                return Regular(state, shares, driven or index % 2 == 0, values)
        return None

    def _in_motion(
        self, state: State, shares: Sequence[float], needed: Sequence[str]
    ) -> tuple[State, dict[str, tuple[float, ...]], bool] | None:
        """A state with what is needed of it; where its motion takes inputs beyond their limits, a motion that inputs
        within these make, and that it is one."""
        with suppress(BeyondLimitsError):
            values = self._looked_at(state, needed)
            return None if values is None else (state, values, False)
        self._ends[BEYOND] += 1
        driven = driven_within_limits(self._reference, state, shares)
        with suppress(BeyondLimitsError):
            values = None if driven is None else self._looked_at(driven, needed)
            return None if driven is None or values is None else (driven, values, True)
        return None

    def _looked_at(self, state: State, needed: Sequence[str]) -> dict[str, tuple[float, ...]] | None:
        """What is needed of a state; None where it is not regular, which is counted.

        Raises BeyondLimitsError where no inputs within their limits make the motion.
        """
        model = self._reference.model
        try:
            matrices, measures = self._reference.measured(
                state, ("singularity", "constraint_jacobian", *needed), SAMPLING_BITS
            )
        except BeyondLimitsError:  # told apart from what has no value
            raise
        except LocksError:
            self._ends[LOCKED] += 1
            return None
        except ReferenceValueError:
            self._ends[VALUE] += 1
            return None
        values = in_floats(matrices)
        sizes = _Sizes([float(x) for x in measures], _lengths(values["constraint_jacobian"], model.n))
        if sizes.finite:
            self._met.append(sizes)
        # the measures compare directions of rows only; a row that all but vanishes is a drop of rank, too
        small = [i for i, low in enumerate(self._least.rows) if not inf > sizes.rows[i] >= low]
        pairs = zip(sizes.measures, self._least.measures, strict=True)
        low_measures = [place for place, (x, low) in enumerate(pairs) if not inf > x >= low]
        if small or low_measures:
            self._ends[SINGULAR] += 1
            self._lost.update(model.constraints[i].name for i in small)
            for place, part in enumerate(self._owners):
                if not {2 * place, 2 * place + 1}.isdisjoint(low_measures) or not {*small}.isdisjoint(part.rows):
                    self._wanting.update(part.coordinates)
            return None
        return values

    def _far_away(self, q: Sequence[Any]) -> list[int]:
        """The angles turns outside of their ranges, where one step after another leads and nothing new is met, and
        other coordinates that are far out, where one stands in a sine and elsewhere."""
        away = []
        places = () if self._known is None else self._known.places
        for j, (x, c) in enumerate(zip(q, self._reference.model.coordinates, strict=True)):
            low, high = map(float, c.range)
            size = max(abs(low), abs(high), *(abs(float(place.q[j])) for place in places))
            out = TURNS * 2 * pi if c.is_angle else FAR_OUT * size
            if not low - out <= x <= high + out:
                away.append(j)
        return away


def _at_rest(reference: Reference, q: Sequence[float], parameters: Sequence[float]) -> State:
    n, m = reference.model.n, reference.model.m
    return State(tuple(q), (0.0,) * n, (0.0,) * n, (0.0,) * m, tuple(parameters))


def _lengths(rows: Sequence[float], n: int) -> list[float]:
    """The length of each row of n numbers."""
    return [sqrt(sum(x**2 for x in rows[start : start + n])) for start in range(0, len(rows), n)]
