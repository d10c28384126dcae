"""What vanishes with parameters that are 0 is exactly 0 there, and what it was for others."""

from __future__ import annotations

import random
from functools import cache

import pytest

from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# A massless link at the end of an arm is stayed by a rod, which carries what the link's spring does: nothing for k = 0.
STAYED = """\
model: stayed
parameters: {g: {value: 9.81}, l: {value: 0.8}, d: {value: 0.3}, m: {value: 2}, k: {value: 0}, w: {value: 0}}
gravity: [0, g, 0]
joints:
  arm: {type: revolute, axis: [-1, 0, 0], coordinate: a}
  slide: {type: prismatic, parent: arm, at: [0, l, 0], axis: z, coordinate: s}
  link: {type: revolute, parent: slide, at: [0, l, 0], axis: x, coordinate: b}
bodies:
  arm: {mass: m, com: [0, l/2, 0], inertia: {xx: 0.2}}
rotor_inertias: {s: 0.3}
points: {tip: {frame: link, at: [0, d, 0]}, wall: {at: [0, 1.9, -1.5]}}
loops:
  stay: {type: distance, between: [tip, wall], length: 0.6}
  again: {type: distance, between: [tip, wall], length: 0.6}
potential_energy: k*cosh(b/2) + w*sin(b) + k*w*b
inputs: {u: {joint: a}}
outputs: [multipliers, forward_dynamics]
configuration: {a: 0.8, s: 0.3, b: 0.6}
"""
NAMES = ("a", "s", "b", "a_dot", "s_dot", "b_dot", "u")
VALUES = {"g": 9.81, "l": 0.8, "d": 0.3, "m": 2.0}


def multipliers(text: str, seed: int = 0, **parameters: float) -> list[float]:
    dice = random.Random(seed)
    point = {name: dice.uniform(0.2, 0.9) for name in NAMES}
    return list(evaluator(text)({**point, **VALUES, **parameters}))


@cache
def evaluator(text: str) -> Evaluator:
    (derived,) = derive_quantities(load_text(text, "stayed.yaml"), ("multipliers",)).quantities
    return Evaluator(list(derived.outputs))


def test_a_stay_that_carries_nothing_has_a_multiplier_of_0() -> None:
    # parameters that are 0 in one way of writing the file and not in the other
    text = STAYED.replace(" + k*w*b", "")
    other = text.replace("k: {value: 0}, w: {value: 0}", "k: {value: 3}, w: {value: 2}")
    off = {"k": 0.0, "w": 0.0}
    assert {x for seed in range(20) for x in multipliers(text, seed, **off)} == {0.0}
    left = {abs(x) for seed in range(20) for x in multipliers(other, seed, **off)}
    assert 0 < max(left) < 1e-14
    for values in ({"k": 2.0, "w": 0.0}, {"k": 0.0, "w": -0.7}, {"k": 1.1, "w": 0.4}):
        made, usual = multipliers(text, **values), multipliers(other, **values)
        assert made == pytest.approx(usual, rel=1e-10)
        assert min(map(abs, made)) > 1e-3


def test_what_is_not_linear_in_these_parameters_stays_as_it_is() -> None:
    """k and w multiplied: the derivative along them is twice that."""
    text = STAYED.replace("k*cosh(b/2) + w*sin(b) + ", "")
    other = text.replace("k: {value: 0}, w: {value: 0}", "k: {value: 3}, w: {value: 2}")
    values = {"k": 1.1, "w": 0.4}
    assert multipliers(text, **values) == pytest.approx(multipliers(other, **values), rel=1e-10)
