"""The geometric rows at many states at once, and two ways onto V: in float64, where to look, never what is right.

Newton's method leads to what is close by.  Levenberg and Marquardt's leads to V from anywhere, with a damping for each
state, so that starts all over the ranges end in one assembly mode or another.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.lane_replay import LaneReplay
from symgen.verify.lanes.small_matrices import inverses, products, pseudoinverses, times
from symgen.verify.reference.configurations.manifold import ROUNDED_DIRECTION
from symgen.verify.reference.configurations.parts import Part
from symgen.verify.reference.system import ReferenceSystem

# Newton steps onto V.
LANE_STEPS = 12
# Of rows of length 1: what is left of a loop that needs no further step.
CLOSED_IN_LANES = 1e-11
# Of the longest row: rows depend on each other.
DEPENDENT = 1e-8
# Entries of (J J')^-1, for rows of length 1, that leave a step of Newton's method half of its digits.
FAR_FROM_DEPENDENT = 1e6
# Steps of Levenberg and Marquardt's method.
DAMPED_STEPS = 40
# How small its damping becomes.
LEAST_DAMPING = 1e-14


class LoopsInLanes:
    """The loops of a system; `literals` are the values of its literals."""

    def __init__(self, system: ReferenceSystem, literals: Sequence[float]) -> None:
        self._system, self._literals = system, list(literals)

    @cached_property
    def _geometry(self) -> LaneReplay:
        return LaneReplay(self._system.geometry_replay)

    @cached_property
    def _matrices(self) -> LaneReplay:
        return LaneReplay(self._system.matrices_replay)

    def matrices(self, q: Lanes, p: Lanes) -> Lanes:
        """The entries of B and M, row by row of each."""
        return self._run(self._matrices, q, p)

    def _run(self, replay: LaneReplay, q: Lanes, p: Lanes) -> Lanes:
        # none of those that are run here reads rates
        return replay.run([*q.T, *([None] * self._system.n), *p.T, *self._literals], len(q))

    def newton(self, q: Lanes, p: Lanes, held: tuple[Lanes, Lanes] | None = None) -> tuple[Lanes, Lanes]:
        """The places where Newton's method ends, and whether the loops of each coordinate are closed there.

        `held` are the place of a coordinate and its value, for each state: another row.
        """
        q = q.copy()
        shut = np.ones(q.shape, dtype=bool)
        if held is not None:
            q[np.arange(len(q)), held[0]] = held[1]
        moving = np.arange(len(q))
        for _ in range(LANE_STEPS if self._system.r_geometric else 0):
            here, still = q[moving], np.zeros(len(moving), dtype=bool)
            for loop, rows, gaps, finite in self._evaluated(here, p[moving]):
                these = np.array(loop.coordinates)
                rows[~finite], gaps[~finite] = 0.0, 0.0
                if held is not None:
                    rows = np.concatenate((rows, (held[0][moving, None] == these)[:, None] * 1.0), axis=1)
                    gaps = np.concatenate((gaps, np.zeros((len(moving), 1))), axis=1)
                rows, gaps = _in_own_units(rows, gaps)
                near = np.abs(gaps).max(axis=1) <= CLOSED_IN_LANES
                shut[np.ix_(moving, these)] = (finite & near)[:, None]
                here[np.ix_(~near, these)] -= _newton_step(rows[~near], gaps[~near])
                still |= ~near
            q[moving] = here
            moving = moving[still]
            if not len(moving):
                break
        return q, shut

    def damped(self, q: Lanes, p: Lanes, most_steps: int = DAMPED_STEPS) -> Lanes:
        """The places where Levenberg and Marquardt's method ends, each loop with a damping of its own.

        Rows count in units of their gradients at the start.
        """
        place = q.copy()
        units, known = [], []
        for loop, rows, gaps, finite in self._evaluated(place, p):
            lengths = lengths_of(np.where(finite[:, None, None], rows, 0.0))
            units.append(lengths)
            known.append([loop, rows / lengths, gaps / lengths[:, :, 0], np.full(len(q), 1e-3)])
        for _ in range(most_steps):
            trial = place.copy()
            for loop, rows, gaps, damping in known:
                trial[:, list(loop.coordinates)] -= _damped_step(rows, gaps, damping)
            done = True
            for one, length, (loop, rows, gaps, finite) in zip(known, units, self._evaluated(trial, p), strict=True):
                these, damping = list(loop.coordinates), one[3]
                rows, gaps = rows / length, gaps / length[:, :, 0]
                before, after = (np.linalg.norm(x, axis=1) for x in (one[2], gaps))
                better = finite & ~(after >= before)
                share = np.where(better, after / np.where(before > 0, before, 1.0), 1.0)
                one[3] = np.where(better, np.maximum(damping * np.minimum(0.1, share), LEAST_DAMPING), damping * 10)
                one[1] = np.where(better[:, None, None], rows, one[1])
                one[2] = np.where(better[:, None], gaps, one[2])
                place[:, these] = np.where(better[:, None], trial[:, these], place[:, these])
                done = done and bool((np.minimum(before, after) <= CLOSED_IN_LANES).all())
            if done:
                break
        return place

    def shut(self, q: Lanes, p: Lanes, most: float) -> Lanes:
        """Whether what is left of every row, in units of its gradient, is no more than that."""
        return self.left_open(q, p) <= most

    def left_open(self, q: Lanes, p: Lanes) -> Lanes:
        """The most that is left of any row, in units of its gradient; infinite where a row is not finite."""
        most = np.zeros(len(q))
        for _, rows, gaps, finite in self._evaluated(q, p):
            gap = np.abs(_in_own_units(rows, gaps)[1]).max(axis=1)
            most = np.maximum(most, np.where(finite & (gap >= 0), gap, np.inf))
        return most

    def _evaluated(self, q: Lanes, p: Lanes) -> Iterator[tuple[Part, Lanes, Lanes, Lanes]]:
        """Each loop with its rows, what they leave open, and where all of that is finite."""
        r, n = self._system.r_geometric, self._system.n
        made = self._run(self._geometry, q, p)
        for loop in self._system.loops:
            rows = block(made, [[r + i * n + j for j in loop.coordinates] for i in loop.rows])
            gaps = block(made, [[i] for i in loop.rows])[:, :, 0]
            yield loop, rows, gaps, np.isfinite(rows).all(axis=(1, 2)) & np.isfinite(gaps).all(axis=1)


def _newton_step(rows: Lanes, gaps: Lanes) -> Lanes:
    """J^+ g of each state, for rows of length 1: by J J' where these are far from dependent, which is far shorter."""
    across = np.swapaxes(rows, 1, 2)
    gram = products(rows, across)
    # what rounding leaves of rows that depend on each other is no pivot
    inverse = inverses(gram + 1e-14 * np.eye(gram.shape[1]))
    step = times(across, times(inverse, gaps))
    dependent = ~(np.abs(inverse).max(axis=(1, 2), initial=0.0) < FAR_FROM_DEPENDENT)
    step[dependent] = times(pseudoinverses(rows[dependent], DEPENDENT), gaps[dependent])
    return step


