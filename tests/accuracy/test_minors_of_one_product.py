"""Dependent rows whose minors are one product: a knee that is nearly stretched costs no digits."""

from __future__ import annotations

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.model.load import load_text
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.tolerance import FACTOR, expectations

# The second row says what the loop says along y; the drive of the slide works through the sine of the knee.
PRESS = """
model: press
joints:
  slide: {type: prismatic, axis: x, coordinate: s}
  arm: {type: revolute, parent: slide, at: [0, 0.17, 0], axis: z, coordinate: a}
  rod: {type: revolute, parent: arm, at: [0, 0.31, 0], axis: z, coordinate: b}
bodies:
  slide: {mass: 2}
  arm: {mass: 3, com: [0, 0.15, 0], inertia: {zz: 0.02}}
  rod: {mass: 4, com: [0, 0.6, 0], inertia: {zz: 0.3}}
points:
  tip: {frame: rod, at: [0, 1.3, 0]}
  pin: {at: [1.1, 0.9, 0]}
loops:
  shut: {type: point, between: [tip, pin]}
constraints:
  geometric:
    again: 3*(tip.y - pin.y)
gravity: [0, -9.81, 0]
inputs:
  push: {joint: s}
outputs: [inverse_dynamics]
configuration: {s: 0.1, a: -1.0, b: 0.1}
"""


def test_u_keeps_its_digits_beside_a_stretched_knee_of_dependent_rows() -> None:
    model = load_text(PRESS, "press.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    reference = Reference(model)
    for exponent in range(1, 7):
        state = State((0.1, -1.0, 10.0**-exponent), (0.2, -0.7, 0.4), (1.3, 0.6, -2.1), (1.0,), ())
        truth = expectations(reference, state, ["inverse_dynamics"], "float64", "press")["inverse_dynamics"]
        (outcome,) = outcomes(program.kernels[0], program.sincos, "float64", [state])
        assert outcome.valid
        assert truth.in_units(truth.distance(outcome.entries)) <= FACTOR / 2
