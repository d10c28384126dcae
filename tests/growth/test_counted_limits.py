"""Another method may take so much counted work and no more; what takes more is given up, and named."""

from __future__ import annotations

import pytest
from linkages import row_of_four_bars

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.quantities import alternatives
from symgen.quantities.alternatives import Alternatives
from symgen.quantities.candidates import ARTICULATED
from symgen.quantities.select import derive_quantities
from symgen.runtime import effort
from symgen.runtime.effort import SCALAR, TooLongError, at_most
from symgen.symbolic.graph import Graph


def tree(links: int) -> str:
    """A tail of uniform rods that hangs freely, turned in space."""
    lines = ["model: tail", "gravity: [0, 0, -9.81]", "joints:"]
    for k in range(links):
        parent = f", parent: j{k - 1}, at: [0, 0, -0.3]" if k else ""
        lines.append(f"  j{k}: {{type: revolute, axis: {'xy'[k % 2]}, coordinate: a{k}{parent}}}")
    lines.append("bodies:")
    rod = "{mass: 2, com: [0, 0, -0.15], inertia: {xx: 0.02, yy: 0.02, zz: 0.01}}"
    lines += [f"  j{k}: {rod}" for k in range(links)]
    return "\n".join([*lines, "outputs: [forward_dynamics]", ""])


def powers(graph: Graph, count: int) -> None:
    x = graph.symbol("x")
    for _ in range(count):
        x = x * x + 1


def test_work_beyond_a_limit_ends_and_what_comes_after_goes_on() -> None:
    graph = Graph()
    with at_most(100 * SCALAR):
        powers(graph, 20)
    with pytest.raises(TooLongError), at_most(100 * SCALAR):
        powers(graph, 1000)
    powers(graph, 1000)


def test_a_limit_is_never_wider_than_the_one_around_it() -> None:
    with pytest.raises(TooLongError), at_most(50 * SCALAR), at_most(10_000 * SCALAR):
        powers(Graph(), 1000)


def test_a_tree_is_not_derived_densely_for_longer_than_that_may_be_worth(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_text(tree(9), "tail.yaml")
    compared = derive_quantities(model, model.outputs)
    monkeypatch.setattr(effort, "FREE_SCALARS", 0)
    monkeypatch.setattr(effort, "SCALARS_AN_OPERATION", 3)
    alone = derive_quantities(model, model.outputs)
    (before,), (after,) = compared.choices, alone.choices
    assert before.title == after.title == ARTICULATED
    assert len(before.costs) == 2
    assert [title for title, _ in after.costs] == [ARTICULATED]
    # the same function, by its values in a field
    assert [x.value for x in alone.quantities[0].outputs] == [x.value for x in compared.quantities[0].outputs]


def test_methods_that_take_too_long_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    tail = "configuration: {a0: 1, a1: 1, a2: 1, b1: 0, b2: 0}"
    model = load_text(row_of_four_bars(2, ground="0.5", tail=tail), "row.yaml")
    choice = derive_quantities(model, ("inverse_dynamics",)).choices[0]
    free = Alternatives(model, genericity(System(model)), None)
    titles = [one.choice.title for one in free.of("inverse_dynamics", choice, 0)]
    assert titles
    assert not free.too_long
    monkeypatch.setattr(effort, "FREE_SCALARS", 1000)
    monkeypatch.setattr(effort, "SCALARS_AN_OPERATION", 1)
    short = Alternatives(model, genericity(System(model)), None)
    left = [one.choice.title for one in short.of("inverse_dynamics", choice, 0)]
    assert short.too_long["inverse_dynamics"]
    assert {*left, *short.too_long["inverse_dynamics"]} >= {*titles}


def test_of_long_methods_refined_ones_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are as long again: what loses digits there takes twice as many."""
    tail = "configuration: {a0: 1, a1: 1, a2: 1, b1: 0, b2: 0}"
    model = load_text(row_of_four_bars(2, ground="0.5", tail=tail), "row.yaml")
    choice = derive_quantities(model, ("multipliers",)).choices[0]
    refined = "schur_qr_refined"
    free = Alternatives(model, genericity(System(model)), None)
    assert refined in [one.choice.title for one in free.of("multipliers", choice, 0)]
    monkeypatch.setattr(alternatives, "LONGEST_OF_LAST_RESORT", 10)
    short = Alternatives(model, genericity(System(model)), None)
    left = [one.choice.title for one in short.of("multipliers", choice, 0)]
    assert left
    assert refined not in left
    assert refined in short.too_long["multipliers"]
    assert short.of("multipliers", choice, 1) == ()
