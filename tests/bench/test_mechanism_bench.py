"""u of mechanisms beside peers that walk the frames: the same u, honest counts, a page of goals."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest
from shipped import ROOT, model

from symgen.laboratory.bench import build as build_module
from symgen.laboratory.bench import mechanisms
from symgen.laboratory.bench.mechanisms import drawn_states, mechanism_benchmark
from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.engines.ssa_engine import SsaEngine
from symgen.laboratory.bench.peers.formulas.articulated import forward_dynamics
from symgen.laboratory.bench.peers.formulas.frames import lagrange_by_frames, mechanics_by_frames
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem, mechanics
from symgen.laboratory.bench.peers.formulas.native import direct_balance
from symgen.laboratory.bench.peers.formulas.recursion import mechanics_by_recursion
from symgen.laboratory.bench.peers.pinocchio_program import pinocchio_time, tree_text
from symgen.laboratory.bench.reporting import mechanism_pages
from symgen.laboratory.bench.reporting.goals import AS_WRITTEN, Goal
from symgen.laboratory.bench.reporting.mechanism_goals import CHEAPEST_WRITTEN, EARLY_COUNTS, GOALS, MECHANISMS
from symgen.laboratory.bench.reporting.mechanism_pages import page, table_of
from symgen.model.load import load_text
from symgen.model.model import Model


def quiet(_: str) -> None:
    pass


@pytest.mark.parametrize(("name", "most"), [("arm7", 1700), ("chain8", 800), ("delta", 115), ("gough_stewart", 420)])
def test_recursion_keeps_what_is_shared(name: str, most: int) -> None:
    s = mechanics_by_frames(CasadiEngine(), model(name))
    arguments = [casadi.vertcat(*s.inputs[array]) for array in ("q", "qd", "qdd", "p")]
    function = casadi.Function("f", arguments, [casadi.cse(casadi.vertcat(*s.balance))])
    assert function.n_instructions() <= most


@pytest.mark.parametrize("name", ["rapkm_bodies", "front_car_bodies", "arm7"])
def test_frames_and_energies_give_the_same_equations(name: str) -> None:
    balances = []
    for derive in (mechanics_by_frames, mechanics):
        s = derive(CasadiEngine(), model(name))
        arguments = [casadi.vertcat(*s.inputs[array]) for array in ("q", "qd", "qdd", "p")]
        rows = [x for row in (*s.B, *s.M) for x in row]
        function = casadi.Function("f", arguments, [casadi.vertcat(*s.balance, *rows)])
        n = model(name).n
        state = drawn_states(model(name), 1)[0]
        balances.append(function(state[:n], state[n : 2 * n], state[2 * n : 3 * n], state[3 * n :]).full())
    assert balances[0] == pytest.approx(balances[1], rel=1e-10, abs=1e-10)


# Joints that turn and slide about slanted axes, an attitude on a branch, a rotor, wind.
TREE = """
model: crane_on_a_cart
parameters: {m: {value: 1.3}, k: {value: 40}, d: {value: 0.7}, g: {value: 9.81}}
gravity: [0.3, 0, -g]
joints:
  cart: {type: prismatic, axis: [1, 2, 0], at: [0, 0.1, 0], coordinate: s}
  mast: {type: revolute, parent: cart, axis: [0, 1, 3], at: [0.2, 0, 0.4], rotation: [[x, 0.3]], coordinate: a}
  boom: {type: prismatic, parent: mast, axis: x, at: [0, 0, d], coordinate: b}
  hook: {type: revolute, parent: boom, axis: y, at: [0.5, 0, 0], coordinate: c}
  side: {type: spherical, parent: cart, at: [0, -0.2, 0], coordinates: [e0, e1, e2, e3]}
bodies:
  cart: {mass: 5}
  mast: {mass: m, com: [0, 0.02, 0.3], inertia: {xx: 0.1, yy: 0.2, zz: 0.05, xy: 0.01}}
  boom: {mass: 2*m, com: [0.3, 0, 0], inertia: {xx: 0.01, yy: 0.2, zz: 0.2, yz: -0.003}}
  hook: {mass: 0.6, com: [0, 0, -0.2], inertia: {xx: 0.02, yy: 0.02, zz: 0.01}}
  side: {mass: 0.8, com: [0.1, 0, 0.05], inertia: {xx: 0.02, yy: 0.03, zz: 0.01}}
