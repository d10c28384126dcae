"""Admissible motions of a mechanism in balls: configurations on the constraints, rates and accelerations that they
allow."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import cast

from flint import arb, arb_mat

from symgen.model.combinations.ball_matrices import Matrix, kernel
from symgen.model.combinations.straight_lines import RecordedLine, RecordedNumber, Recorder
from symgen.model.combinations.taylor_balls import (
    Ball,
    TimeSeries,
    WideBallError,
    ball,
    ball_numbers,
    constant,
    may_vanish,
    rounding,
    series_of,
)
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.model import Model

# The seed of configurations and motions: the same model is looked at at the same ones.
MOTION_SEED = 20260720
# Steps of Newton's method in double precision at most.
FLOAT_STEPS = 20
# What the last of them is below.
FLOAT_STEP = 1e-9
# Steps in balls with the last of its matrices at most: each leaves a share of 1e-9 or less.
BALL_STEPS = 80
# A step along a branch, in ranges of coordinates: twice as long after one that was taken, half as long after one that
# was not.
LONGEST_STRIDE = 0.2
# The share of a step by which a configuration may lie beside it: what is further away may be on another branch.
OFF_BRANCH = 0.5
# The shortest step before the longest one is tried again.
SHORTEST_STRIDE = 1e-3
# Steps that lead nowhere, in a row, before the search ends.
MOST_MISSED = 60
# Configurations that steps set out from.
MOST_ORIGINS = 12


class NoMotionError(Exception):
    """No regular configuration was found, or none at which anything moves."""


@dataclass(frozen=True)
class MotionState:
    """q(t) up to the second power of the time, and a basis F of the admissible rates at t = 0 (n x delta)."""

    q: tuple[TimeSeries, ...]
    directions: Matrix


class BallSystem:
    """A model seen in balls, with the given numbers in place of its parameters' defaults; without its constraint rows
    where it is `open`."""

    def __init__(self, model: Model, given: Mapping[str, Fraction], is_open: bool = False) -> None:
        numbers = ball_numbers()
        values: dict[str, float] = {}
        for parameter in model.parameters:
            name = parameter.name
            values[name] = (
                cast(float, constant(given[name])) if name in given else numbers.evaluate(parameter.value, values)
            )
        rows = () if is_open else model.constraints
        plain = NumericSystem(
            model.coordinates, model.parameters, model.definitions, rows, model.kinetic_energy, model.mechanism
        )
        self._floats = plain.having({name: float(value) for name, value in values.items()})
        self.numeric = plain.having(values)
        self.numeric.numbers = numbers
        self.n = len(model.coordinates)
        self.model = replace(model, constraints=rows)

    def rows(self, q: Sequence[TimeSeries]) -> list[dict[int, TimeSeries]]:
        """B along q(t)."""
        rows = self.numeric.rows(cast(Sequence[float], q))
        return [{j: series_of(value) for j, value in row.items()} for row in rows]

    def closed(self, q: Sequence[float]) -> tuple[Ball, ...] | None:
        """The configuration that Newton's method leads to, in balls that hold it; None where it leads nowhere.

        Rows that follow from others are left out, and coordinates that others determine worse stay where they are.
        """
        numbers = range(len(self.numeric.geometric))
        place = [float(x) for x in q]
        if not numbers:
            return tuple(map(arb, place))
        pairs: list[tuple[int, int]] = []
        for _ in range(FLOAT_STEPS):
            values, slopes = self._floats.residuals(place, numbers)
            pairs = pairs or _pivots([[row.get(j, 0.0) for j in range(self.n)] for row in slopes])
            try:
                matrix = arb_mat([[arb(slopes[i].get(j, 0.0)) for _, j in pairs] for i, _ in pairs])
                moved = _step(matrix, pairs, list(map(arb, values)))
            except ZeroDivisionError:
                return None
            for (_, j), x in zip(pairs, moved, strict=True):
                place[j] += float(x)
            if max(map(abs, map(float, moved)), default=0.0) < FLOAT_STEP:
                return self._closed_in_balls(list(map(arb, place)), matrix, pairs)
        return None

    def _closed_in_balls(
        self, place: list[Ball], matrix: arb_mat, pairs: Sequence[tuple[int, int]]
    ) -> tuple[Ball, ...] | None:
        for _ in range(BALL_STEPS):
            moved = _step(matrix, pairs, self._gaps(place))
            for (_, j), x in zip(pairs, moved, strict=True):
                place[j] = (place[j] + x).mid()
            last = max(map(abs, map(float, moved)), default=0.0)
            if last < rounding():
                # the next step would be far smaller than this one
                held = [arb(one, 2.0 * last + rounding()) for one in place]
                return tuple(held) if all(map(may_vanish, self._gaps(held))) else None
        return None

    def _gaps(self, q: Sequence[Ball]) -> list[Ball]:
        return self._recorded_gaps.run(q)

    @cached_property
    def _recorded_gaps(self) -> RecordedLine:
        recorder = Recorder()
        given = {name: recorder.constant(series_of(value).c[0]) for name, value in self.numeric.defaults.items()}
        numeric = self.numeric.having(cast(dict[str, float], given))
        numeric.numbers = recorder.numbers()
        q = cast(Sequence[float], [recorder.given() for _ in range(self.n)])
        values = numeric.values(q, range(len(numeric.geometric)))
        return recorder.line(cast(Sequence[RecordedNumber], values))


def motion_states(system: BallSystem, start: Sequence[float], rank: int) -> Iterator[MotionState]:
    """States of a walk along one branch, where B has this rank: without end.

    `start` is a configuration in double precision.  NoMotionError where the walk gets no further: what parameters show
    on a piece of a branch they show on all of it.
    """
    generator = random.Random(MOTION_SEED)
    spans = [float(c.range[1] - c.range[0]) for c in system.model.coordinates]
    first = system.closed(start)
    if first is not None and (state := _moving(system, first, rank, generator)) is not None:
        places = [_place(state)]
        yield state
    else:
        places = [([*start], [])]
    missed, stride = 0, LONGEST_STRIDE
    while missed < MOST_MISSED:
        here, basis = places[generator.randrange(len(places))]
        aim = _ahead(here, basis, spans, stride, generator)
        try:
            q = system.closed(aim)
            near = q is not None and _distance(map(float, q), aim, spans) <= OFF_BRANCH * _distance(here, aim, spans)
            state = _moving(system, q, rank, generator) if q is not None and near else None
        except WideBallError:
            raise
        except (ArithmeticError, ValueError):
            state = None
        if state is None:
            missed, stride = missed + 1, stride / 2 if stride > SHORTEST_STRIDE else LONGEST_STRIDE
            continue
        missed, stride = 0, min(2 * stride, LONGEST_STRIDE)
        places[:] = [*(place for place in places if place[1]), _place(state)][-MOST_ORIGINS:]
        yield state
    raise NoMotionError


def _place(state: MotionState) -> tuple[list[float], list[list[float]]]:
    """A configuration with its admissible directions, in double precision."""
    basis = [[float(row[k]) for row in state.directions] for k in range(len(state.directions[0]))]
    return [float(x) for x in state.q], basis


def _ahead(
    here: Sequence[float],
    basis: Sequence[Sequence[float]],
    spans: Sequence[float],
    stride: float,
    generator: random.Random,
) -> list[float]:
    """A step from a configuration along admissible directions; anywhere near where these are not known."""
    if not basis:
        step = [generator.uniform(-1, 1) * span for span in spans]
    else:
        weights = [generator.uniform(-1, 1) for _ in basis]
        step = [sum(w * vector[j] for w, vector in zip(weights, basis, strict=True)) for j in range(len(here))]
    longest = max((abs(x) / span for x, span in zip(step, spans, strict=True) if span), default=0.0) or 1.0
    return [x + stride * y / longest for x, y in zip(here, step, strict=True)]


def _distance(one: Iterable[float], other: Iterable[float], spans: Iterable[float]) -> float:
    return max(abs(a - b) / (span or 1.0) for a, b, span in zip(one, other, spans, strict=True))


def _moving(system: BallSystem, q: Sequence[Ball], rank: int, generator: random.Random) -> MotionState | None:
    """A random admissible motion through a configuration; None where B has another rank there."""
    n = system.n
    columns = [*range(n)]
    generator.shuffle(columns)
    zero = arb(0)
    dense = _dense(system.rows([TimeSeries((x,)) for x in q]), n)
    echelon, basis = kernel(dense, n, columns)
    if echelon.rank != rank or not basis:
        return None
    rates = _combined(basis, _drawn(len(basis), generator), n)
    moved = [TimeSeries((x, v)) for x, v in zip(q, rates, strict=True)]
    along = system.rows(moved)
    # B q'' = -B' q'
    right = [-sum((entry.c[1] * rates[j] for j, entry in row.items()), zero) for row in along]
    full, _ = kernel([[*row, value] for row, value in zip(dense, right, strict=True)], n + 1, columns)
    swing = _combined(basis, _drawn(len(basis), generator), n)
    for row, pivot in zip(full.rows, full.pivots, strict=True):
        swing[pivot] += row[n]
    series = tuple(TimeSeries((x, v, a / 2)) for x, v, a in zip(q, rates, swing, strict=True))
    directions = [[vector[j] for vector in basis] for j in range(n)]
    return MotionState(series, directions)


def _drawn(count: int, generator: random.Random) -> list[Ball]:
    return [ball(Fraction(generator.randrange(-(10**6), 10**6), 10**6)) for _ in range(count)]


def _combined(basis: Matrix, weights: Sequence[Ball], n: int) -> list[Ball]:
    total = [arb(0)] * n
    for weight, vector in zip(weights, basis, strict=True):
        for j, entry in enumerate(vector):
            total[j] += weight * entry
    return total


def _dense(rows: Sequence[Mapping[int, TimeSeries]], n: int) -> Matrix:
    return [[row[j].c[0] if j in row else arb(0) for j in range(n)] for row in rows]


def _step(matrix: arb_mat, pairs: Sequence[tuple[int, int]], values: Sequence[Ball]) -> list[Ball]:
    """Newton's step of the coordinates of `pairs` by their rows; ZeroDivisionError for a singular matrix."""
    made = matrix.solve(arb_mat([[-values[i].mid()] for i, _ in pairs]))
    return [made[k, 0].mid() for k in range(len(pairs))]


def _pivots(rows: Sequence[Sequence[float]]) -> list[tuple[int, int]]:
    """Rows and columns by complete pivoting, up to where what is left is rounding or next to it."""
    left = {i: list(row) for i, row in enumerate(rows)}
    largest = max((abs(x) for row in rows for x in row), default=0.0)
    pairs: list[tuple[int, int]] = []
    while left:
        size, i, j = max((abs(x), i, j) for i, row in left.items() for j, x in enumerate(row))
        if size <= 1e-9 * largest:
            break
        lead = left.pop(i)
        for row in left.values():
            factor = row[j] / lead[j]
            for k, x in enumerate(lead):
                row[k] -= factor * x
            row[j] = 0.0
        pairs.append((i, j))
    return pairs
