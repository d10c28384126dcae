"""What a log says of a machine, as data: estimates with their errors, and how well inputs are predicted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.combinations import Combinations
from symgen.identification.estimates.file_values import FileValues
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.observations import Observations, rms
from symgen.identification.estimates.whole_bodies import WholeBodies
from symgen.identification.logs.filtering import FilterSettings
from symgen.identification.logs.read_log import MeasuredLog
from symgen.model.checks.gains import driven_input
from symgen.model.configurations.mechanics import default_values
from symgen.model.model import Model
from symgen.records import dataclass

# Of the inputs, what a fit leaves of a log of this machine at most.
MOST_LEFT_OVER = 0.5
# Standard errors up to which a value may be 0.
NOT_ZERO = 2.0
# The relative standard error from which on a value is a rough one.
ROUGH = 0.3


@dataclass(frozen=True, slots=True)
class EstimatedParameter:
    """One base parameter, or a further one in which u is linear: value, standard error, value of the file, verdict.

    `value` and `error` are NaN where the log leaves it open.
    """

    name: str
    value: float
    error: float
    before: float

    @property
    def ratio(self) -> float:
        """The value in standard errors (t-ratio)."""
        return abs(self.value) / self.error if self.error else float("inf")

    @property
    def verdict(self) -> str:
        """A plain word on what the log says of it; empty where it says enough."""
        if not np.isfinite(self.value):
            return "open: the motion does not show it"
        if self.ratio < NOT_ZERO:
            return "may be 0"
        return "rough" if self.ratio < 1 / ROUGH else ""


@dataclass(frozen=True, slots=True)
class DriveFit:
    """One input: rms of it, of what is left where it was fitted and where not, of its noise and of inner forces."""

    name: str
    unit: str
    inputs: float
    fitted: float
    predicted: float
    noise: float
    inner: float


@dataclass(frozen=True, slots=True)
class Identification:
    """What a log says of a machine; the first samples were `fitted_to`, the last ones were set `aside`.

    `values` go into the model file, beside whole bodies where it `has_whole_bodies`.
    """

    model: Model
    log: MeasuredLog
    settings: FilterSettings
    open_by: float
    combinations: Combinations
    names: EstimatedNames
    fitted_to: Observations
    aside: Observations
    estimate: LinearEstimate
    values: FileValues
    whole: WholeBodies | None
    has_whole_bodies: bool = False

    def with_whole_bodies(self) -> Identification:
        """The same where whole bodies go into the model file, if there are any."""
        if self.whole is None:
            return self
        errors, before = {one.name: one.error for one in self.parameters}, default_values(self.model.parameters)
        names, values = tuple(self.whole.linear), np.array([*self.whole.linear.values()])
        known, off = (np.array([given[name] for name in names]) for given in (before, errors))
        beside = FileValues(names, known, values, off, self.whole.misfit, (), False)
        return replace(self, values=beside, has_whole_bodies=True)

    @property
    def parameters(self) -> tuple[EstimatedParameter, ...]:
        """In the order of columns."""
        labels = [*self.combinations.labels, *self.names.with_columns]
        numbers = default_values(self.model.parameters)
        before = [*self.combinations.at(numbers), *(numbers[name] for name in self.names.with_columns)]
        rows = zip(labels, self.estimate.values, self.estimate.errors, before, strict=True)
        return tuple(EstimatedParameter(name, float(x), float(e), float(b)) for name, x, e, b in rows)

    @property
    def drives(self) -> tuple[DriveFit, ...]:
        """How well each input is predicted."""
        fitted, predicted = rms(self.residuals(self.fitted_to)), rms(self.residuals(self.aside))
        seen = self.fitted_to
        inputs = rms(seen.inputs + seen.known)
        inner = seen.inner if seen.drives is None else rms(seen.drives.inner(self.factors))
        rows = zip(inputs, fitted, predicted, seen.noise, inner, strict=True)
        return tuple(
            DriveFit(one.name, one.unit or "", *map(float, row))
            for one, row in zip(self.model.inputs, rows, strict=True)
        )

    @property
    def factors(self) -> Array:
        """What an input of the log has the effect of, by the gains of the file (m): other than 1 with another gain."""
        made = np.ones(len(self.model.inputs))
        for one in self.parameters[len(self.parameters) - len(self.names.gains) :]:
            made[driven_input(self.model, one.name)] = one.value / one.before
        return made

    def residuals(self, seen: Observations) -> Array:
        """Measured less predicted inputs (S, m)."""
        return np.asarray((seen.inputs - self.estimate.predicted(seen)) / self.factors, dtype=np.float64)

    def predicted(self, seen: Observations) -> Array:
        """Inputs (S, m) as they would be measured."""
        effects = self.estimate.predicted(seen) + seen.known
        made = (effects + (self.factors - 1) * (seen.inputs + seen.known)) / self.factors
        return np.asarray(made, dtype=np.float64)

    @property
    def left_over(self) -> float:
        """Of the inputs that were set aside, what is not predicted."""
        inputs = np.sum((self.aside.inputs + self.aside.known) ** 2)
        return float(np.sqrt(np.sum(self.residuals(self.aside) ** 2) / max(float(inputs), 1e-300)))

    @property
    def is_of_another_machine(self) -> bool:
        """Whether the log contradicts the model."""
        return self.left_over > MOST_LEFT_OVER
