"""u of mechanisms beside peers that walk the frames: the same u, honest counts, a page of goals."""

from __future__ import annotations

from collections.abc import Callable

import casadi
import pytest
from shipped import ROOT, model

from symgen.laboratory.bench import build as build_module
from symgen.laboratory.bench import mechanisms
from symgen.laboratory.bench.mechanisms import drawn_states, mechanism_benchmark
from symgen.laboratory.bench.peers.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.frames import lagrange_by_frames, mechanics_by_frames
from symgen.laboratory.bench.peers.mechanics import mechanics
from symgen.laboratory.bench.peers.native import direct_balance
from symgen.laboratory.bench.peers.pinocchio_program import pinocchio_time, tree_text
from symgen.laboratory.bench.reporting import mechanism_pages
from symgen.laboratory.bench.reporting.goals import AS_WRITTEN, Goal
from symgen.laboratory.bench.reporting.mechanism_goals import CHEAPEST_WRITTEN, EARLY_COUNTS, GOALS, MECHANISMS
from symgen.laboratory.bench.reporting.mechanism_pages import page, table_of


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
    found = []
    for derive in (mechanics_by_frames, mechanics):
        s = derive(CasadiEngine(), model(name))
        arguments = [casadi.vertcat(*s.inputs[array]) for array in ("q", "qd", "qdd", "p")]
        rows = [x for row in (*s.B, *s.M) for x in row]
        function = casadi.Function("f", arguments, [casadi.vertcat(*s.balance, *rows)])
        n = model(name).n
        state = drawn_states(model(name), 1)[0]
        found.append(function(state[:n], state[n : 2 * n], state[2 * n : 3 * n], state[3 * n :]).full())
    assert found[0] == pytest.approx(found[1], rel=1e-10, abs=1e-10)


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
        found = [mechanism_pages.ratio([row("symgen", "elimination, libm", 45), *peers], goal, None) for goal in goals]
        assert [text.split("/ ")[1].split()[0] for text in found] == [str(written), str(cheapest)]


def test_velocities_in_either_axes_give_the_same_equations() -> None:
    one = model("arm7")
    state = drawn_states(one, 1)[0]
    found = []
    for world_axes in (False, True):
        s = lagrange_by_frames(one, world_axes)
        function = casadi.Function("f", [s.q, s.qd, s.qdd, s.p], [direct_balance(s)])
        found.append(function(state[:7], state[7:14], state[14:21], state[21:]).full())
    assert found[0] == pytest.approx(found[1], rel=1e-11, abs=1e-11)


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
