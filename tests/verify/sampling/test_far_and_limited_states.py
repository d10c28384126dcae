"""States where few are: within limits that hardly any motion keeps, and not turns away from where a system is."""

from __future__ import annotations

from symgen.model.load import load_text
from symgen.verify.expected import Expected
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states

# The steering torque follows from the motion: motions at random hardly ever need 20 to 30 N m.
STEERED = """\
model: steered
coordinates: {x: {unit: m}, steer: {unit: rad}}
parameters: {mass: {value: 5, unit: kg}, inertia: {value: 0.02, unit: kg*m**2}}
kinetic_energy: mass/2*x_dot**2 + inertia/2*steer_dot**2
inputs: {left: {acts_on: {x: 1}}, right: {acts_on: {x: 1}}, third: {acts_on: {x: 2}}, turn: {acts_on: {steer: 1}}}
allocation: {limits: {turn: [20, 30], left: [-5, 5]}}
outputs: [inverse_dynamics, forward_dynamics]
"""
# An angle with a spring that does not turn with it: elsewhere its sine is the same, and its force 1e18 times as large.
WOUND = """\
model: wound
coordinates: {a: {unit: rad}, b: {}, c: {}}
parameters: {m: {value: 2}}
kinetic_energy: m/2*(a_dot**2 + b_dot**2 + c_dot**2)
potential_energy: 1e4*sinh(b/3)**2
constraints:
  geometric:
    x: 1.6 + 0.79*cos(b) + 0.94*cos(b + c) - 0.2474479363423222
    y: 0.79*sin(b) + 0.94*sin(b + c) + 0.38290950330960677
inputs: {u: {acts_on: {a: 1}}}
configuration: {a: 0.1, b: 2.73, c: 1.25}
"""


def states(text: str, quantity: str) -> Expected:
    return Expected(load_text(text, "model.yaml"), [quantity], 64, lambda _: None)


def test_motions_that_inputs_within_limits_make_are_states() -> None:
    expected = states(STEERED, "inverse_dynamics")
    assert len(expected.drawn) == 64
    torques = [0.02 * sample.state.qdd[1] for sample in expected.drawn]
    assert all(20 <= torque <= 30 for torque in torques)
    assert max(torques) - min(torques) > 5
    assert all(value["inverse_dynamics"].size > 20 for value in expected.values("float32"))


def test_no_state_is_turns_away() -> None:
    """Newton's method leads anywhere, be it an angle or what has a sine and more: with this seed 16 turns."""
    drawn = sample_states(Reference(load_text(WOUND, "model.yaml")), ["potential_force"], 64, seed=12)
    assert len(drawn) == 64
    assert max(abs(sample.state.q[1]) for sample in drawn) < 30
