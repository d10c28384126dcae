"""A motion to identify by, as data, and the way from a model file to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.estimates.identify import base_of, check_bodies
from symgen.identification.excitation.design import Designed, designed, drawn_motions
from symgen.identification.excitation.leading import Leading, leading
from symgen.identification.excitation.limits import MotionLimits, motion_limits
from symgen.identification.excitation.motions import LedMotions, State
from symgen.identification.excitation.series import RestingSeries
from symgen.identification.excitation.trials import TrialMotions
from symgen.identification.machine_functions import MachineFunctions
from symgen.identification.not_identified import NotIdentifiedError
from symgen.identification.text import combination
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.records import dataclass

Progress = Callable[[str], None]
# Samples of the period that is written, at which limits hold.
SAMPLES_WRITTEN = 1000
# Of a motion that is beyond a limit between the samples of its trial, by how much the next smaller one is smaller.
LESS_BY = 0.99
# How often it is made smaller before the next motion is taken.
MOST_LESS = 40


@dataclass(frozen=True, slots=True)
class ExcitationRequest:
    """The period in s, the least distance from singularities (None: half of what the configuration has), the seed."""

    period: float
    distance: float | None
    seed: int


@dataclass(frozen=True, slots=True)
class Excitation:
    """A motion at times t (N) in s of one period: q, qd and qdd (N, n), inputs u (N, m), distances (N, 2).

    `series` has the constants (d) and factors (d, 2 H) of the leading coordinates.  `condition` is that of the columns
    of `shown` parameters at unit length, `drawn` the same of the best motion within limits that was drawn, and of one
    in the middle of these.  `unseen` are parameters that no motion showed.  `shares` (l) are the largest of each limit.
    """

    model: Model
    request: ExcitationRequest
    leading: Leading
    limits: MotionLimits
    t: Array
    q: Array
    qd: Array
    qdd: Array
    u: Array
    distances: Array
    series: tuple[Array, Array]
    condition: float
    drawn: tuple[float, float]
    shown: tuple[str, ...]
    unseen: tuple[str, ...]
    shares: Array


def excitation(path: Path, request: ExcitationRequest, progress: Progress) -> Excitation:
    """A motion that shows the parameters of the model at `path` as well as its limits allow.

    Raises ModelError for mistakes in the file, and NotIdentifiedError where there is nothing to identify, nothing that
    leads the motion, no motion within limits, or no function that verification accepts.
    """
    progress("reading the model")
    model = load_model(path)
    check_bodies(model)
    lead = leading(model)
    progress("base parameters")
    base = base_of(model)
    progress("making functions")
    measured = lead.names if lead.given_by == "measured" else ()
    further = ("singularity", *(("task_position",) if lead.given_by == "task" else ()))
    functions = MachineFunctions(path, base, measured, progress, lead.given_by, further)
    led = LedMotions(functions, lead)
    distances = functions.quantity("singularity", led.start[None])[0]
    limits = motion_limits(model, functions.parameters, led.start, distances, request.distance)
    series = RestingSeries(request.period, led.middle, led.widths((limits.places[1] - limits.places[0]) / 2))
    drawn = drawn_motions(series, request.seed)
    progress("looking for motions within limits")
    trials = TrialMotions(functions, led, series, limits, drawn)
    best, plain = designed(trials, drawn, progress)
    progress("checking the motion")
    t = np.arange(SAMPLES_WRITTEN + 1) * request.period / SAMPLES_WRITTEN
    z, state, shares = _checked(trials, best, t)
    names = [*map(combination, base.base), *trials.linear.linear]
    conditions = [float(np.exp(logarithm)) for logarithm, _ in plain]
    return Excitation(
        model, request, lead, limits, t, *state, functions.inputs(state), functions.quantity("singularity", state[0]),
        series.coefficients(z), trials.condition(state), (min(conditions), float(np.median(conditions))),
        tuple(names[k] for k in trials.kept), tuple(n for k, n in enumerate(names) if k not in trials.kept), shares,
    )  # fmt: skip


def _checked(trials: TrialMotions, best: Sequence[Designed], t: Array) -> tuple[Array, State, Array]:
    """The first motion that keeps limits and goes on without a jump at all times t, made smaller where it has to be."""
    for z in (smaller for _, one in best for smaller in _smaller(trials, one)):
        state = trials.states(z[None], t)
        shares = trials.shares(state)
        if np.isfinite(shares).all() and (shares <= 1).all() and goes_on(state, float(t[1])):
            return z, state, np.max(shares, axis=0)
    raise NotIdentifiedError("no motion keeps its limits between samples: give a longer --period")


def _smaller(trials: TrialMotions, z: Array) -> Iterator[Array]:
    given = z.reshape(-1, 1 + trials.series.shapes)
    for k in range(MOST_LESS):
        yield np.hstack([given[:, :1], given[:, 1:] * LESS_BY**k]).ravel()


def goes_on(state: State, step: float) -> bool:
    """Whether configurations at steps of the time (s) follow each other by the rates, in one assembly mode."""
    q, qd, _ = state
    moved = np.diff(q, axis=0) - step * (qd[1:] + qd[:-1]) / 2
    return bool(np.max(np.abs(moved)) <= step * np.max(np.abs(qd)))
