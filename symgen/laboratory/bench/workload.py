"""The states every candidate is run on, and the exact results there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.laboratory.bench.candidate import Task
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.plain_values import SAMPLING_BITS
from symgen.verify.sampling.states import Sample, rounded, sample_states
from symgen.verify.tolerance import FACTOR, expectations

UNIT_STATES = 48  # of these the unit d + eps |y| is found; it costs 9 reference evaluations a state


@dataclass(frozen=True, slots=True)
class Workload:
    """Inputs of one scalar type, row by row, and exact results as a sum high + low of two float64 arrays.

    `states` (k, 2 n + third + P) holds q, q̇, the third array and the parameters; `units` is d + eps |y| of the
    first states (`verify/tolerance.py`).
    """

    scalar: Scalar
    states: Any
    high: Any
    low: Any
    units: Any


def admissible_samples(reference: Reference, count: int, quantities: Sequence[str]) -> tuple[Sample, ...]:
    """States on the constraint manifold, rates and accelerations included, that are away from singularities."""
    geometric = bool(reference.system.r_geometric) and reference.ranks.constraints == reference.model.r
    samples = []
    wanted = -(-4 * count // 3) + 8 if geometric else count
    for index, sample in enumerate(sample_states(reference, quantities, wanted, seed=1)):
        if sample.admissible:
            samples.append(sample)
        elif not (geometric and index % 4 == 3):
            samples.append(_made_admissible(reference, sample))
    return tuple(samples[:count])


def _made_admissible(reference: Reference, sample: Sample) -> Sample:
    names = ("admissible_velocity", "admissible_acceleration")
    values = reference.matrices(sample.state, names, SAMPLING_BITS)
    qd, qdd = (tuple(map(float, values[name].entries())) for name in names)
    return replace(sample, state=replace(sample.state, qd=qd, qdd=qdd), admissible=True)


def workload(
    reference: Reference, samples: Sequence[Sample], task: Task, scalar: Scalar, progress: Callable[[str], None]
) -> Workload:
    """The samples rounded to the scalar type and the reference's results at the rounded values."""
    import numpy as np

    rows, high, low, units = [], [], [], []
    for index, sample in enumerate(samples):
        if index % 250 == 0:
            progress(f"reference of {task.quantity} for {scalar}, state {index + 1} of {len(samples)}")
        state = rounded(sample, scalar).state
        third = state.qdd if task.third == "qdd" else state.u
        rows.append([*state.q, *state.qd, *third, *state.parameters])
        exact = reference.precise(state, (task.quantity,))[task.quantity].entries()
        heads = [float(entry) for entry in exact]
        high.append(heads)
        low.append([float(entry - head) for entry, head in zip(exact, heads, strict=True)])
        if index < UNIT_STATES:
            expected = expectations(reference, state, (task.quantity,), scalar, f"{scalar} {index}")
            units.append(expected[task.quantity].unit)
    return Workload(scalar, np.array(rows), np.array(high), np.array(low), np.array(units))


@dataclass(frozen=True, slots=True)
class Errors:
    """Relative errors |y − y*|/|y*| over the states, and the largest error in units of d + eps |y*|.

    A state without a finite result counts as an infinite error; `failed` says how many there were.
    """

    median: float
    percentile_99: float
    largest: float
    largest_in_units: float
    failed: int


def errors_of(load: Workload, results: Any) -> Errors:
    """Errors of results (k, size)."""
    import numpy as np

    distances = np.linalg.norm((np.asarray(results, dtype=np.float64) - load.high) - load.low, axis=1)
    sizes = np.linalg.norm(load.high, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(distances == 0, 0.0, distances / sizes)
        in_units = np.where(distances == 0, 0.0, distances)[: len(load.units)] / load.units
    relative = np.where(np.isfinite(relative), relative, np.inf)
    in_units = np.where(np.isfinite(in_units), in_units, np.inf)
    ordered = np.sort(relative)
    return Errors(
        median=float(ordered[len(ordered) // 2]),
        percentile_99=float(ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))]),
        largest=float(ordered[-1]),
        largest_in_units=float(np.max(in_units, initial=0.0)),
        failed=int(np.sum(~np.isfinite(distances))),
    )


def beyond_tolerance(reference: Reference, task: Task, load: Workload, results: Any) -> int:
    """How many states' errors exceed 16 (d + eps |y|); d is only found where eps |y| does not cover the error."""
    import numpy as np

    given = np.asarray(results, dtype=np.float64)
    distances = np.linalg.norm((given - load.high) - load.low, axis=1)
    covered = FACTOR * float(UNIT_ROUNDOFF[load.scalar]) * np.linalg.norm(load.high, axis=1)
    count = 0
    for k in np.flatnonzero(~(distances <= covered)).tolist():
        state = _state(reference, task, load.states[k].tolist())
        exact = expectations(reference, state, (task.quantity,), load.scalar, f"beyond {k}")[task.quantity]
        count += not exact.in_units(exact.distance(given[k].tolist())) <= FACTOR
    return count


def _state(reference: Reference, task: Task, row: list[float]) -> State:
    model = reference.model
    n, end = model.n, len(row) - len(model.parameters)
    third = tuple(row[2 * n : end])
    qdd, u = (third, (0.0,) * model.m) if task.third == "qdd" else ((0.0,) * n, third)
    return State(tuple(row[:n]), tuple(row[n : 2 * n]), qdd, u, tuple(row[end:]))
