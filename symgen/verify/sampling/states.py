"""Admissible states for verification: on the constraint manifold, away from singularities, seeded and deterministic."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from math import comb, isfinite
from typing import Any

from symgen.ir.kernel import Scalar
from symgen.model.quantities import (
    BASE_PARAMETERS,
    MEASURED,
    MEASURED_PLACES,
    PARTITION,
    ROWS,
    TASK_OPEN,
    TASK_PLACES,
    TASK_RATES,
)
from symgen.runtime.activity import working
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.base_regressor import motions_solved
from symgen.verify.reference.configurations.given import (
    USUAL_STEPS,
    is_near_measured,
    is_near_task,
    measured_determine,
    task_determines,
)
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.quantities import CURVED, DIFFERENCED, ITERATED, RATES
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.inertias import Inertias
from symgen.verify.sampling.plain_values import SAMPLING_BITS, floats, measured, settled, values_at
from symgen.verify.sampling.regular import FEWEST_STATES, REGULAR_SHARE, Regular, RegularStateSearch
from symgen.verify.sampling.task_ahead import with_task

# States of a verification, unless told otherwise.
USUAL_STATES = 64
# Seconds that the reference may take for all states, by a count of its operations and never by a clock.
LONGEST_SECONDS = 20.0


class VerificationError(Exception):
    """Verification could not be carried out at all; the text says why."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A state with exact floats; `admissible` when rates and accelerations satisfy the constraints up to rounding."""

    state: State
    admissible: bool
    measures: tuple[float, float]


def affordable_states(reference: Reference, quantities: Sequence[str], wanted: int) -> int:
    """How many of `wanted` states fit in 20 s, by a count of operations (never by a clock), but 8 at least."""
    system, ranks = reference.system, reference.ranks
    solved = 40 * sum(len(part.coordinates) ** 3 for part in system.heavy) + 2 * system.n**2
    if len(ranks.of_parts) == len(system.parts):
        of_parts = zip(system.parts, ranks.of_parts, strict=True)
        subsets = max(comb(len(part.rows), constraints) for part, (constraints, _) in of_parts)
    else:
        subsets = comb(system.r, ranks.constraints)
    rates = (matrix for quantity in quantities for matrix in RATES.get(quantity, ()))
    operations = system.operations(rates) + solved * subsets
    # derivatives by coordinates take the whole at two more places for each
    places = 1 + 2 * system.n if DIFFERENCED.intersection(quantities) else 1
    places *= 2 if CURVED.intersection(quantities) else 1
    places += USUAL_STEPS if ITERATED.intersection(quantities) else 0
    places += motions_solved(reference.model, ranks) if BASE_PARAMETERS in quantities else 0
    seconds_per_state = 30 * 1.3e-7 * operations * places
    return max(FEWEST_STATES, min(wanted, int(LONGEST_SECONDS / seconds_per_state)))


def sample_states(
    reference: Reference,
    quantities: Sequence[str],
    count: int,
    seed: int = 0,
    modes: Sequence[Sequence[float]] = (),
) -> tuple[Sample, ...]:
    """`count` states (fewer when V is hard to find), rounded to float64; one in five starts at one of the `modes`.

    Rates and accelerations are projected onto the constraints in the even ones and arbitrary in the others; every
    fourth is moved off V by about 1e-3, as measured states are, unless the constraints depend on each other or the
    inputs reach more directions there than on V: what they give is defined on V alone then.
    Raises VerificationError when fewer than 8 are found.
    """
    with precision(SAMPLING_BITS):
        inside: list[Sample] = []
        outside: list[Regular] = []
        search = RegularStateSearch(reference, count, seed, modes)
        inertias = Inertias(reference, quantities)
        with working("", count) as work:
            for regular, in_range in search.candidates():
                if not in_range:
                    outside.append(regular)
                elif (sample := _sample(reference, quantities, regular, inertias)) is not None:
                    inside.append(sample)
                else:
                    search.has_no_value()
                if len(inside) == count:
                    break
                work.done, work.part = len(inside), f"{len(inside)} of {count} found"
        others = (_sample(reference, quantities, regular, inertias) for regular in outside)
        samples = [*inside, *islice((sample for sample in others if sample is not None), count - len(inside))]
    if len(samples) < FEWEST_STATES:
        raise VerificationError(
            f"{reference.model.name}: only {len(samples)} regular configurations on the constraint manifold were found "
            f"({FEWEST_STATES} are needed){search.explanation()}; give a start under `configuration` and the ranges of "
            "the coordinates"
        )
    return tuple(samples)


