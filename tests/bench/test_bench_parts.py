"""The callgrind parser, the Pareto front, labels, the goals page."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from symgen.laboratory.bench.build import CandidateFootprint
from symgen.laboratory.bench.callgrind import inclusive_costs
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.pareto import pareto_front
from symgen.laboratory.bench.reporting.charts import spread, time_against_error
from symgen.laboratory.bench.reporting.goals import EARLY_COUNTS, GOALS, PAPER
from symgen.laboratory.bench.reporting.pages import deviation_lines, page
from symgen.laboratory.bench.reporting.tables import bench_tables
from symgen.laboratory.bench.run import Benchmark, Comparison, MeasuredCandidate
from symgen.laboratory.bench.workload import Errors

PROFILE = """version: 1
creator: callgrind-3.19.0
events: Ir

fl=driver.c
fn=run_double
10 4
cfi=unit0.c
cfn=kernel_one
calls=64 5
11 6400
cfn=kernel_two
calls=64 7
11 12800
12 3

fn=kernel_one
5 640
cob=/lib/libm.so
cfn=__sincos_fma
calls=64 0
6 5760

fn=run_float
cfn=kernel_two
calls=64 7
13 6400
"""


def test_inclusive_costs_of_calls() -> None:
    assert inclusive_costs(PROFILE, ("kernel_one", "kernel_two")) == {"kernel_one": 100.0, "kernel_two": 150.0}
    assert inclusive_costs(PROFILE, ("absent",)) == {}


def test_pareto_front_keeps_what_nothing_beats() -> None:
    points = [(3.0, 1.0), (1.0, 5.0), (2.0, 5.0), (2.0, 2.0), (4.0, 1.0), (1.0, 5.0), (9.0, 0.5)]
    assert pareto_front(points) == (1, 3, 0, 6)
    assert pareto_front([]) == ()
    assert pareto_front([(1.0, float("inf"))]) == ()


@pytest.mark.parametrize("wanted", [[0.9, 0.9, 0.9, 0.1], [0.05] * 6, [1.2, 1.1], []])
def test_labels_do_not_overlap(wanted: list[float]) -> None:
    placed = spread(wanted, 0.1, 1.0)
    assert len(placed) == len(wanted)
    assert all(above - below >= 0.1 - 1e-12 for above, below in pairwise(placed))
    assert all(-1e-12 <= height <= 1.0 for height in placed)


def measured(generator: str, form: str, count: float, **changes: Any) -> MeasuredCandidate:
    row = MeasuredCandidate(
        generator=generator,
        form=form,
        language="C",
        scalar="float64",
        nanoseconds=count / 5,
        single_nanoseconds=None,
        instructions=count,
        footprint=CandidateFootprint(400, 64),
        operations={"add": 3} if generator == "symgen" else None,
        errors=Errors(1e-16, 1e-15 * count / 100, 2e-15 * count / 100, 0.5, 0),
        chosen=generator == "symgen",
        on_front=generator == "symgen",
    )
    return replace(row, **changes)


def result_of(name: str, factor: float = 1.0) -> Benchmark:
    written, valid, best = (EARLY_COUNTS[key][PAPER.index(name)][0] for key in EARLY_COUNTS)
    rows = (
        measured("symgen", "minors, portable", 0.3 * best),
        measured("symgen", "minors, libm", 0.6 * best),
        measured("CasADi", "native", written * factor),
        measured("SymPy", "lean", max(valid, best)),
        measured("SymPy", "part", best),
        measured("SymPy", "part", best / 2, scalar="float32"),
        measured("NumPy", "pinv", 1.0, language="Python", instructions=None, footprint=None, nanoseconds=9000.0),
        measured("SymPy", "broken", 1e6, errors=Errors(float("inf"), float("inf"), float("inf"), float("inf"), 9)),
    )
    task = Task("inverse_dynamics", "qdd", 2)
    return Benchmark(name, (Comparison(task, 10, rows, (("method elimination", "no selection"),)),), ("a note",))


def test_charts_and_tables_are_functions_of_the_numbers() -> None:
    first, again = result_of("front_car"), result_of("front_car")
    chart = time_against_error(first.comparisons[0])
    assert chart == time_against_error(again.comparisons[0])
    assert chart.startswith("<?xml")
    assert chart != time_against_error(result_of("front_car", 2.0).comparisons[0])
    table = bench_tables(first)
    assert "SymPy part" in table
    assert "not measured: method elimination (no selection)" in table
    assert "note: a note" in table


def test_page_shows_goals_met_and_missed() -> None:
    results = [result_of(name).to_json() for name in PAPER]
    text = page(results, {"front_car": ["front_car.svg"]})
    assert "![Run time against error of front_car](front_car.svg)" in text
    assert "**" not in text[text.index("## Goals") : text.index("The same of the times")]
    missed = [result_of(name, 0.1).to_json() for name in PAPER]
    text = page(missed, {})
    assert "**" in text[text.index("## Goals") : text.index("The same of the times")]
    assert all(f"({ratio:.2f})" in text for goal in GOALS for ratio in goal.ratios if ratio is not None)
    assert "fails" in text


def test_dearer_peers_are_reported() -> None:
    honest = deviation_lines([result_of(name).to_json() for name in PAPER])
    assert len(honest) == len(PAPER) * len(EARLY_COUNTS)
    assert not any("DEARER" in line for line in honest)
    straw = deviation_lines([result_of(name, 1.2).to_json() for name in PAPER])
    assert sum("DEARER" in line for line in straw) == len(PAPER)
    assert deviation_lines([]) == []
