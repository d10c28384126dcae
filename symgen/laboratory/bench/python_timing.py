"""Time of Python candidates: one state a call, and all states in one call."""

from __future__ import annotations

from statistics import median
from time import perf_counter_ns
from typing import Any

from symgen.laboratory.bench.candidate import PythonCandidate
from symgen.laboratory.bench.workload import Workload
from symgen.model.model import Model

SINGLE_STATES, PASSES = 40, 7


def run_python(model: Model, candidate: PythonCandidate, load: Workload) -> tuple[Any, float, float]:
    """Results (k, size), nanoseconds a state in one call for all, nanoseconds of a call with one state."""
    columns = _columns(model, load.states)
    results = candidate.batch(*columns)
    together = []
    for _ in range(PASSES):
        start = perf_counter_ns()
        candidate.batch(*columns)
        together.append((perf_counter_ns() - start) / len(load.states))
    alone = []
    for row in load.states[:SINGLE_STATES].tolist():
        parts = _parts(model, row)
        start = perf_counter_ns()
        candidate.single(*parts)
        alone.append(perf_counter_ns() - start)
    return results, median(together), median(alone)


def _columns(model: Model, states: Any) -> tuple[Any, Any, Any, Any]:
    n, end = model.n, states.shape[1] - len(model.parameters)
    return states[:, :n], states[:, n : 2 * n], states[:, 2 * n : end], states[:, end:]


def _parts(model: Model, row: list[float]) -> tuple[list[float], list[float], list[float], list[float]]:
    n, end = model.n, len(row) - len(model.parameters)
    return row[:n], row[n : 2 * n], row[2 * n : end], row[end:]
