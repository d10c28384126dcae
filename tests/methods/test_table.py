"""A method that is registered is taken where it is valid and counts least, without a change anywhere else."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods import table
from symgen.methods.admission import FAILS, OfInputs
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.motion import Motion
from symgen.methods.forward_dynamics.motions import AlongNullSpace
from symgen.methods.method import INPUTS, Candidate, Method, solved_for_u
from symgen.methods.selection import Methods
from symgen.methods.table import METHODS, NAMED, MethodRow, Use
from symgen.methods.workspace import Workspace
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.model.quantities import MOTIONS
from symgen.quantities.alternatives import Alternatives
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

# A motor turns three equal drums by gear wheels.
DRUMS = """
model: geared_drums
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
parameters: {J: {value: 0.2, range: [0.1, 0.3]}, K: {value: 0.7, range: [0.5, 1]}}
kinetic_energy: J/2*a_dot**2 + K/2*(b_dot**2 + c_dot**2 + d_dot**2)
constraints: {nonholonomic: {first: b_dot - 2*a_dot, second: c_dot - 3*a_dot, third: d_dot - 6*a_dot}}
inputs: {T: {acts_on: {a: 1}}}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
"""
NAME = "reduced"


@pytest.fixture
def drums() -> Model:
    return load_text(DRUMS, "geared_drums.yaml")


def reduced_inertia(graph: Graph) -> Scalar:
    return graph.symbol("J") + (4 + 9 + 36) * graph.symbol("K")


def of_one_wheel(workspace: Workspace) -> Candidate | str:
    """u of the motor's wheel alone, which carries the inertia of all drums."""
    system = workspace.fresh()
    graph = system.mechanics.graph
    return solved_for_u(system, (reduced_inertia(graph) * graph.symbol("a_ddot"),), ())


def over_angle(workspace: Workspace) -> Candidate | str:
    """A shorter one that divides by what vanishes at regular states."""
    system = workspace.fresh()
    graph = system.mechanics.graph
    return solved_for_u(system, (graph.symbol("J") / graph.symbol("a"),), ())


def longer(workspace: Workspace) -> Candidate | str:
    """The one of the elimination with a long way around."""
    made = of_one_wheel(workspace)
    assert isinstance(made, Candidate)
    (u,) = made.derived.outputs
    graph = made.system.mechanics.graph
    more = [graph.function("exp", (graph.symbol(name),)) for name in ("J", "K", "a", "b", "a_ddot")]
    return solved_for_u(made.system, (graph.sum((u, *more)),), ())


def motion_of_one_wheel(derivation: Derivation) -> Motion:
    """q_ddot and lambda from the motor's wheel alone."""
    graph = derivation.graph
    turning = graph.symbol("T") / reduced_inertia(graph)
    drums = [ratio * turning for ratio in (2, 3, 6)]
    forces = tuple(-(graph.symbol("K") * drum) for drum in drums)
    return Motion((turning, *drums), forces, derivation.space.guards)


def register(
    monkeypatch: pytest.MonkeyPatch, quantities: tuple[str, ...], method: Method, use: Use = Use.CHOSEN
) -> None:
    monkeypatch.setattr(table, "METHODS", (*METHODS, MethodRow(NAME, quantities, lambda: method, use)))


def taken(selection: Selection) -> dict[str, str]:
    return {choice.quantity: choice.method or choice.title for choice in selection.choices}


def same(one: Selection, other: Selection) -> bool:
    """At a state that the gears allow."""
    ratios = {"a": 1, "b": 2, "c": 3, "d": 6}
    point = {f"{name}{dots}": 0.4 * ratio for name, ratio in ratios.items() for dots in ("", "_dot", "_ddot")}
    point |= {"T": 1.7, "J": 0.2, "K": 0.7}
    values = [[x for q in selection.quantities for x in Evaluator(q.outputs)(point)] for selection in (one, other)]
    return values[0] == pytest.approx(values[1], rel=1e-12)


def test_a_new_method_of_u_is_chosen_where_it_counts_least(drums: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    before = derive_quantities(drums, drums.outputs)
    register(monkeypatch, (INPUTS,), OfInputs(of_one_wheel))
    after = derive_quantities(drums, drums.outputs)
    assert taken(after) == taken(before) | {INPUTS: NAME}
    assert after.method_of_u is not None
    assert after.method_of_u.validity.admitted
    assert same(before, after)


@pytest.mark.parametrize(("solved", "beginning"), [(over_angle, FAILS), (longer, "not examined")])
def test_one_that_is_singular_or_longer_is_not(
    solved: Callable[[Workspace], Candidate | str], beginning: str, drums: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = derive_quantities(drums, (INPUTS,))
    register(monkeypatch, (INPUTS,), OfInputs(solved))
    after = derive_quantities(drums, (INPUTS,))
    assert taken(after) == taken(before)
    assert after.method_of_u is not None
    (remark,) = (remark for name, _, remark in after.method_of_u.others if name == NAME)
    assert remark.startswith(beginning)


def test_a_new_method_of_motion_is_chosen_where_it_counts_least(drums: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    before = derive_quantities(drums, drums.outputs)
    method = AlongNullSpace(motion_of_one_wheel, "it divides by an inertia", offered=lambda _: True)
    register(monkeypatch, MOTIONS, method)
    after = derive_quantities(drums, drums.outputs)
    assert taken(after) == taken(before) | dict.fromkeys(MOTIONS, NAME)
    assert same(before, after)


def test_fallback_and_names_find_it_in_the_table(drums: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    choice = derive_quantities(drums, (INPUTS,)).choices[0]
    generic = genericity(System(drums))
    assert Alternatives(drums, generic, None).named(INPUTS, NAME) is None
    register(monkeypatch, (INPUTS,), OfInputs(of_one_wheel), Use.SPARE)
    assert derive_quantities(drums, (INPUTS,)).choices[0] == choice
    others = Alternatives(drums, generic, None).of(INPUTS, choice, 0)
    assert others[0].choice.title == NAME
    decision = Methods(drums, generic).choose(INPUTS, NAME)
    assert not isinstance(decision, str)
    assert decision[1].name == NAME
    # a comparison is there for those who ask, and for nobody else
    register(monkeypatch, (INPUTS,), OfInputs(of_one_wheel), Use.COMPARISON)
    tiers = [Alternatives(drums, generic, None).of(INPUTS, choice, tier) for tier in (0, 1)]
    assert NAME not in {one.choice.title for alternatives in tiers for one in alternatives}


def test_every_row_leads_to_a_method_with_a_name_of_its_own() -> None:
    names = [(quantity, row.name) for row in METHODS for quantity in row.quantities]
    assert len(set(names)) == len(names)
    for row in METHODS:
        method = row.load()
        assert callable(method.build)
        assert callable(method.validity)
        assert callable(method.least_cost)
    assert {quantity for row in METHODS for quantity in row.quantities} > set(NAMED)
