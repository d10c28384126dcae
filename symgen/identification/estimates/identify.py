"""The whole way from a model and a log to estimates: read, completed, filtered, fitted, tried on what is set aside."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from symgen.identification.energies.energy_terms import EnergyTerms, energy_terms
from symgen.identification.energies.shown_terms import ShownTerms
from symgen.identification.estimates.file_values import file_values
from symgen.identification.estimates.gains import estimated_with_gains, gains_left_open
from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.least_squares import LinearEstimate, estimated
from symgen.identification.estimates.linear_terms import EstimatedNames, estimated_names, some_states
from symgen.identification.estimates.observations import Observations, observations
from symgen.identification.estimates.whole_bodies import whole_bodies
from symgen.identification.logs.completed import completed_motion
from symgen.identification.logs.filtering import FilterSettings, filter_settings
from symgen.identification.logs.read_log import MeasuredLog, read_log
from symgen.identification.machine_functions import MachineFunctions
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.combinations.base_parameters import BaseParameters, NoBodiesError, base_parameters
from symgen.model.combinations.motion_states import NoMotionError
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.records import dataclass

Progress = Callable[[str], None]
# Of a log, the last part, which is not fitted but predicted.
SET_ASIDE = 0.25
# Why a gain stays.
NOT_DETERMINED = (
    "the log does not determine this gain, as little of what its drive moves is known or moved by others, too"
)


@dataclass(frozen=True, slots=True)
class IdentifiableMachine:
    """A model before any log: its base parameters, and its verified functions of what a log measures."""

    base: BaseParameters | EnergyTerms
    functions: MachineFunctions


def identified(path: Path, log_path: Path, cutoff: float | None, progress: Progress) -> Identification:
    """What a log says of the machine of a model file; the cut-off of the filter in Hz, or None for the usual one.

    Raises ModelError for mistakes in either file, and NotIdentifiedError where there is nothing to identify.
    """
    progress("reading the model")
    model = load_model(path)
    if not model.mechanism.has_mass:
        terms_of(model)  # which says at once where there are none
    progress("reading the log")
    log = read_log(log_path, model)
    settings = filter_settings(log, cutoff)
    return identified_by(identifiable(path, model, log.measured, progress), log, settings, progress)


def check_bodies(model: Model) -> None:
    """Raises NotIdentifiedError for a model without bodies."""
    if not model.mechanism.has_mass:
        raise NotIdentifiedError(
            "the model has no `bodies`: motions are designed for their masses, first moments and inertias; "
            "write the machine with `joints` or `frames` and `bodies`"
        )


def identifiable(path: Path, model: Model, measured: Sequence[str], progress: Progress) -> IdentifiableMachine:
    """What logs with these measured coordinates are compared with; `path` is the model's file.

    Raises NotIdentifiedError where no parameter counts or verification rejects a function.
    """
    progress("base parameters")
    base = base_of(model) if model.mechanism.has_mass else terms_of(model)
    progress("making functions")
    return IdentifiableMachine(base, MachineFunctions(path, base, measured, progress))


@dataclass(frozen=True, slots=True)
class FittedLog:
    """What a fit to a log says alone, before parameters of the file or bodies are made of it.

    `functions` tell apart what this motion shows, `open_by` is how far measured coordinates are off closed loops.
    """

    functions: MachineFunctions
    open_by: float
    names: EstimatedNames
    fitted_to: Observations
    aside: Observations
    estimate: LinearEstimate


def fitted_by(
    machine: IdentifiableMachine, log: MeasuredLog, settings: FilterSettings, progress: Progress
) -> FittedLog:
    """The estimates from a log.  Raises NotIdentifiedError where it says nothing."""
    progress("closing loops")
    motion = completed_motion(machine.functions, log, settings, progress)
    progress("filtering")
    functions = machine.functions.telling_apart(some_states(motion.state))
    names = estimated_names(functions, motion.state)
    seen = observations(functions, names, log, motion, settings)
    first = len(seen.t) - int(SET_ASIDE * len(seen.t))
    _check_enough(seen.part(slice(0, first)), settings, log.file)
    progress("fitting")
    for name in gains_left_open(seen.part(slice(0, first))):
        seen, names = seen.with_gain_known(name), names.with_gain_kept(name, NOT_DETERMINED)
    fitted_to, aside = seen.part(slice(0, first)), seen.part(slice(first, None))
    estimate = estimated_with_gains(fitted_to) if names.gains else estimated(fitted_to)
    if not estimate.closed_columns:
        raise NotIdentifiedError("the motion of this log shows no parameter: record another one", log.file)
    return FittedLog(functions, motion.open_by, names, fitted_to, aside, estimate)


def identified_by(
    machine: IdentifiableMachine, log: MeasuredLog, settings: FilterSettings, progress: Progress
) -> Identification:
    """What a log says of a machine.  Raises NotIdentifiedError where it says nothing."""
    made = fitted_by(machine, log, settings, progress)
    functions, estimate = made.functions, made.estimate
    model, combinations = functions.model, functions.combinations
    given = made.names, functions.parameters, estimate
    values = file_values(model, combinations, *given)
    whole = None if isinstance(combinations, ShownTerms) else whole_bodies(model, combinations, *given)
    parts = machine.base.model, log, settings, made.open_by, functions.combinations, made.names
    return Identification(*parts, made.fitted_to, made.aside, estimate, values, whole)


def base_of(model: Model) -> BaseParameters:
    """Its base parameters; NotIdentifiedError where no motion shows any."""
    try:
        return base_parameters(model)
    except (NoBodiesError, NoMotionError):
        raise NotIdentifiedError("no regular motion of the model was found at which parameters count") from None


def terms_of(model: Model) -> EnergyTerms:
    """The products that its energies are linear in; NotIdentifiedError where all of their parameters are known."""
    terms = energy_terms(model)
    if not terms.monomials:
        raise NotIdentifiedError(
            "no parameter of the energies is left to identify: numbers have no name, and parameters of the geometry "
            "are taken for known; name masses and inertias under `parameters`, or say under `identify` what is geometry"
        )
    return terms


def _check_enough(seen: Observations, settings: FilterSettings, place: str) -> None:
    samples, drives, count = seen.columns.shape
    if samples * drives < 2 * count:
        raise NotIdentifiedError(
            f"{samples} samples are left at a cut-off of {settings.cutoff:.3g} Hz, too few for {count} parameters: "
            "record a longer motion",
            place,
        )
    if not np.isfinite(seen.columns).all():
        raise NotIdentifiedError("it goes through a singularity, where inputs are not determined: leave it out", place)
