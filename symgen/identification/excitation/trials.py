"""Trial motions: how well each shows the parameters, and how much of each limit it takes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from symgen.identification.arrays import Array
from symgen.identification.estimates.linear_terms import EstimatedNames, estimated_names
from symgen.identification.estimates.observations import equations
from symgen.identification.excitation.limits import MotionLimits
from symgen.identification.excitation.motions import LedMotions, State
from symgen.identification.excitation.series import HARMONICS, RestingSeries
from symgen.identification.independent import independent_columns
from symgen.identification.machine_functions import MachineFunctions, parts_of
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.model import Model
from symgen.records import dataclass

Flags = npt.NDArray[np.bool_]
# Samples of a trial for each period of the highest harmonic: loops and products have higher ones.
SAMPLES_A_WAVE = 20
# Of the largest singular value, what the smallest is taken for at least: rounding, where a column shows nothing.
LEAST_VALUE = 1e-16
# How sharp the smooth maximum of shares of limits is: with 100 samples it is above the largest by 0.023 at most.
SHARPNESS = 200.0


@dataclass(frozen=True, slots=True)
class Trials:
    """Of B motions the logarithm of the condition number (B), and smooth maxima of shares of limits (B, l).

    NaN stands where the machine does not reach a place of the motion.
    """

    logarithm: Array
    shares: Array


class TrialMotions:
    """What motions of a series come to for one machine; `kept` are the numbers of columns that motions tell apart."""

    def __init__(
        self,
        functions: MachineFunctions,
        led: LedMotions,
        series: RestingSeries,
        limits: MotionLimits,
        drawn: Array,
    ) -> None:
        """`drawn` motions (B, variables) say which further parameters are linear, and which columns there are."""
        self._functions = functions
        self._led, self.series, self.limits = led, series, limits
        self.times = np.arange(SAMPLES_A_WAVE * HARMONICS) * series.period / (SAMPLES_A_WAVE * HARMONICS)
        state = self._regular(drawn)
        self.linear: EstimatedNames = estimated_names(functions, state)
        columns = self._columns(state)
        self.kept = independent_columns(columns.reshape(-1, columns.shape[2]))
        if not self.kept:
            raise NotIdentifiedError("no motion of the model shows any parameter: its drives feel none")

    @property
    def model(self) -> Model:
        """That of the functions."""
        return self._functions.model

    def of(self, z: Array) -> Trials:
        """The trials of motions z (B, variables)."""
        states = self.states(z, self.times)
        shares = self.shares(states).reshape(len(z), len(self.times), -1)
        columns = self._columns(states)[..., self.kept].reshape(len(z), -1, len(self.kept))
        flat = np.concatenate([columns.reshape(len(z), -1), shares.reshape(len(z), -1)], axis=1)
        reached: Flags = np.all(np.isfinite(flat), axis=1)
        logarithm = np.full(len(z), np.nan)
        logarithm[reached] = [np.log(_condition(one)) for one in columns[reached]]
        largest = np.max(shares, axis=1)
        smooth = largest + np.log(np.sum(np.exp(SHARPNESS * (shares - largest[:, None])), axis=1)) / SHARPNESS
        return Trials(logarithm, np.where(reached[:, None], smooth, np.nan))

    def states(self, z: Array, t: Array) -> State:
        """The states (B N, n) of motions at times t (N)."""
        flat = [one.reshape(-1, one.shape[-1]) for one in self.series.motions(z, t)]
        return self._led.states(flat[0], flat[1], flat[2])

    def shares(self, states: State) -> Array:
        """Of each limit what states (N, n) take (N, l)."""
        distances = self._functions.quantity("singularity", states[0])
        return self.limits.shares(states, self._functions.inputs(states), distances)

    def condition(self, states: State) -> float:
        """The condition number of the columns at states (N, n)."""
        return _condition(self._columns(states)[..., self.kept].reshape(-1, len(self.kept)))

    def _columns(self, states: State) -> Array:
        """Columns (N, m, c) of all parameters, a drive with limits in units of these."""
        ends = self.limits.inputs
        sizes = np.where(np.isfinite(ends).all(axis=0), ends[1] - ends[0], 1.0)
        parts = [tuple(one[part] for one in states) for part in parts_of(len(states[0]))]
        made = [equations(self._functions, self.linear, (q, qd, qdd))[1] for q, qd, qdd in parts]
        return np.concatenate(made) / sizes[:, None]

    def _regular(self, drawn: Array) -> State:
        """The states of drawn motions at which there is a result."""
        states = self.states(drawn, self.times)
        reached = np.isfinite(np.concatenate([*states, self._functions.inputs(states)], axis=1)).all(axis=1)
        if not reached.any():
            raise NotIdentifiedError("no motion about the configuration of the model has a result")
        return states[0][reached], states[1][reached], states[2][reached]


def _condition(columns: Array) -> float:
    """The largest by the smallest singular value of columns (N, c), each at unit length."""
    lengths = np.linalg.norm(columns, axis=0)
    values = np.linalg.svd(columns / np.where(lengths > 0, lengths, 1.0), compute_uv=False)
    return float(values[0] / max(float(values[-1]), LEAST_VALUE * float(values[0])))
