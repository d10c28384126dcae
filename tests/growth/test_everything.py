"""`all` has counted limits: beyond them the longest quantities are left out and told, and made where they are named."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from linkages import row_of_four_bars

from symgen.generation.results import Options
from symgen.methods.derivation import Derivation
from symgen.model.load import load_text
from symgen.model.quantities import MAIN
from symgen.pipeline import generate
from symgen.quantities import everything
from symgen.quantities.catalogue import BY_NAME
from symgen.quantities.everything import OF_ALL, most_with_twice_the_digits
from symgen.quantities.select import derive_quantities
from symgen.runtime.effort import SCALAR, done
from symgen.symbolic.matrix import Vector

TEXT = row_of_four_bars(1, ground="0.7", tail="configuration: {a0: 1, a1: 1, b1: 0}")
MODEL = load_text(TEXT, "row.yaml")
WHEELS = """
model: two_wheels
coordinates: {a: {unit: rad, range: [0.5, 1]}, b: {unit: rad, range: [0.5, 1]}}
kinetic_energy: a_dot**2/2 + b_dot**2
inputs: {u: {acts_on: {a: 1}}}
"""


@pytest.mark.campaign
def test_the_longest_are_left_out_where_all_together_are_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = derive_quantities(MODEL, ("all",))
    costs = {choice.quantity: dict(choice.costs)[choice.title] for choice in whole.choices}
    most = sum(costs.values()) // 2
    monkeypatch.setattr(everything, "OPERATIONS_OF_ALL", most)
    short = derive_quantities(MODEL, ("all",))
    left_out = {name: why for name, why in short.absent if why.startswith(OF_ALL)}
    kept = {choice.quantity for choice in short.choices}
    assert {*costs} == kept | {*left_out}
    assert {derived.name for derived in short.quantities} == kept >= {*MAIN}
    assert sum(costs[name] for name in kept) <= most
    assert min(costs[name] for name in left_out) >= max(costs[name] for name in kept - {*MAIN})
    longest = max(left_out, key=lambda name: costs[name])
    assert str(costs[longest]) in left_out[longest]
    named = derive_quantities(MODEL, ("all", longest))
    assert longest in {derived.name for derived in named.quantities}


def test_what_takes_too_long_to_derive_is_given_up_unless_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(everything, "SCALARS_OF_A_METHOD", 20)
    monkeypatch.setattr(everything, "GROWTH", 2)
    short = derive_quantities(MODEL, ("all",))
    left_out = {name for name, why in short.absent if why.startswith(OF_ALL)}
    assert "projected_coriolis_matrix" in left_out
    assert {*MAIN} <= {derived.name for derived in short.quantities}
    named = derive_quantities(MODEL, ("projected_coriolis_matrix",))
    assert [derived.name for derived in named.quantities] == ["projected_coriolis_matrix"]
    assert not named.absent


@pytest.mark.campaign
def test_all_together_take_so_many_scalars_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    def taken(scalars: int) -> tuple[float, set[str], set[str]]:
        monkeypatch.setattr(everything, "SCALARS_OF_ALL", scalars)
        before = done()
        made = derive_quantities(MODEL, ("all",))
        left_out = {name for name, why in made.absent if "long to derive" in why}
        return done() - before, {choice.quantity for choice in made.choices}, left_out

    least, main, _ = taken(0)
    most, every, none = taken(10**9)
    assert not none
    assert {*MAIN} <= main < every
    some, kept, left_out = taken(int((most - least) / SCALAR) // 4)
    assert least < some < most
    assert main < kept < every
    assert left_out == every - kept


def test_what_loses_digits_is_limited_where_nobody_asks_for_it() -> None:
    def most(quantity: str, *outputs: str) -> float:
        return most_with_twice_the_digits(quantity, outputs, ())

    assert 0 < most("nullspace_projector", "all") < most("multipliers", "all") < math.inf
    assert most("nullspace_projector", "all", "nullspace_projector") == most("inverse_dynamics", "all") == math.inf


def test_what_all_leaves_out_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(everything, "OPERATIONS_OF_ALL", 1000)
    path = tmp_path / "row.yaml"
    path.write_text(TEXT)
    result = generate(path, Options(outputs=("all",), parts=("c",), verify=False), lambda _: None)
    messages = [notice.message for notice in result.notices if OF_ALL in notice.message]
    assert any(message.startswith("projected_coriolis_matrix: ") for message in messages)
    assert all("name it in `outputs`" in message for message in messages)


@pytest.mark.parametrize(
    ("operations", "outputs", "made"),
    [
        pytest.param(1_400, ("all",), True, marks=pytest.mark.campaign),
        (2_800, ("all",), False),
        pytest.param(2_800, ("all", "mass_matrix"), True, marks=pytest.mark.campaign),
    ],
)
def test_twice_the_digits_of_two_thousand_operations_are_for_those_who_ask(
    operations: int, outputs: tuple[str, ...], made: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The mass matrix of two wheels, with a long sum times what rounding leaves of sqrt(3 a)^2 - 3 a."""
    entry = BY_NAME["mass_matrix"]
    assert entry.outputs is not None
    usual = entry.outputs

    def losing_digits(derivation: Derivation) -> Vector:
        first, *rest = usual(derivation)
        graph = first.graph
        angle = graph.symbol("a")
        root = graph.raw("sqrt", (3 * angle,))
        long = graph.const(2**20)
        for k in range(operations // 2):
            long = graph.raw("add", (graph.raw("mul", (long, angle)), graph.const(2**20 + k)))
        nothing = graph.raw("sub", (graph.raw("mul", (root, root)), 3 * angle))
        return graph.raw("add", (first, graph.raw("mul", (long, nothing)))), *rest

    monkeypatch.setitem(BY_NAME, "mass_matrix", replace(entry, outputs=losing_digits))
    path = tmp_path / "two_wheels.yaml"
    path.write_text(f"{WHEELS}outputs: [{', '.join(outputs)}]\n", encoding="utf-8")
    result = generate(path, Options(scalars=("float64",), parts=("python",), states=8), lambda _: None)
    assert not result.left_out
    kernels = json.loads(result.files["derivation.json"])["kernels"]
    assert ("mass_matrix" in kernels) is made
    assert not made or kernels["mass_matrix"]["twice_the_digits"] == ["float64"]
    said = [notice.message for notice in result.notices if "all` leaves it out, as it loses digits" in notice.message]
    assert bool(said) is not made
    assert all(message.startswith("mass_matrix: ") for message in said)