rotor_inertias: {c: 0.4}
points: {tip: {frame: hook, at: [0, 0, -0.3]}}
forces: {wind: {point: tip, direction: [1, 0, 0], magnitude: "-k*tip.vx"}}
friction: {s: {viscous: 3}}
inputs: {drive: {joint: s}, turn: {joint: a}}
"""


def balance_and_inputs(derive: Callable[[Any, Model], PeerSystem], described: Model) -> casadi.Function:
    s = derive(CasadiEngine(), described)
    arguments = [casadi.vertcat(*s.inputs[array]) for array in ("q", "qd", "qdd", "p")]
    return casadi.Function("f", arguments, [casadi.vertcat(*s.balance, *(x for row in s.M for x in row))])


@pytest.mark.parametrize("name", ["arm7", "scara", "crane"])
def test_a_recursion_gives_the_same_equations(name: str) -> None:
    described = load_text(TREE, "crane.yaml") if name == "crane" else model(name)
    n, state = described.n, np.random.default_rng(3).uniform(0.2, 1.1, 3 * described.n + len(described.parameters))
    parts = state[:n], state[n : 2 * n], state[2 * n : 3 * n], state[3 * n :]
    balances = [balance_and_inputs(d, described)(*parts).full() for d in (mechanics_by_frames, mechanics_by_recursion)]
    assert balances[0] == pytest.approx(balances[1], rel=1e-10, abs=1e-10)


@pytest.mark.parametrize("name", ["arm7", "scara", "crane"])
def test_articulated_bodies_solve_the_equations(name: str) -> None:
    # two coordinates of one joint
    cylinder = "cylindrical, parent: cart, at: [0, -0.2, 0], axis: [1, 0, 2], coordinates: [h, e]"
    text = TREE.replace("spherical, parent: cart, at: [0, -0.2, 0], coordinates: [e0, e1, e2, e3]", cylinder)
    described = load_text(text, "crane.yaml") if name == "crane" else model(name)
    inputs, accelerations = forward_dynamics(CasadiEngine(), described)
    columns = [casadi.vertcat(*inputs[array]) for array in inputs]
    solved = casadi.Function("f", columns, [casadi.vertcat(*accelerations)])
    n, source = described.n, np.random.default_rng(6)
    q, qd, u, p = (source.uniform(0.2, 1.1, k) for k in (n, n, described.m, len(described.parameters)))
    qdd = solved(q, qd, u, p).full()[:, 0]
    values = balance_and_inputs(mechanics_by_frames, described)(q, qd, qdd, p).full()[:, 0]
    assert values[:n] == pytest.approx(values[n:].reshape(n, -1) @ u, rel=1e-9, abs=1e-9)


@pytest.mark.toolchain
def test_straight_lines_compute_what_casadi_does(tool: Callable[[str], str], tmp_path: Path) -> None:
    described, engine = load_text(TREE, "crane.yaml"), SsaEngine()
    s = mechanics_by_recursion(engine, described)
    source, (name,), by_arrays = engine.c_function("balance", s.inputs, s.balance)
    assert not by_arrays
    (tmp_path / "b.c").write_text(source)
    library = tmp_path / "b.so"
    flags = ["-DREAL=double", "-O1", "-shared", "-fPIC"]
    subprocess.run([tool("gcc"), *flags, str(tmp_path / "b.c"), "-o", str(library), "-lm"], check=True)
    n, state = described.n, np.random.default_rng(4).uniform(0.2, 1.1, 3 * described.n + len(described.parameters))
    parts = state[:n], state[n : 2 * n], state[2 * n : 3 * n], state[3 * n :]
    made = np.zeros(n)
    pointers = [part.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for part in (*parts, made)]
    ctypes.CDLL(str(library))[name](*pointers)
    assert made == pytest.approx(balance_and_inputs(mechanics_by_recursion, described)(*parts).full()[:n, 0], rel=1e-11)


def test_straight_lines_are_the_same_whatever_the_addresses_of_objects() -> None:
    sources = set()
    for _ in range(2):
        engine = SsaEngine()
        s = mechanics_by_recursion(engine, model("scara"))
        sources.add(engine.c_function("balance", s.inputs, s.balance)[0])
    assert len(sources) == 1


@pytest.mark.bench
@pytest.mark.toolchain
def test_every_peer_computes_u(tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> None:
    tool("gcc")
    monkeypatch.setattr(build_module, "FLAGS", ("-O0", *build_module.FLAGS[1:]))
    monkeypatch.setattr(mechanisms, "PASSES", 3)
    monkeypatch.setattr(mechanisms, "find_valgrind", lambda: None)
    monkeypatch.setattr(mechanisms, "pinocchio_time", lambda *_: "not asked for")
    path = ROOT / "models" / "front_car_bodies.yaml"
    result = mechanism_benchmark(path, quiet).to_json()
    assert len(result["kernels"]) > 10
    assert {row["form"]: row["difference"] for row in result["kernels"] if not row["difference"] < 1e-12} == {}
    text = page({"front_car_bodies": result})
    assert "symgen elimination, portable" in text
    assert "CasADi" in text
    assert "front_car_bodies" in table_of(result)


def test_goals_and_early_counts_have_a_place_for_every_mechanism() -> None:
    assert all(len(goal.ratios) == len(MECHANISMS) for goal in GOALS)
    assert all(len(counts) == len(MECHANISMS) for counts in EARLY_COUNTS.values())
    assert page({}).startswith("# Mechanisms")


def test_as_written_is_native_or_else_along_directions() -> None:
    def row(generator: str, form: str, count: int) -> dict[str, object]:
        return {"generator": generator, "form": form, "instructions": count, "nanoseconds": 1.0}

    looped = [row("CasADi", "literal", 90), row("CasADi", "native", 100), row("wrenfold", "elimination", 50)]
    serial = [row("CasADi", "AD", 70), row("CasADi", "AD in world axes", 110), row("CasADi", "native", 900)]
    for peers, written, cheapest in ((looped, 100, 90), (serial, 110, 70), (looped[:1], 90, 90)):
        goals = [Goal(against, "libm", ()) for against in (AS_WRITTEN, CHEAPEST_WRITTEN)]
        ratios = [mechanism_pages.ratio([row("symgen", "elimination, libm", 45), *peers], goal, None) for goal in goals]
        assert [text.split("/ ")[1].split()[0] for text in ratios] == [str(written), str(cheapest)]


def test_velocities_in_either_axes_give_the_same_equations() -> None:
    one = model("arm7")
    state = drawn_states(one, 1)[0]
    balances = []
    for world_axes in (False, True):
        s = lagrange_by_frames(one, world_axes)
        function = casadi.Function("f", [s.q, s.qd, s.qdd, s.p], [direct_balance(s)])
        balances.append(function(state[:7], state[7:14], state[14:21], state[21:]).full())
    assert balances[0] == pytest.approx(balances[1], rel=1e-11, abs=1e-11)


@pytest.mark.parametrize(("name", "joints", "rows"), [("arm7", 7, 0), ("rapkm_bodies", 6, 4), ("chain8", 8, 2)])
def test_tree_for_pinocchio(name: str, joints: int, rows: int) -> None:
    one = model(name)
    lines = tree_text(one, drawn_states(one, 3)).splitlines()
    assert lines[0].split() == [str(x) for x in (one.n, rows, one.m, len(one.mechanism.bodies), 3)]
    parents = [int(line.split()[0]) for line in lines[2 : 2 + joints]]
    assert all(parent <= k for k, parent in enumerate(parents))
    assert {line.split()[1] for line in lines[2 : 2 + joints]} == {"z"}
    assert all(len(line.split()) == 3 * one.n for line in lines[-3:])


def test_mechanisms_that_are_no_tree_are_left_out_by_name() -> None:
    assert pinocchio_time(model("delta"), []) == "its rows are not sums of places of points"
