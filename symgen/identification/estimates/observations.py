"""What a log says, as linear equations: inputs and the columns of what is estimated, filtered alike and decimated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.combinations import default_like
from symgen.identification.estimates.drives_with_gains import DrivesWithGains, drives_with_gains
from symgen.identification.estimates.linear_terms import EstimatedNames, State, step_of
from symgen.identification.logs.completed import CompletedMotion
from symgen.identification.logs.filtering import FilterSettings
from symgen.identification.logs.read_log import MeasuredLog
from symgen.identification.machine_functions import MachineFunctions, parts_of
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Observations:
    """inputs (S, m) = columns (S, m, c) times what is estimated, plus noise; `known` (S, m) is what was taken off.

    `noise` (m) is the standard deviation of what the filter leaves of white noise, `inner` (m) the rms of what drives
    do against each other, at times `t` (S) in s.  Inputs reach so many `directions` of motion.

    The last columns are those of the `drives` whose gains are estimated.
    """

    t: Array
    inputs: Array
    known: Array
    columns: Array
    noise: Array
    inner: Array
    directions: int
    drives: DrivesWithGains | None = None

    def part(self, chosen: slice) -> Observations:
        """Those at some of the samples."""
        samples = self.t[chosen], self.inputs[chosen], self.known[chosen], self.columns[chosen]
        drives = None if self.drives is None else self.drives.part(chosen)
        return Observations(*samples, self.noise, self.inner, self.directions, drives)

    def with_gain_known(self, name: str) -> Observations:
        """The same, where a gain is that of the file."""
        assert self.drives is not None
        place = self.drives.names.index(name)
        column = self.columns.shape[2] - len(self.drives.names) + place
        known = self.columns[..., column] * self.drives.before[place]
        return replace(
            self,
            inputs=self.inputs - known,
            known=self.known + known,
            columns=np.delete(self.columns, column, axis=-1),
            drives=self.drives.without(place),
        )


def observations(
    functions: MachineFunctions,
    names: EstimatedNames,
    log: MeasuredLog,
    motion: CompletedMotion,
    settings: FilterSettings,
) -> Observations:
    """The equations of a log: a column for each base parameter, then one for each further linear parameter."""
    model = functions.model
    measured = np.stack([log.columns[one.name] for one in model.inputs], axis=-1)
    given = functions.least(motion.q, measured)
    made = [equations(functions, names, _part(motion.state, part)) for part in parts_of(len(log.t))]
    known, columns = (np.concatenate([one[k] for one in made]) for k in (0, 1))
    kept = settings.places(len(log.t))
    inner = settings.kept(measured - given)
    seen = Observations(
        log.t[kept],
        settings.kept(given - known),
        settings.kept(known),
        settings.kept(columns),
        settings.noise_passed(given - known),
        rms(inner),
        functions.directions,
    )
    if not names.gains:
        return seen
    drives = drives_with_gains(functions, names.gains, motion.q, (measured, given), (columns, known), settings)
    of_gains = drives.columns_for(measured)
    return replace(
        seen,
        inputs=seen.inputs + of_gains @ drives.before,
        known=seen.known - of_gains @ drives.before,
        columns=np.concatenate([seen.columns, of_gains], axis=-1),
        drives=drives,
    )


def _part(state: State, part: slice) -> State:
    return state[0][part], state[1][part], state[2][part]


def equations(functions: MachineFunctions, names: EstimatedNames, state: State) -> tuple[Array, Array]:
    """What is known (N, m), and the columns (N, m, c)."""
    model, values = functions.model, functions.parameters
    of_base = functions.columns(state)
    inputs = functions.inputs(state)
    columns = [of_base]
    known = inputs - of_base @ functions.combinations.at(values)
    for name in names.linear:
        step = step_of(values[name])
        changed = default_like(model, values, {name: values[name] + step})
        slope = (functions.inputs(state, changed) - inputs) / step
        columns.append(slope[..., None])
        known = known - slope * values[name]
    return known, np.concatenate(columns, axis=-1)


def rms(values: Array) -> Array:
    """The root of the mean square along the samples (S, m)."""
    return np.asarray(np.sqrt(np.mean(values**2, axis=0)), dtype=np.float64)


