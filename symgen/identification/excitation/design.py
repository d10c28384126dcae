"""The motion that shows parameters best within limits: several drawn ones, the best of them improved.

SciPy's SLSQP takes the logarithm of the condition number of the columns, each at unit length, and smooth maxima of what
a motion takes of its limits.  Slopes are differences, all of them from states that go through the generated functions
at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy import optimize

from symgen.identification.arrays import Array
from symgen.identification.excitation.series import RestingSeries
from symgen.identification.excitation.trials import TrialMotions
from symgen.identification.not_identified import NotIdentifiedError

Progress = Callable[[str], None]
Designed: TypeAlias = tuple[float, Array]
"""The logarithm of the condition number of a motion, and the motion (variables)."""
# Motions that are drawn to begin with.
DRAWN_MOTIONS = 12
# Of the drawn motions, those that are improved.
IMPROVED = 3
# Steps of an improvement at most.
MOST_IMPROVING_STEPS = 60
# Of a drawn motion, by how much the next smaller one is smaller, until limits hold.
SHRUNK_BY = 0.85
# How often it is made smaller at most.
MOST_SHRUNK = 30
# The step of a variable, in widths of leading coordinates, that slopes are differences of.
SLOPE_STEP = 1e-6
# What an improvement takes for the condition number of a motion that the machine does not reach: e^20.
OUT_OF_REACH = 20.0
# Of limits, what the optimiser is asked to keep: it comes to its ends from outside.
ASKED_SHARE = 0.99
# Of the logarithm of the condition number, the change below which an improvement ends.
IMPROVED_ENOUGH = 1e-4


def drawn_motions(series: RestingSeries, seed: int) -> Array:
    """Motions (B, variables) about the middle."""
    generator = np.random.default_rng(seed)
    z = generator.standard_normal((DRAWN_MOTIONS, series.variables // (1 + series.shapes), 1 + series.shapes))
    z[:, :, 0] = 0.0
    return np.asarray(z.reshape(DRAWN_MOTIONS, -1) / np.sqrt(series.shapes), dtype=np.float64)


def designed(trials: TrialMotions, drawn: Array, progress: Progress) -> tuple[list[Designed], list[Designed]]:
    """Motions within limits, those that show most first: all, and the drawn ones alone.

    Raises NotIdentifiedError where none of the drawn ones keeps limits, however small it is made.
    """
    begun = []
    for k, z in enumerate(drawn):
        progress(f"looking for motions within limits, {k + 1} of {len(drawn)}")
        if (within := _within_limits(trials, z)) is not None:
            begun.append(within)
    if not begun:
        raise NotIdentifiedError(_why_none(trials, drawn))
    begun.sort(key=lambda one: one[0])
    made = list(begun)
    chosen = begun[:IMPROVED]
    for k, one in enumerate(chosen, 1):
        made.append(_ImprovedMotion(trials, one, f"improving, motion {k} of {len(chosen)}", progress).best())
    return sorted(made, key=lambda one: one[0]), begun


def _within_limits(trials: TrialMotions, z: Array) -> Designed | None:
    """The largest of smaller and smaller motions that is within limits, with the logarithm of its condition number."""
    sizes = SHRUNK_BY ** np.arange(MOST_SHRUNK)
    made = trials.of(z * sizes[:, None])
    good = np.flatnonzero((made.shares <= 1).all(axis=1) & np.isfinite(made.logarithm))
    return (float(made.logarithm[good[0]]), z * sizes[good[0]]) if len(good) else None


def _why_none(trials: TrialMotions, drawn: Array) -> str:
    """Which limit the machine is beyond where it hardly moves."""
    states = trials.states(drawn[:1] * SHRUNK_BY**MOST_SHRUNK, trials.times)
    shares = np.max(trials.shares(states), axis=0)
    if not np.isfinite(shares).all():
        return "no feasible motion: next to the configuration of the model inputs have no value; give another one"
    if np.max(shares) <= 1:
        return "no feasible motion was drawn: give wider `ranges`, a longer --period, or another --seed"
    name = trials.limits.names[int(np.argmax(shares))]
    if name.startswith("the distance"):
        remedy = "give another `configuration` that is further from a singularity, or a smaller --distance"
    elif name in {c.name for c in trials.model.coordinates}:
        remedy = "give it a wider range, or a `configuration` within it"
    elif name in {one.name for one in trials.model.inputs}:
        remedy = "give it wider limits, a longer --period, or a `configuration` that needs less to be held"
    else:
        remedy = "give it a wider range, or a longer --period"
    return f"no feasible motion: even next to the configuration of the model {name} is beyond its limit; {remedy}"


class _ImprovedMotion:
    """One run of the optimiser, which asks for values and for slopes at the same places."""

    def __init__(self, trials: TrialMotions, begun: Designed, what: str, progress: Progress) -> None:
        self._trials, self._best, self._what, self._progress = trials, begun, what, progress
        self._values: tuple[bytes, float, Array] = (b"", 0.0, np.empty(0))
        self._slopes: tuple[bytes, Array, Array] = (b"", np.empty(0), np.empty(0))

    def best(self) -> Designed:
        """The best motion within limits on the way."""
        optimize.minimize(
            lambda z: self._at(z)[0],
            self._best[1],
            jac=lambda z: self._sloping(z)[0],
            method="SLSQP",
            constraints=[
                {"type": "ineq", "fun": lambda z: ASKED_SHARE - self._at(z)[1], "jac": lambda z: -self._sloping(z)[1]}
            ],
            options={"maxiter": MOST_IMPROVING_STEPS, "ftol": IMPROVED_ENOUGH},
        )
        return self._best

    def _at(self, z: Array) -> tuple[float, Array]:
        key = z.tobytes()
        if self._values[0] != key:
            made = self._trials.of(z[None])
            logarithm, shares = float(made.logarithm[0]), made.shares[0]
            if not np.isfinite(logarithm):
                logarithm, shares = OUT_OF_REACH, np.full(shares.shape, 2.0)
            elif logarithm < self._best[0] and (shares <= 1).all():
                self._best = logarithm, z.copy()
                self._progress(f"{self._what}, condition number {np.exp(logarithm):.3g}")
            self._values = key, logarithm, shares
        return self._values[1], self._values[2]

    def _sloping(self, z: Array) -> tuple[Array, Array]:
        """Slopes of the logarithm (variables) and of shares (l, variables); 0 where a step leaves what is reached."""
        key = z.tobytes()
        if self._slopes[0] != key:
            logarithm, shares = self._at(z)
            made = self._trials.of(z + SLOPE_STEP * np.eye(len(z)))
            moved = np.where(np.isfinite(made.logarithm), made.logarithm - logarithm, 0.0)
            changed = np.where(np.isfinite(made.shares), made.shares - shares, 0.0)
            self._slopes = key, moved / SLOPE_STEP, changed.T / SLOPE_STEP
        return self._slopes[1], self._slopes[2]