def rounded(sample: Sample, scalar: Scalar) -> Sample:
    """The sample with every number rounded to the scalar type."""
    state = in_scalar(sample.state, scalar)
    return sample if state is sample.state else replace(sample, state=state)


def in_scalar(state: State, scalar: Scalar) -> State:
    """The state with every number rounded to the scalar type."""
    if scalar == "float64":
        return state
    return State(*(tuple(_single(x) for x in part) for part in state.parts))


def _single(value: Any) -> float:
    return float(struct.unpack("f", struct.pack("f", value))[0])


def _sample(
    reference: Reference, quantities: Sequence[str], regular: Regular, inertias: Inertias
) -> Sample | None:
    """A regular state with its inputs, rates and accelerations, or None outside the domain of a quantity.

    States all but without an inertia of some direction are none, where quantities divide by inertias.
    """
    state, values = regular.state, regular.values
    try:
        if missing := [name for name in measured(reference) if name not in values]:
            values = values | values_at(reference, state, missing)
        if regular.admissible:
            coordinates = reference.model.coordinates
            rates = settled(values["admissible_velocity"], [c.rate_range for c in coordinates])
            accelerations = settled(values["admissible_acceleration"], [c.acceleration_range for c in coordinates])
            state = replace(state, qd=tuple(rates), qdd=tuple(accelerations))
        if regular.shares:
            scale = 2 * max(1.0, *(abs(x) for x in values["inverse_dynamics"]))
            state = replace(state, u=tuple(scale * share for share in regular.shares))
        state = with_task(reference, state)
        everything = reference.matrices(state, (*quantities, *inertias.names), SAMPLING_BITS)
    except ReferenceValueError:
        return None
    if not all(isfinite(x) for matrix in everything.values() for x in floats(matrix)):
        return None
    if any(ROWS[name].needs == PARTITION for name in quantities) and not _is_free(reference, state):
        return None
    for needs, required in _REQUIRED.items():
        if any(ROWS[name].needs in needs for name in quantities) and not _holds(reference, state, required):
            return None
    if not inertias.is_regular(inertias.share(everything)):
        return None
    first, second = values["singularity"]
    return Sample(state, regular.admissible, (first, second))


def _is_free(reference: Reference, state: State) -> bool:
    """Whether the independent velocities determine the others, as far from where they fail as regular states are.

    Where they fail the system may be regular: their quantities have a status there.
    """
    (complement,) = values_at(reference, state, ("orthogonal_complement",)).values()
    return max(map(abs, complement)) * REGULAR_SHARE < 1


# By what quantities need: what a state has to be for them, near enough to the configuration a moment later among it.
_REQUIRED: dict[tuple[str, ...], Callable[[Evaluation], bool]] = {
    (MEASURED, MEASURED_PLACES): measured_determine,
    (TASK_RATES, TASK_PLACES, TASK_OPEN): task_determines,
    (MEASURED_PLACES,): is_near_measured,
    (TASK_PLACES,): is_near_task,
}


def _holds(reference: Reference, state: State, required: Callable[[Evaluation], bool]) -> bool:
    """Whether a state is what quantities require: kernels have a status elsewhere."""
    try:
        return reference.regular(lambda: required(reference.evaluation(state)), SAMPLING_BITS)
    except ReferenceValueError:
        return False
