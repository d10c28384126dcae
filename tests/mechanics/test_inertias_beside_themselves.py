"""What a pivot of articulated inertias is tested beside: the inertia about the same axis, however thin a rod is."""

from __future__ import annotations

import random

import pytest

from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator

RODS = """model: rods
parameters: {m: 0.4, J: 0.02, I: 1e-9, l: 0.8}
joints:
  one: {type: spherical, coordinates: [a_0, a_1, a_2, a_3]}
  two: {type: floating, coordinates: [x, y, z, b_0, b_1, b_2, b_3]}
  spin: {type: revolute, parent: one, at: [0, 0, l], axis: z, coordinate: c}
  turn: {type: revolute, at: [0, 0, 1], axis: [0, 0.6, 0.8], coordinate: d}
bodies:
  one: {mass: m, com: [0, 0, -l/2], inertia: {xx: J, yy: J, zz: I}}
  two: {mass: m, com: [0, 0, l/3], inertia: {xx: J, yy: J, zz: I}}
  spin: {mass: m, com: [0, 0, l], inertia: {xx: J, yy: J, zz: I}}
  turn: {mass: m, com: [0, 0.06, 0.08], inertia: {xx: J, yy: J/3, zz: J/2}}
gravity: [0, 0, -9.81]
"""
ARM = """model: arm
parameters: {m: 2, J: 0.3, l: 0.5}
joints:
  a: {type: revolute, axis: z, coordinate: q_1}
  b: {type: revolute, parent: a, at: [0.1, 0.2, l], rotation: [[x, pi/2]], axis: z, coordinate: q_2}
  c: {type: prismatic, parent: b, at: [l, 0, 0], axis: [1, 2, 2], coordinate: q_3}
  d: {type: revolute, parent: c, rotation: [[y, 0.4]], at: [0, 0.1, 0.2], axis: [1, 1, 0], coordinate: q_4}
bodies:
  b: {mass: m, com: [l/2, 0.1, 0], inertia: {xx: J/9, yy: J, zz: J, xy: J/20}}
  c: {mass: m, com: [0, -0.2, 0.1], inertia: {xx: J, yy: J/5, zz: J}}
  d: {mass: m/9, com: [0.1, 0.2, 0.3], inertia: {xx: J/7, yy: J/6, zz: J/5, yz: J/30}}
gravity: [0, 0, -9.81]
"""


def _shares(text: str) -> list[list[float]]:
    """At random states: pivots beside what they are tested beside."""
    model = load_text(text, "rods.yaml")
    mechanics = System(model)
    guards = ArticulatedFactor(mechanics.bodies).guards
    scales = [guard.scale for guard in guards if guard.scale is not None]
    values = Evaluator([*(guard.denominator for guard in guards), *scales])
    assert len(scales) == len(guards)
    source = random.Random(3)
    shares = []
    for _ in range(20):
        point = dict(parameter_values(mechanics))
        point |= {c.name: source.uniform(0.2, 0.9) for c in model.coordinates}
        got = values(point)
        shares.append([a / b for a, b in zip(got[: len(guards)], got[len(guards) :], strict=True)])
    return shares


def test_a_rod_a_million_times_thinner_than_long_resists_a_turn_about_itself() -> None:
    """Both rods on one axis: half of what turns about it is freed by the joint between them."""
    assert min(min(shares) for shares in _shares(RODS)) > 0.1


@pytest.mark.parametrize("text", [RODS, ARM], ids=["rods", "arm"])
def test_no_pivot_is_beyond_what_it_is_made_of(text: str) -> None:
    """Up to the three products that a direction across axes adds."""
    assert max(max(shares) for shares in _shares(text)) <= 3
