"""Many states: what is measured gives the results of one state, and the page tells ratios and goals."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
import shipped

from symgen.laboratory.bench import batch
from symgen.laboratory.bench.batch import Many, many_states
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.reporting.batch_pages import many_lines, many_section
from symgen.laboratory.bench.symgen_kernels import programs_of, symgen_candidates
from symgen.laboratory.bench.workload import Workload

MANY = (
    Many("symgen", "batch", "C", "float64", 20.0, 10.0),
    Many("symgen", "batch", "C", "float32", 10.0, 5.0),
    Many("symgen", "compile()", "Python", "float64", 40.0, 50.0),
    Many("symgen", "NumPy, whole arrays", "Python", "float64", 300.0, 200.0),
    Many("symgen", "NumPy, blocks of 4096", "Python", "float64", 160.0, 200.0),
    Many("symgen", "elimination, portable, in a loop", "C", "float64", 80.0, 70.0),
    Many("SymPy", "part, in a loop", "C", "float64", 98.0, 90.0),
    Many("CasADi", "lean, in a loop", "C", "float64", 200.0, 190.0),
)


def result(model: str, many: tuple[Many, ...] = MANY) -> dict[str, object]:
    rows = json.loads(json.dumps([asdict(m) for m in many]))
    return {"model": model, "comparisons": [{"quantity": "inverse_dynamics", "many_states": rows}]}


def test_page_tells_ratios_and_missed_goals() -> None:
    text = many_section([result("rapkm_2rrr_rr"), result("skate", MANY[:5])])
    robot, skate = text.splitlines()[-2:]
    assert "| 50 (100) | 100 (200) | 25 (20) | 12.5 (14.3) | 10.2 (11.1) SymPy part | 6.25 (5) |" in robot
    assert "| **4.9** (5) | 8.0 (6) |" in robot
    assert skate.endswith("| 6.25 (5) |  | 8.0 |")
    assert many_section([{"model": "old", "comparisons": [{"quantity": "inverse_dynamics"}]}]) == ""


def test_terminal_shows_the_fastest_first() -> None:
    lines = many_lines(MANY).splitlines()
    assert lines[2].split() == ["symgen", "batch", "float32", "10.0", "5.0"]


@pytest.mark.toolchain
def test_every_way_is_run(tool: Callable[[str], str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tool("gcc")
    monkeypatch.setattr(batch, "STREAMED", 128)
    monkeypatch.setattr(batch, "CACHED", 64)
    monkeypatch.setattr(batch, "PASSES", 1)
    model = shipped.model("skate")
    task = Task("inverse_dynamics", "qdd", model.m)
    programs = next(iter(programs_of(model, task, shipped.SCALARS).values()))
    own = symgen_candidates(model, {"way": programs}, "float64")[0]
    states = np.random.default_rng(1).uniform(0.5, 1.0, size=(10, 3 * model.n + len(model.parameters)))
    load = Workload("float64", states, None, None, None)
    ways = many_states(tmp_path, model, task, programs, [replace(own, generator="other")], load)
    assert [(way.label, way.language, way.scalar) for way in ways] == [
        ("symgen batch", "C", "float64"),
        ("symgen batch", "C", "float32"),
        ("symgen compile()", "Python", "float64"),
        ("symgen NumPy, whole arrays", "Python", "float64"),
        ("symgen NumPy, blocks of 4096", "Python", "float64"),
        (f"other {own.form}, in a loop", "C", "float64"),
    ]
    assert all(way.streamed_nanoseconds > 0 and way.cached_nanoseconds > 0 for way in ways)
