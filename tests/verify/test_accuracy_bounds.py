"""The accuracy of u that the benchmark is held to (1000 states there), on fewer states."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from shipped import SCALARS, model

from symgen.generation.runnable import RunnableKernels
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.workload import Errors, admissible_samples, errors_of, workload
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import Sample
from symgen.verify.tolerance import FACTOR, expectations

U = "inverse_dynamics"
STATES = {"rapkm_2rrr_rr": 120, "front_car": 40, "rear_car": 40, "skate": 40}
LIMITS: dict[Scalar, float] = {"float64": 2e-14, "float32": 1e-5}  # of the parallel robot, median and 99 %


@cache
def prepared(name: str) -> tuple[Reference, tuple[Sample, ...]]:
    reference = Reference(model(name))
    return reference, admissible_samples(reference, STATES[name], [U])


def state_of(row: list[float], n: int) -> State:
    parts = (row[:n], row[n : 2 * n], row[2 * n : 3 * n], (), row[3 * n :])
    return State(*map(tuple, parts))


def errors(name: str, scalar: Scalar, folder: Path) -> tuple[Errors, list[float]]:
    """Relative errors, and those in units of the tolerance at the states where eps |y| does not cover them."""
    reference, samples = prepared(name)
    kernels, n = RunnableKernels(model(name), folder, (U,)), model(name).n
    load = workload(reference, samples, Task(U, "qdd", model(name).m), scalar, lambda _: None)
    results, units = [], []
    for number, row in enumerate(load.states.tolist()):
        outcome = kernels.run(U, state_of(row, n), scalar)
        assert outcome.valid, (number, outcome.status)
        results.append(outcome.entries)
        exact_parts = zip(outcome.entries, load.high[number], load.low[number], strict=True)
        distance = max(abs(y - high - low) for y, high, low in exact_parts)
        if distance > FACTOR * float(UNIT_ROUNDOFF[scalar]) * max(map(abs, load.high[number])):
            exact = expectations(reference, state_of(row, n), (U,), scalar, f"bound {number}")[U]
            units.append(exact.in_units(exact.distance(outcome.entries)))
    return errors_of(load, results), units


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("name", STATES)
def test_every_state_is_within_the_tolerance(name: str, scalar: Scalar, tmp_path: Path) -> None:
    relative_errors, units = errors(name, scalar, tmp_path)
    assert max(units, default=0.0) <= FACTOR
    if name == "rapkm_2rrr_rr":
        assert relative_errors.median <= relative_errors.percentile_99 <= LIMITS[scalar]
        assert relative_errors.median > 0
