"""Errors of the generated kernels on the page of the benchmark, and states beyond the tolerance."""

from __future__ import annotations

from typing import Any

from shipped import model

from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.reporting.accuracy_pages import accuracy_section
from symgen.laboratory.bench.workload import admissible_samples, beyond_tolerance, workload
from symgen.verify.reference.reference import Reference


def result(median: float) -> dict[str, Any]:
    errors = {"median": median, "percentile_99": 2 * median, "largest": 3 * median}
    row = {"language": "C", "chosen": True, "form": "elimination, portable", "errors": errors, "beyond": 1}
    rows = [{**row, "scalar": scalar} for scalar in ("float64", "float32")]
    compared = {"quantity": "inverse_dynamics", "states": 1000, "measured": rows}
    return {"model": "rapkm_2rrr_rr", "comparisons": [compared]}


def test_the_goals_of_the_parallel_robot() -> None:
    text = accuracy_section([result(1e-15)])
    assert "| rapkm_2rrr_rr | 1.0e-15 (2e-14) | 2.0e-15 (2e-14) | 3.0e-15 |" in text
    assert "| 2 of 2000 |" in text
    assert "**" not in text
    assert "**2.2e-14** (2e-14)" in accuracy_section([result(1.1e-14)])
    assert accuracy_section([]) == ""


def test_states_beyond_the_tolerance_are_counted() -> None:
    reference, task = Reference(model("skate")), Task("inverse_dynamics", "qdd", 2)
    samples = admissible_samples(reference, 8, [task.quantity])
    load = workload(reference, samples, task, "float64", lambda _: None)
    assert beyond_tolerance(reference, task, load, load.high) == 0
    spoiled = load.high.copy()
    spoiled[3] *= 1 + 1e-12
    spoiled[5] *= float("nan")
    assert beyond_tolerance(reference, task, load, spoiled) == 2