def _damped_step(rows: Lanes, gaps: Lanes, damping: Lanes) -> Lanes:
    """J' (J J' + shift)^-1 g of each state."""
    usable = np.isfinite(rows).all(axis=(1, 2)) & np.isfinite(gaps).all(axis=1) & (damping < 1e10)
    rows, gaps = np.where(usable[:, None, None], rows, 0.0), np.where(usable[:, None], gaps, 0.0)
    across = np.swapaxes(rows, 1, 2)
    gram = products(rows, across)
    count = gram.shape[1]
    shift = np.maximum(damping * np.trace(gram, axis1=1, axis2=2) / count, 1e-30)
    # what rounding leaves of rows that depend on each other is no pivot
    shift = np.where(usable, np.maximum(shift, 1e-14), 1.0)
    return times(across, times(inverses(gram + shift[:, None, None] * np.eye(count)), gaps))


def _in_own_units(rows: Lanes, gaps: Lanes) -> tuple[Lanes, Lanes]:
    lengths = lengths_of(rows)
    return rows / lengths, gaps / lengths[:, :, 0]


def block(made: Lanes, places: Sequence[Sequence[int]], columns: int = 1) -> Lanes:
    """A matrix at each state, of numbers by their rows; without rows it still has columns."""
    if not places or not places[0]:
        return np.zeros((made.shape[1], len(places), columns if not places else 0))
    return np.ascontiguousarray(np.moveaxis(made[np.array(places)], 2, 0))


def lengths_of(rows: Lanes) -> Lanes:
    """Of every row; of one that vanishes up to rounding the largest of all, so that it stays as small as it is."""
    lengths = np.linalg.norm(rows, axis=2, keepdims=True)
    largest = lengths.max(axis=1, keepdims=True, initial=0.0)
    return np.where(lengths > 2.0**ROUNDED_DIRECTION * largest, lengths, np.where(largest > 0, largest, 1.0))
