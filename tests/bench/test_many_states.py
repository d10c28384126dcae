"""Many states: what is measured gives the results of one state, and the page tells ratios and goals."""

from __future__ import annotations

import ctypes
import json
import subprocess
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shipped

from symgen.laboratory.bench import batch
from symgen.laboratory.bench.batch import Many, many_states
from symgen.laboratory.bench.candidate import CCandidate, Task, straight_candidate
from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
from symgen.laboratory.bench.peers.engines.straight import LOOP_FLAGS
from symgen.laboratory.bench.peers.formulas.mechanics import mechanics
from symgen.laboratory.bench.peers.formulas.methods import lean
from symgen.laboratory.bench.reporting.batch_pages import many_lines, many_section
from symgen.laboratory.bench.symgen_kernels import programs_of, symgen_candidates
from symgen.laboratory.bench.workload import Workload
from symgen.model.model import Model

MANY = (
    Many("symgen", "batch", "C", "float64", 20.0, 10.0),
    Many("symgen", "batch contracted", "C", "float64", 16.0, 8.0),
    Many("symgen", "batch", "C", "float32", 10.0, 5.0),
    Many("symgen", "batch contracted", "C", "float32", 11.0, 6.0),
    Many("symgen", "compile()", "Python", "float64", 40.0, 50.0),
    Many("symgen", "NumPy, whole arrays", "Python", "float64", 300.0, 200.0),
    Many("symgen", "NumPy, blocks of 4096", "Python", "float64", 160.0, 200.0),
    Many("symgen", "elimination, portable, in a loop", "C", "float64", 80.0, 70.0),
    Many("SymPy", "part, in a loop", "C", "float64", 98.0, 90.0),
    Many("CasADi", "lean, in a loop", "C", "float64", 200.0, 190.0),
    Many("CasADi SSA", "lean, in lanes", "C", "float64", 24.0, 12.0),
)


def result(model: str, many: tuple[Many, ...] = MANY) -> dict[str, object]:
    rows = json.loads(json.dumps([asdict(m) for m in many]))
    return {"model": model, "comparisons": [{"quantity": "inverse_dynamics", "many_states": rows}]}


def test_page_tells_ratios_and_missed_goals() -> None:
    text = many_section([result("rapkm_2rrr_rr"), result("skate", MANY[:7])])
    robot, skate = text.splitlines()[-2:]
    assert "| 50 (100) | 62.5 (125) | 100 (200) | 25 (20) | 12.5 (14.3) | 10.2 (11.1) SymPy part |" in robot
    assert "| 41.7 (83.3) CasADi SSA lean | 6.25 (5) |" in robot
    assert "| 6.25 (5) | **4.9** (5) | **1.20** (1.25) | 1.5 | 8.0 (6) |" in robot
    assert skate.endswith("|  |  | 6.25 (5) |  |  |  | 8.0 |")
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
    lines = _lean(model)
    ways = many_states(tmp_path, model, task, programs, [replace(own, generator="other"), lines], load)
    assert [(way.label, way.language, way.scalar) for way in ways] == [
        ("symgen batch", "C", "float64"),
        ("symgen batch contracted", "C", "float64"),
        ("symgen batch", "C", "float32"),
        ("symgen batch contracted", "C", "float32"),
        ("symgen compile()", "Python", "float64"),
        ("symgen NumPy, whole arrays", "Python", "float64"),
        ("symgen NumPy, blocks of 4096", "Python", "float64"),
        (f"other {own.form}, in a loop", "C", "float64"),
        ("CasADi SSA lean, in a loop", "C", "float64"),
        ("CasADi SSA lean, in lanes", "C", "float64"),
    ]
    assert all(way.streamed_nanoseconds > 0 and way.cached_nanoseconds > 0 for way in ways)


@pytest.mark.toolchain
def test_lines_in_lanes_are_those_of_one_state(tool: Callable[[str], str], tmp_path: Path) -> None:
    compiler = tool("gcc")
    model = shipped.model("slider_crank")
    lines = _lean(model).straight
    assert lines is not None
    (tmp_path / "one.c").write_text(lines.function("one"))
    (tmp_path / "many.c").write_text(lines.loop("many"))
    for name, flags in (("one", ["-DREAL=double"]), ("many", LOOP_FLAGS)):
        command = [compiler, "-O2", "-shared", "-fPIC", *flags, f"{name}.c", "-o", f"{name}.so", "-lm"]
        subprocess.run(command, check=True, cwd=tmp_path)
    one, many = (ctypes.CDLL(str(tmp_path / f"{name}.so"))[name] for name in ("one", "many"))
    source = np.random.default_rng(3)
    count, stride = 5, 8
    q, qd, qdd = (source.uniform(0.2, 1.0, size=(model.n, stride)) for _ in range(3))
    p, outputs = source.uniform(0.5, 1.0, size=len(model.parameters)), np.zeros((model.m, stride))
    many(ctypes.c_size_t(count), ctypes.c_size_t(stride), *map(_address, (q, qd, qdd, p, outputs)))
    for k in range(stride):
        own = np.zeros(model.m)
        state = [np.ascontiguousarray(part[:, k]) for part in (q, qd, qdd)]
        one(*map(_address, (*state, p, own)))
        assert outputs[:, k] == pytest.approx(own if k < count else np.zeros(model.m), rel=1e-12)


def _lean(model: Model) -> CCandidate:
    """u by CasADi in straight lines."""
    engine = CasadiSsaEngine()
    system = mechanics(engine, model)
    lines = engine.straight(system.inputs, lean(engine, system))
    return straight_candidate(engine.tool, "lean", "lean_float64", lines)


def _address(array: Any) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
