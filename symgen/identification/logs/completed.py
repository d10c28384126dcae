"""From what a log measures to the motion of the whole machine: filtered, differentiated, on the constraints."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.logs.filtering import FilterSettings
from symgen.identification.logs.read_log import MeasuredLog
from symgen.identification.machine_functions import MachineFunctions
from symgen.identification.not_identified import NotIdentifiedError
from symgen.records import dataclass

Progress = Callable[[str], None]
# What a measured coordinate moves by at most (rad, m) between configurations that are found one after the other.
FOLLOWED_STEP = 0.05
# Samples between such configurations at most.
MOST_BETWEEN = 64
# Steps from the configuration of the file to the first sample of the log.
STEPS_TO_START = 64


@dataclass(frozen=True, slots=True)
class CompletedMotion:
    """q, qd and qdd (N, n) at the samples of a log; `open_by` is what measured coordinates differ from q by (rms)."""

    q: Array
    qd: Array
    qdd: Array
    open_by: float

    @property
    def state(self) -> tuple[Array, Array, Array]:
        """As functions take it."""
        return self.q, self.qd, self.qdd


def completed_motion(
    functions: MachineFunctions, log: MeasuredLog, settings: FilterSettings, progress: Progress
) -> CompletedMotion:
    """The motion of all coordinates.  Raises NotIdentifiedError, with the line, where loops do not close."""
    model = functions.model
    chosen = [model.coordinates[k] for k in model.measured_places]
    raw = [_continuous(log.columns[c.name], c.is_angle) for c in chosen]
    places = settings.smoothed(np.stack(raw, axis=-1))
    rates = settings.differentiated(places)
    for k, c in enumerate(chosen):
        if c.rate in log.columns:
            rates[:, k] = settings.smoothed(log.columns[c.rate])
    accelerations = settings.differentiated(rates)
    for k, c in enumerate(chosen):
        if c.acceleration in log.columns:
            accelerations[:, k] = settings.smoothed(log.columns[c.acceleration])
    q = _ClosedLoops(functions, log, progress).configurations(places) if functions.closes_loops else places
    qd, qdd = functions.motion(q, rates, accelerations)
    if not (np.isfinite(qd).all() and np.isfinite(qdd).all()):
        sample = int(np.flatnonzero(~np.isfinite(qd + qdd).all(axis=1))[0])
        raise NotIdentifiedError("what is measured does not determine the rates of the rest here", _line(log, sample))
    open_by = float(np.sqrt(np.mean((q[:, model.measured_places] - places) ** 2)))
    return CompletedMotion(q, qd, qdd, open_by)


def _continuous(values: Array, is_angle: bool) -> Array:
    """Encoders of angles may begin again after a turn."""
    return np.unwrap(values) if is_angle else values


def _line(log: MeasuredLog, sample: int) -> str:
    return f"{log.file}:{sample + 2}"


class _ClosedLoops:
    """Configurations one after the other, some far enough apart, then all between these at once."""

    def __init__(self, functions: MachineFunctions, log: MeasuredLog, progress: Progress) -> None:
        self._functions, self._log, self._progress = functions, log, progress

    def configurations(self, places: Array) -> Array:
        """q (N, n) of measured places (N, k)."""
        step = float(np.max(np.abs(np.diff(places, axis=0))))
        stride = int(min(MOST_BETWEEN, max(1, FOLLOWED_STEP // max(step, 1e-12))))
        q, near = np.empty((len(places), self._functions.model.n)), self._start(places[0])
        for k in range(0, len(places), stride):
            near = self._followed(places, max(0, k - stride), k, near)
            q[k : k + stride] = near
            self._progress(f"closing loops, {100 * k // len(places)} %")
        q = self._functions.configurations(places, q)
        for open_sample in map(int, np.flatnonzero(~np.isfinite(q).all(axis=1))):
            before = q[max(0, open_sample - 1)]
            q[open_sample] = self._followed(places, open_sample, open_sample, before)
        return q

    def _followed(self, places: Array, before: int, sample: int, near: Array) -> Array:
        """The configuration at a sample; where it is too far, by way of the samples before it."""
        q, why = self._functions.one_configuration(places[sample], near)
        for k in range(before, sample + 1) if why else ():
            near, why = self._functions.one_configuration(places[k], near)
            if why:
                raise NotIdentifiedError(
                    f"no configuration of the model has these measured coordinates ({why}): check the lengths of the "
                    "model, units and offsets of the encoders",
                    _line(self._log, k),
                )
            q = near
        return q

    def _start(self, first: Array) -> Array:
        """The configuration at the first sample, from that of the file."""
        model = self._functions.model
        assert model.assembly is not None
        measured = list(model.measured_places)
        angles = np.array([model.coordinates[k].is_angle for k in measured])
        for place in model.assembly.places:
            q = np.array(place.q)
            # whole turns away it is the same configuration
            q[measured] += np.where(angles, 2 * np.pi * np.round((first - q[measured]) / (2 * np.pi)), 0.0)
            begin, why = q[measured], ""
            for share in np.linspace(0, 1, STEPS_TO_START + 1)[1:]:
                q, why = self._functions.one_configuration(begin + share * (first - begin), q)
                if why:
                    break
            if not why:
                return q
        raise NotIdentifiedError(
            "the first sample is not reached from the configuration of the model: write one that is near to it under "
            "`configuration`, and check units and offsets of the encoders",
            _line(self._log, 0),
        )
