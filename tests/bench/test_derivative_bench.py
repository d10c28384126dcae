"""Derivatives of u beside CasADi's and Pinocchio's: the same J_u from every peer, a page of goals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi
import numpy as np
import pytest
from robot_packages import pinocchio
from shipped import ROOT, model

from symgen.laboratory.bench import build as build_module
from symgen.laboratory.bench import mechanisms
from symgen.laboratory.bench.derivatives import derivative_benchmark
from symgen.laboratory.bench.mechanisms import drawn_states
from symgen.laboratory.bench.peers import jacobian_peers
from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.formulas.recursion import mechanics_by_recursion
from symgen.laboratory.bench.peers.mechanism_roster import of_inputs
from symgen.laboratory.bench.peers.pinocchio_program import pinocchio_jacobian
from symgen.laboratory.bench.reporting.derivative_pages import missed, page, table_of


def quiet(_: str) -> None:
    pass


def kernel(generator: str, form: str, instructions: int) -> dict[str, Any]:
    footprint = {"code": 100, "stack": 8}
    return {
        "generator": generator, "form": form, "instructions": instructions, "nanoseconds": 1.0, "footprint": footprint,
        "operations": {"add": 3, "mul": 4}, "difference": 1e-16,
    }  # fmt: skip


def result(*kernels: dict[str, Any]) -> dict[str, Any]:
    return {"kernels": list(kernels), "left_out": [["CasADi native", "too long"]], "notes": []}


def test_the_cheapest_form_of_a_tool_counts_and_what_is_missed_is_said() -> None:
    own = kernel("symgen", "minor, portable", 60), kernel("symgen", "minor, libm", 100)
    peers = kernel("CasADi", "native", 400), kernel("CasADi SSA", "part", 125), kernel("Pinocchio", "derivatives", 140)
    results = {"arm": result(*own, *peers), "flat": result(kernel("symgen", "minors, portable", 50), peers[0]),
               "even": result(*own, kernel("CasADi", "lean", 100)), "alone": result(*own)}  # fmt: skip
    text = page(results)
    assert "| arm | 100 | 60 | 0.80: 125 CasADi SSA part | **0.71**: 140 Pinocchio derivatives |" in text
    # a kernel without angles has one form
    assert "| flat | 50 | 50 | 0.12: 400 CasADi native |  |" in text
    # as many is not fewer
    assert "| even | 100 | 60 | **1.00**: 100 CasADi lean |  |" in text
    assert "| alone | 100 | 60 |  |  |" in text
    assert missed(results) == ["arm takes 0.71 of Pinocchio", "even takes 1.00 of CasADi"]
    assert "Missed: arm takes 0.71 of Pinocchio; even takes 1.00 of CasADi." in text
    assert "Not measured: CasADi native (too long)." in text
    assert "No goal is missed." in page({"flat": results["flat"]})
    assert page({}).startswith("# Derivatives of u")
    assert "too long" in table_of({"model": "arm", **results["arm"]})


@pytest.mark.toolchain
@pytest.mark.parametrize(
    "name", ["double_pendulum", pytest.param("front_car_bodies", marks=[pytest.mark.slow, pytest.mark.bench])]
)
def test_every_peer_computes_the_derivatives(
    name: str, tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    tool("gcc")
    monkeypatch.setattr(build_module, "FLAGS", ("-O0", *build_module.FLAGS[1:]))
    monkeypatch.setattr(mechanisms, "PASSES", 3)
    monkeypatch.setattr(mechanisms, "find_valgrind", lambda: None)
    monkeypatch.setattr(jacobian_peers, "pinocchio_jacobian", lambda *_: "not asked for")
    made = derivative_benchmark(ROOT / "models" / f"{name}.yaml", quiet).to_json()
    assert {row["generator"] for row in made["kernels"]} == {"symgen", "CasADi", "CasADi SSA"}
    assert "native" in {row["form"] for row in made["kernels"]}
    assert {row["form"]: row["difference"] for row in made["kernels"] if not row["difference"] < 1e-12} == {}


def test_where_no_form_is_short_the_shortest_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jacobian_peers, "pinocchio_jacobian", lambda *_: "not asked for")
    states = np.array(drawn_states(model("front_car"), 200))
    every, _ = jacobian_peers.jacobian_peers(model("front_car"), states)
    lengths = {c.form: sum((c.operations or {}).values()) for c in every}
    shortest = min(lengths, key=lambda form: lengths[form])
    # u itself is shorter than any of its derivatives
    monkeypatch.setattr(jacobian_peers, "LONGEST_LINES", min(lengths.values()) - 5)
    kept, left_out = jacobian_peers.jacobian_peers(model("front_car"), states)
    assert {c.form for c in kept} == {shortest}
    assert len([why for _, why in left_out if "operations" in why]) == len(lengths) - 1
    monkeypatch.setattr(jacobian_peers, "LONGEST_ALONE", 3)
    assert jacobian_peers.jacobian_peers(model("front_car"), states)[0] == ()


def test_loops_and_energies_have_no_derivatives_by_pinocchio() -> None:
    assert pinocchio_jacobian(model("delta")) == "it has derivatives of trees alone"
    assert pinocchio_jacobian(model("double_pendulum")) == "not every coordinate moves one joint"


@pytest.mark.slow
@pytest.mark.bench
@pytest.mark.toolchain
def test_pinocchio_has_the_derivatives_of_the_recursion(tool: Callable[[str], str]) -> None:
    tool("g++")
    pinocchio()
    one = model("arm7")
    derivatives = pinocchio_jacobian(one)
    assert not isinstance(derivatives, str), derivatives
    engine = CasadiEngine()
    system = mechanics_by_recursion(engine, one)
    q, qd, qdd, p = (casadi.vertcat(*system.inputs[array]) for array in ("q", "qd", "qdd", "p"))
    slopes = casadi.jacobian(casadi.vertcat(*of_inputs(engine, system)), casadi.vertcat(q, qd, qdd))
    expected = casadi.Function("slopes", [q, qd, qdd, p], [slopes])
    for state in drawn_states(one, 3):
        parts = state[:7], state[7:14], state[14:21]
        exact = expected(*parts, state[21:]).full()
        assert derivatives(*parts).full() == pytest.approx(exact, rel=1e-10, abs=1e-10)
