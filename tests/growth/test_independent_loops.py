"""Loops that share no coordinate: what is asked of one is asked of one, and tests of one do not hold the others."""

from __future__ import annotations

from decimal import Decimal
from functools import partial
from itertools import pairwise
from typing import Any

import pytest
from counted import calls

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.validity.search import ZeroSearch, symbols
from symgen.verify.reference import evaluation as reference_evaluation
from symgen.verify.reference.arithmetic import linear as reference_linear
from symgen.verify.reference.arithmetic.linear import solve
from symgen.verify.reference.configurations import closing as reference_closing
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states


def sliders(count: int) -> Model:
    """Cranks on a common axle, each with a rod and a slider of its own; rods slide on pins that hold them."""
    coordinates, energy, rows, inputs = [], [], [], []
    for k in range(count):
        a, s, x = f"a{k}", f"s{k}", f"x{k}"
        coordinates += [f"  {a}: {{unit: rad, range: [0.3, 1.2]}}", f"  {s}: {{unit: rad}}", f"  {x}: {{unit: m}}"]
        energy.append(f"J*{a}_dot**2/2 + m*l**2*{s}_dot**2/6 + m*(1 + {k}/10)*{x}_dot**2/2")
        rows += [f"    along{k}: r*cos({a}) + l*cos({s}) - {x}", f"    across{k}: r*sin({a}) - l*sin({s})"]
        inputs.append(f"  u{k}: {{acts_on: {{{x}: 1}}}}")
    text = "\n".join(
        [
            "model: sliders",
            "coordinates:",
            *coordinates,
            "parameters: {r: {value: 0.2, unit: m}, l: {value: 0.7, unit: m}, m: {value: 2, unit: kg}, J: 0.3}",
            "kinetic_energy: " + " + ".join(energy),
            "constraints:",
            "  geometric:",
            *rows,
            "inputs:",
            *inputs,
            "configuration: {" + ", ".join(f"a{k}: 0.8, s{k}: 0.2, x{k}: 0.8" for k in range(count)) + "}",
            "",
        ]
    )
    return load_text(text, "sliders.yaml")


def test_each_loop_has_a_test_of_its_own() -> None:
    model = sliders(3)
    made = Methods(model, genericity(System(model))).candidate(INPUTS, "nullspace")
    assert isinstance(made, Candidate)
    held = [symbols([guard.denominator]) for guard in made.derived.guards]
    assert len(held) == 3
    moving = [{name for name in names if name[0] in "asx"} for names in held]
    assert all(moving)
    assert all(not one & other for one, other in pairwise(moving))
    # and so have the inputs
    for k, output in enumerate(made.derived.outputs):
        assert {name[-1] for name in moving[k]} == {str(k)}
        assert not any(name in symbols([output]) for other in moving[:k] + moving[k + 1 :] for name in other)


def test_zeros_are_looked_for_where_the_scalar_is() -> None:
    model = sliders(4)
    mechanics = System(model)
    graph, search = mechanics.graph, ZeroSearch(mechanics, genericity(mechanics))
    assert search.zero_of(graph.symbol("x2") + 5) is None
    zero = search.zero_of(graph.trig("sin", graph.symbol("s1")) - graph.const(1) / 10)
    assert zero is not None
    point = dict(zero.point)
    # a zero is told with all loops closed
    assert all(abs(point[f"x{k}"]) > Decimal("0.2") for k in range(4))


def test_twice_the_loops_are_a_few_times_the_work() -> None:
    def looked_for(count: int) -> None:
        mechanics = System(model := sliders(count))
        search = ZeroSearch(mechanics, genericity(System(model)))
        for k in range(count):
            assert search.zero_of(mechanics.graph.symbol(f"x{k}") + 5) is None

    few, many = (calls(lambda n=n: looked_for(n), 20_000_000) for n in (3, 6))  # type: ignore[misc]
    assert many <= 3 * few


def test_forces_of_twice_the_loops_are_a_few_times_the_work() -> None:
    def forces(model: Model) -> None:
        mechanics = System(model)
        assert not any(force.is_zero for force in mechanics.balance)

    few, many = (calls(partial(forces, sliders(n)), 20_000_000) for n in (6, 12))
    assert many <= 2.6 * few


@pytest.mark.campaign
def test_states_of_twice_the_loops_are_a_few_times_the_work() -> None:
    """Loops that lead elsewhere are started anew alone: that all of them are regular at once is rare."""

    def looked_for(reference: Reference) -> None:
        assert len(sample_states(reference, ["inverse_dynamics"], 16)) == 16

    few, many = (calls(partial(looked_for, Reference(sliders(n))), 20_000_000) for n in (6, 12))
    assert many <= 2.3 * few


def test_the_reference_solves_nothing_larger_than_a_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes: list[int] = []

    def noted(matrix: Any, right: Any) -> Any:
        sizes.append(matrix.nrows())
        return solve(matrix, right)

    def stepped(residual: Any, jacobian: Any, damping: float) -> Any:
        sizes.append(jacobian.nrows())
        return step(residual, jacobian, damping)

    for module in (reference_evaluation, reference_linear):
        monkeypatch.setattr(module, "solve", noted)
    step = reference_closing._step
    monkeypatch.setattr(reference_closing, "_step", stepped)
    reference = Reference(sliders(5))
    (sample, *_) = sample_states(reference, ["singularity"], 8)
    reference.precise(sample.state, ("inverse_dynamics", "forward_dynamics", "multipliers", "singularity"))
    assert max(sizes) == 3
    assert len(reference.system.parts) == 5
