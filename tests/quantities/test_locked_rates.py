"""What vanishes where locked coordinates are at rest is exactly 0 there, and what it was beside."""

from __future__ import annotations

import random
from functools import cache

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.load import load_text
from symgen.quantities.locked_rates import vanishing_with_locked_rates
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# Two links of an arm are locked, and weight does no work along its one turn, about the vertical.
MODEL = """\
model: turning
parameters: {m: {value: 1.7}}
gravity: [0, 9.81, 0]
joints:
  post: {type: revolute, axis: y, coordinate: a}
  arm: {type: revolute, parent: post, at: [0.3, 0.88, 0.1], axis: [1, 1, 0], coordinate: b}
  hand: {type: revolute, parent: arm, at: [0.2, 0.5, 0], axis: z, coordinate: c}
bodies:
  post: {mass: 3.9, com: [0.2, 0.1, 0.3], inertia: {xx: 0.07, yy: 0.09, zz: 0.1}}
  arm: {mass: 2.3, com: [0.1, 0.3, 0.25], inertia: {xx: 0.03, yy: 0.04, zz: 0.05}}
  hand: {mass: m, com: [0.1, 0.2, 0.4], inertia: {xx: 0.04, yy: 0.06, zz: 0.05, xz: 0.002}}
constraints:
  geometric:
    first: sin(b) + 0.3*sin(c) - 0.4
    second: cos(c) + 0.2*cos(b) - 1
inputs: {u: {joint: a}}
outputs: [forward_dynamics]
"""
LOCKED = ("b_dot", "c_dot")
NAMES = ("a", "b", "c", "a_dot", "u", "m", *LOCKED)


@cache
def quantity(text: str) -> Quantity:
    (derived,) = derive_quantities(load_text(text, "turning.yaml"), ("forward_dynamics",)).quantities
    return derived


def accelerations(text: str, seed: int, **values: float) -> list[float]:
    dice = random.Random(seed)
    point = {name: dice.uniform(0.2, 0.9) for name in NAMES} | values
    return list(Evaluator(list(quantity(text).outputs))(point))


def test_an_acceleration_is_0_where_nothing_but_locked_rates_would_make_it() -> None:
    still = dict.fromkeys(LOCKED, 0.0)
    assert {accelerations(MODEL, seed, u=0.0, **still)[0] for seed in range(20)} != {0.0}, "the input turns the post"
    driven = MODEL.replace("{joint: a}", "{joint: c}")
    assert {tuple(accelerations(driven, seed, **still)) for seed in range(20)} == {(0.0, 0.0, 0.0)}


def test_what_locked_rates_would_make_of_it_stays() -> None:
    driven = MODEL.replace("{joint: a}", "{joint: c}")
    for seed in range(5):
        # the same motion of a post that is driven, which leaves nothing out
        expected = accelerations(MODEL, seed, u=0.0)
        assert expected[0] != 0
        assert accelerations(driven, seed) == pytest.approx(expected, rel=1e-12, abs=1e-14)


def test_nothing_changes_where_nothing_vanishes() -> None:
    model = load_text(MODEL, "turning.yaml")
    mechanics = System(model)
    derived = derive_quantities(model, ("inverse_dynamics",)).quantities[0]
    assert vanishing_with_locked_rates(mechanics, genericity(mechanics), derived) == derived
