"""States at which numbers are compared: walked to from the drawn configuration, so on the branch that was drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.kkt import EquationEvaluator, EquationValues, GenericRanks, onto_rows
from symgen.laboratory.zoo.witness.numbers.fields import Balls, Floats, precision
from symgen.laboratory.zoo.witness.numbers.float_rows import SAME, normalized, null_space, rank_of
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING
from symgen.laboratory.zoo.witness.reading.reader import SystemReader

STEPS = 30
# steps of refinement at most, and the last of them: it leaves 30 digits of what is 1e-9 away from a singular pose
REFINEMENTS, REFINED = 12, 1e-20
CLOSED = 1e-12
# what is left of rows on V, in lengths of these, and what is no length of a row
ON_IT, NO_LENGTH = 1e-14, 1e-14
# a share of parameters that shows how large they make a row
MOVED = Fraction(1, 10**15)
# of the largest coordinate: what is less after refinement to 30 digits is 0
ROOT_AT_ZERO = 1e-30
# a closed configuration that is refined moves less
ELSEWHERE = 1e-6
# a step that shows whether V is smooth, and how much further than its square Newton's method may lead
SHORT, STRAY = 1e-4, 1e3
# so many of them: one in ten is all but across the direction that is none, and shows nothing
SHORT_STEPS = 8
# rows whose gradients vanish on V do so to the root of what rounding leaves of their values
DEPENDENT = 1e-6
# how far rows, inputs and masses are apart at states that are compared, and how far of what they are at best where that
# is less at all states: lengths of a mechanism may be a hundred times apart
REGULAR, OF_BEST = 1e-3, 0.1
# places beside the start, further for each coordinate, where functions that are 0 there are 0 everywhere
ASIDE = Fraction(1, 70), Fraction(-1, 90)
# a walk stays about as near as the ranges that the documentation takes for granted
FURTHEST = 3.2
# a step along every free direction at most; where ranges or loops that do not close take too many, walks of half the
# stride each find the rest
STRIDE, WALKS = 0.6, 5
# one in so many states all but rests: rates, accelerations and inputs are this much of what they usually are
SLOW_ONES = 4
PACES = 1e-1, 1e-2, 1e-3, 1e-4
# why there are fewer states than were asked for
NOT_CLOSED, STUCK = "the start does not close", "the start is singular and every step led back"
NOWHERE_SMOOTH = "the start is singular and so is all that it leads to"
LOST_STEPS, IRREGULAR, LED_ELSEWHERE = "most steps were lost", "most configurations are singular", "refined elsewhere"


@dataclass(frozen=True)
class FloatState:
    """q, rates, accelerations, inputs and parameters as floats."""

    q: tuple[float, ...]
    qd: tuple[float, ...]
    qdd: tuple[float, ...]
    u: tuple[float, ...]
    parameters: tuple[float, ...]


class Walker:
    """Finds states of a system near a configuration."""

    def __init__(
        self, system: SystemReader, evaluate: EquationEvaluator, start: Mapping[str, float], dice: Dice
    ) -> None:
        self._system, self._evaluate, self._dice = system, evaluate, dice
        self._start = np.array([start.get(name, 0.0) for name in system.coordinates])
        self._floats = Floats()
        self._balls = Balls()
        self._ranges = system.blocks.get("ranges") or {}
        self._voids: tuple[frozenset[int], frozenset[int]] | None = None
        self.lack = ""

    def states(self, parameters: Mapping[str, float], count: int) -> tuple[list[FloatState], GenericRanks]:
        """So many regular states, fewer where they are hard to find (`lack` says why), and the generic ranks."""
        wanted = 3 * count + 6
        points = self.points(parameters, wanted)
        walked = 1
        self.lack = ""
        if self._stuck(points, parameters):
            self.lack = STUCK
        elif not points and self.closed(self._start, parameters) is None:
            self.lack = NOT_CLOSED
        elif self._nowhere_smooth(points, parameters):
            self.lack = NOWHERE_SMOOTH
        if self.lack:
            return [], GenericRanks(0, 0)
        ranks, regular = self._regular(points, parameters)
        while len(regular) < count and walked < WALKS:
            points += self.points(parameters, wanted, STRIDE / 2**walked)
            walked += 1
            ranks, regular = self._regular(points, parameters)
        kept: list[FloatState] = []
        for q in regular:
            if len(kept) == count:
                break
            nearest = self.refined(q, parameters)
            if nearest is not None:
                rests, place = len(kept) % SLOW_ONES == SLOW_ONES - 1, len(kept) // SLOW_ONES
                pace = PACES[place % len(PACES)] if rests else 1.0
                kept.append(self.state(nearest, parameters, pace=pace))
        if len(kept) < count:
            lost = {
                LOST_STEPS: walked * wanted - len(points),
                IRREGULAR: len(points) - len(regular),
                LED_ELSEWHERE: len(regular) - len(kept),
            }
            self.lack = max(lost, key=lost.__getitem__)
        return kept, ranks

    def _regular(self, points: list[Any], parameters: Mapping[str, float]) -> tuple[GenericRanks, list[Any]]:
        """The largest ranks of all, and the configurations that have them by far.

        Where a row all but vanishes at one of them, as where a linkage lies flat, rounding decides which way it points.
        """
        values = [self.numbers(q, parameters) for q in points]
        lengths: Any = np.max([self.lengths(at) for at in values], axis=0, initial=0.0) if values else np.zeros(0)
        whole = [bool((self.lengths(at) >= DEPENDENT * lengths).all()) for at in values]
        points = [q for q, kept in zip(points, whole, strict=True) if kept]
        values = [at for at, kept in zip(values, whole, strict=True) if kept]
        apart = [(self._apart(at), self._driven(at)) for at in values]
        rank = [max((int((both[of] > SAME).sum()) for both in apart), default=0) for of in (0, 1)]
        geometric = max((self._geometric_rank(at) for at in values), default=0)
        ranks = GenericRanks(rank[0], rank[1], tuple(map(float, lengths)), geometric)
        least = [[_value(one, of) for one, of in zip(both, rank, strict=True)] for both in apart]
        enough = np.minimum(REGULAR, OF_BEST * np.max(least, axis=0, initial=0.0))
        regular = [q for q, at in zip(points, least, strict=True) if (at > enough).all()]
        return ranks, regular

    def points(self, parameters: Mapping[str, float], count: int, stride: float = STRIDE) -> list[Any]:
        """Configurations on V: the start, then steps along V, back to the start where a walk leaves its ranges."""
        here = self.closed(self._start, parameters)
        if here is None:
            return []
        first = here
        points = []
        for _ in range(count):
            free = self._free(here, parameters)
            step = free @ np.array([self._dice.uniform(-1, 1) for _ in range(free.shape[1])])
            there = self.closed(here + stride * step, parameters)
            if there is not None and np.abs(there - first).max() < FURTHEST and self._inside(there):
                points.append(there)
                here = there
            else:
                here = first
        return points

    def _stuck(self, points: list[Any], parameters: Mapping[str, float]) -> bool:
        """Whether the walk began where branches meet, rows all but vanish there, and every step led back or nowhere.

        Rounding gives such rows a rank, and nothing can be compared.
        """
        if points and np.ptp(np.array(points), axis=0).max() > DEPENDENT:
            return False
        q = points[0] if points else self.closed(self._start, parameters)
        if q is None:
            return False
        here, *beside = (
            np.linalg.norm(np.array(self.numbers(place, parameters).rows, dtype=float).reshape(-1, len(q)), axis=1)
            for place in (q, q + 0.3, q - 0.2)
        )
        return bool((here < DEPENDENT * np.max(beside, axis=0)).any())

    def _nowhere_smooth(self, points: list[Any], parameters: Mapping[str, float]) -> bool:
        """Whether the walk began where two sheets of V touch and led along both.

        A row is the square of a distance between them there, and what rounding leaves of that decides on ranks.
        """
        geometric = any(row.geometric for row in self._system.rows)
        return bool(points) and geometric and not any(self.is_regular(q, parameters) for q in points)

    def is_regular(self, q: Any, parameters: Mapping[str, float]) -> bool:
        """Whether V is smooth at a configuration, of the dimension that its rows there say.

        Rows count in the lengths that they have beside V: one whose gradient vanishes on V is none.
        """
        beside = [self.numbers(q + self._aside(len(q)), parameters).rows for _ in range(3)]
        usual = np.linalg.norm(np.array(beside, dtype=float), axis=2).max(axis=0)
        usual[usual <= NOTHING] = 1

        def directions(place: Any) -> Any:
            rows = np.array(self.numbers(place, parameters).rows, dtype=float) / usual[:, None]
            values, free = np.linalg.svd(rows)[1:]
            return free[int((values > DEPENDENT * values.max(initial=0.0)).sum()) :].T

        free = directions(q)
        for _ in range(SHORT_STEPS):
            step = free @ np.array([self._dice.uniform(-1, 1) for _ in range(free.shape[1])])
            there = self.closed(q + SHORT * step, parameters)
            if there is None or np.abs(there - q - SHORT * step).max() > STRAY * SHORT**2:
                return False
            if directions(there).shape != free.shape:
                return False
        return bool(free.shape[1] > 0)

    def _aside(self, count: int) -> Any:
        return np.array([self._dice.uniform(-0.3, 0.3) for _ in range(count)])

    def _inside(self, q: Any) -> bool:
        for name, value in zip(self._system.coordinates, q, strict=True):
            if name in self._ranges:
                lower, upper = (self._number(text) for text in self._ranges[name])
                if not lower <= value <= upper:
                    return False
        return True

    def _number(self, text: str) -> float:
        return float(self._system.tape.evaluate([self._system.read(text)], {}, self._floats)[0])

    def numbers(self, q: Any, parameters: Mapping[str, float], qd: Any = None) -> EquationValues:
        """The equations of motion in floats."""
        rates = qd if qd is not None else [0.0] * len(q)
        values = {**parameters, **dict(zip(self._system.coordinates, map(float, q), strict=True))}
        values |= dict(zip(self._system.rate_names, map(float, rates), strict=True))
        at, (void, idle) = self._evaluate(values, self._floats), self._void(parameters)
        rows = [[0.0] * at.n if i in void else row for i, row in enumerate(at.rows)]
        residual = [0.0 if i in void else x for i, x in enumerate(at.residual)]
        control = [[0.0 if k in idle else x for k, x in enumerate(row)] for row in at.control]
        return replace(at, rows=rows, residual=residual, control=control)

    def _void(self, parameters: Mapping[str, float]) -> tuple[frozenset[int], frozenset[int]]:
        """The rows, and the inputs, that are 0 beside V, too: what rounding leaves of one in small units is longer than
        another row, and of the only input it is all there is."""
        if self._voids is None:
            number, names = self._balls.number, self._system.coordinates
            rows, inputs = set(range(len(self._system.rows))), set(range(len(self._system.inputs)))
            with precision():
                fixed = {name: number(Fraction(value)) for name, value in parameters.items()}
                fixed |= dict.fromkeys(self._system.rate_names, number(Fraction(0)))
                for aside in ASIDE:
                    exact = [number(Fraction(float(x)) + (1 + k) * aside) for k, x in enumerate(self._start)]
                    at = self._evaluate({**fixed, **dict(zip(names, exact, strict=True))}, self._balls)
                    rows = {i for i in rows if all(map(_is_nothing, at.rows[i]))}
                    inputs = {k for k in inputs if all(_is_nothing(row[k]) for row in at.control)}
            self._voids = frozenset(rows), frozenset(inputs)
        return self._voids

    def closed(self, q: Any, parameters: Mapping[str, float]) -> Any:
        """The nearest configuration that satisfies the geometric rows, to the last digits; None where there is none."""
        geometric = sum(row.geometric for row in self._system.rows)
        if not geometric:
            return q
        best, stalled, nearest = math.inf, 0, q
        for _ in range(STEPS):
            try:
                at = self.numbers(q, parameters)
            except (ValueError, OverflowError, ZeroDivisionError):
                return None
            rows: Any = np.array(at.rows[:geometric])
            residual = np.array(at.residual)
            lengths = np.linalg.norm(rows, axis=1)
            lengths[lengths <= NOTHING] = 1
            gap = float(np.abs(residual / lengths).max())
            if gap >= best:
                stalled += 1
            else:
                best, nearest = gap, q
            if stalled >= 3 or gap == 0:
                break
            steep = rows / lengths[:, None]
            steep[np.linalg.norm(rows, axis=1) <= NOTHING] = 0
            q = q - np.linalg.lstsq(steep, residual / lengths, rcond=SAME)[0]
        # where rows depend on each other, steps after that follow what rounding leaves of a direction
        return nearest if best < CLOSED else None

    def refined(self, q: Any, parameters: Mapping[str, float], rank: int | None = None) -> Any:
        """The float nearest to a configuration that satisfies the rows to 30 digits; None where that is another one, or
        none is reached.

        Where rows depend on each other nothing is defined off V but by rounding.  Where a direction of them is all but
        lost, its rows do not show what `rank` they have elsewhere on V, and without a step along it what comes out is
        beside V by as much as the way to where it is lost.
        """
        geometric = sum(row.geometric for row in self._system.rows)
        if not geometric:
            return q
        number = self._balls.number
        names = self._system.coordinates
        if rank is None:
            rank = self._geometric_rank(self.numbers(q, parameters))
        with precision():
            fixed = {name: number(Fraction(value)) for name, value in parameters.items()}
            fixed |= dict.fromkeys(self._system.rate_names, number(Fraction(0)))
            exact = [number(Fraction(float(x))) for x in q]
            for _ in range(REFINEMENTS):
                at = self._evaluate({**fixed, **dict(zip(names, exact, strict=True))}, self._balls)
                step = onto_rows(at.rows[:geometric], at.residual, rank)
                exact = [(x + dx).mid() for x, dx in zip(exact, step, strict=True)]
                # the next one is of the square of this, in units of the way to where rows lose rank
                if max(abs(float(dx)) for dx in step) < REFINED:
                    break
            else:
                return None
            if not self._is_on(exact, fixed, geometric):
                return None
            nearest = np.array([float(x) for x in exact])
        # what is less than these digits is what steps leave of a root at 0
        nearest[np.abs(nearest) < ROOT_AT_ZERO * np.abs(nearest).max(initial=0.0)] = 0.0
        return nearest if np.abs(nearest - q).max(initial=0.0) < ELSEWHERE else None

    def _is_on(self, exact: Sequence[Any], fixed: Mapping[str, Any], geometric: int) -> bool:
        """Whether the rows are satisfied to the last digits of lengths in a file.

        Next to singular poses the least of what they leave need not be 0.  A row that hardly changes with coordinates,
        such as that of a bar which stands across it, is as large as what parameters make of it.
        """
        values = {**fixed, **dict(zip(self._system.coordinates, exact, strict=True))}
        at = self._evaluate(values, self._balls)
        lengths = [max(abs(float(x)) for x in row) for row in at.rows[:geometric]]

        def closed(sizes: Sequence[float]) -> bool:
            gaps = zip(at.residual, lengths, sizes, strict=True)
            return all(abs(float(x)) <= ON_IT * size or length < NO_LENGTH for x, length, size in gaps)

        if closed(lengths):
            return True
        sizes, share = list(lengths), self._balls.number(MOVED)
        for name in (name for name in fixed if name not in self._system.rate_names):
            moved = self._evaluate({**values, name: values[name] * (1 + share)}, self._balls).residual
            changes = (abs(float((x - y) / share)) for x, y in zip(moved, at.residual, strict=True))
            sizes = [size + change for size, change in zip(sizes, changes, strict=True)]
        return closed(sizes)

    def _geometric_rank(self, at: EquationValues) -> int:
        """The rank of the rows of loops."""
        geometric = sum(row.geometric for row in self._system.rows)
        return rank_of(normalized(np.array(at.rows[:geometric], dtype=float).reshape(geometric, at.n)), SAME)

    def _free(self, q: Any, parameters: Mapping[str, float]) -> Any:
        at = self.numbers(q, parameters)
        return null_space(at)

    @staticmethod
    def lengths(at: EquationValues) -> Any:
        """The length of each row."""
        return np.linalg.norm(np.array(at.rows, dtype=float).reshape(-1, at.n), axis=1)

    @staticmethod
    def _apart(at: EquationValues) -> Any:
        """Singular values of the rows, each in its length, relative to the largest."""
        values = np.linalg.svd(normalized(np.array(at.rows, dtype=float).reshape(-1, at.n)), compute_uv=False)
        return values / values.max(initial=NOTHING)

    @staticmethod
    def _driven(at: EquationValues) -> Any:
        """Singular values of the inputs, each in its length, along V."""
        control = np.array(at.control, dtype=float).reshape(at.n, -1)
        lengths = np.linalg.norm(control, axis=0)
        # what rounding leaves of an input that moves nothing has no direction
        idle = lengths <= NOTHING * lengths.max(initial=0.0)
        control[:, idle], lengths[idle] = 0, 1
        return np.linalg.svd(null_space(at).T @ (control / lengths), compute_uv=False)

    def state(
        self, q: Any, parameters: Mapping[str, float], rank: int | None = None, pace: float = 1.0
    ) -> FloatState:
        """A state with admissible rates and accelerations at a configuration, `rank` being that of the rows.

        `pace` times what is usual are rates, accelerations but those that the rates ask for, and inputs.
        """
        free = null_space(self.numbers(q, parameters), rank)
        spread = [pace * self._dice.uniform(-1.5, 1.5) for _ in range(free.shape[1])]
        qd = free @ np.array(spread)
        moving = self.numbers(q, parameters, qd)
        qdd = free @ np.array([pace * self._dice.uniform(-4, 4) for _ in range(free.shape[1])])
        if moving.drift:
            qdd = qdd - self._inverse(moving.rows, rank) @ np.array(moving.drift)
        u = [pace * self._dice.uniform(-8, 8) for _ in self._system.inputs]
        return FloatState(*(tuple(map(float, part)) for part in (q, qd, qdd, u, parameters.values())))

    @staticmethod
    def _inverse(rows: Any, rank: int | None) -> Any:
        """The pseudoinverse of the rows, of as many directions as their rank where that is known."""
        if rank is None:
            return np.linalg.pinv(np.array(rows), rcond=SAME)
        left, values, right = np.linalg.svd(np.array(rows), full_matrices=False)
        return right[:rank].T @ (left[:, :rank] / values[:rank]).T


def _value(values: Any, count: int) -> float:
    """The last of so many singular values: 0 where there are fewer, 1 where none is asked for."""
    if not count:
        return 1.0
    return float(values[count - 1]) if len(values) >= count else 0.0


def _is_nothing(ball: Any) -> bool:
    return bool(ball.is_finite() and ball.contains(0))


def rounded(values: Sequence[float], scalar: str) -> tuple[float, ...]:
    """Rounded to float32 where that is asked for."""
    return tuple(float(np.float32(value)) for value in values) if scalar == "float32" else tuple(values)
