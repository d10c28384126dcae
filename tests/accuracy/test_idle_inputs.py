"""Inputs that load the constraints alone: what rounding leaves of them beside V answers to nothing."""

from __future__ import annotations

import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.model.load import load_text
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.tolerance import FACTOR

# On an arm a slim triangle of three bars turns as one, and a drive between two of its bars moves nothing.
TRIANGLE = """
model: triangle
joints:
  arm: {type: revolute, axis: z, coordinate: a}
  bar: {type: revolute, axis: z, parent: arm, at: [0.6, 0, 0], coordinate: b}
  rod: {type: revolute, axis: z, parent: arm, at: [0.6, 0, 0], coordinate: c}
  link: {type: revolute, axis: z, parent: bar, at: [0.7, 0, 0], coordinate: e}
bodies:
  arm: {mass: 0.3, com: [0.3, 0, 0], inertia: {zz: 0.01}}
  bar: {mass: 900, com: [0.35, 0, 0], inertia: {zz: 0.5}}
  rod: {mass: 2.1, com: [0.3, 0, 0], inertia: {zz: 0.02}}
  link: {mass: 0.4, com: [0.1, 0, 0], inertia: {zz: 0.003}}
points:
  tip: {frame: rod, at: [0.50003, 0, 0]}
  end: {frame: link, at: [0.2, 0, 0]}
loops:
  pin: {type: point, between: [tip, end]}
gravity: [0, -9.81, 0]
inputs:
  turn: {joint: a}
  press: {joint: e}
outputs: [inverse_dynamics]
configuration: {a: 0.4, b: 0.3, c: 0.4, e: 2.8}
"""


@pytest.mark.parametrize("allocation", ["", "allocation: {weights: {press: 3}, preload: {turn: 5}}\n"])
def test_u_keeps_its_digits_beside_an_input_that_moves_nothing(allocation: str) -> None:
    model = load_text(TRIANGLE + allocation, "triangle.yaml")
    draft = draft_of(model, model.outputs, Options())
    program = draft.programs["float64"]
    expected = Expected(model, model.outputs, 32, lambda _: None)
    samples, worst = expected.samples("float64"), []
    for sample, values in zip(samples, expected.values("float64"), strict=True):
        (outcome,) = outcomes(program.kernels[0], program.sincos, "float64", [sample.state])
        truth = values["inverse_dynamics"]
        worst.append(truth.in_units(truth.distance(outcome.entries)) if outcome.valid else FACTOR)
    assert max(worst) <= FACTOR / 2
