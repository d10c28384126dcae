"""States at which what is measured determines the rest: beside its singularities kernels have a status."""

from __future__ import annotations

from math import pi, sin

import pytest

from symgen.model.load import load_text
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.modes import modes
from symgen.verify.sampling.states import sample_states

# A Sarrus linkage: with its second leg folded, k_1 = pi, the foot of that leg turns and its knee stands still.
SARRUS = """
model: sarrus
gravity: [0, 0, -9.81]
frames:
  end: {parent: knee_1, translation: [0, 0, 1.1]}
  dock: {parent: platform, translation: [-0.84, 0.84, 0]}
joints:
  foot_0: {type: revolute, axis: x, at: [0, -0.84, 0], coordinate: p_0}
  knee_0: {type: revolute, axis: x, parent: foot_0, at: [0, 0, 1.1], coordinate: k_0}
  platform: {type: revolute, axis: x, parent: knee_0, at: [0, 0, 1.1], coordinate: e}
  foot_1: {type: revolute, axis: y, at: [-0.84, 0, 0], coordinate: p_1}
  knee_1: {type: revolute, axis: y, parent: foot_1, at: [0, 0, 1.1], coordinate: k_1}
bodies:
  foot_0: {mass: 5.8, com: [0, 0, 0.55], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  knee_0: {mass: 1.4, com: [0, 0, 0.55], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  platform: {mass: 3, com: [0, 0.84, 0], inertia: {xx: 0.2, yy: 0.2, zz: 0.3}}
  foot_1: {mass: 4.4, com: [0, 0, 0.55], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  knee_1: {mass: 7.3, com: [0, 0, 0.55], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
loops:
  hinge: {type: revolute, between: [end, dock], axis: y}
inputs:
  u_1: {joint: p_1}
measured: [k_1]
outputs: [velocity_from_measured, configuration_from_measured]
"""


def _knees(quantity: str) -> list[float]:
    """The angles of the second knee in the states that a quantity is verified at."""
    reference = Reference(load_text(SARRUS, "sarrus.yaml"))
    samples = sample_states(reference, (quantity,), 64, modes=modes(reference))
    return [float(sample.state.q[4]) for sample in samples]


@pytest.mark.campaign
def test_states_on_a_branch_where_nothing_measured_moves_are_left_out() -> None:
    assert any(abs(sin(knee)) < 1e-9 for knee in _knees("inverse_dynamics"))
    assert all(abs(sin(knee)) > 1e-6 for knee in _knees("velocity_from_measured"))


def test_configurations_are_looked_for_where_newtons_method_goes_a_short_way() -> None:
    # at pi + 0.002 a move of half a thousandth leads 13 rad away, and back by 1.5 with the second step
    assert all(abs(knee - round(knee / pi) * pi) > 0.01 for knee in _knees("configuration_from_measured"))
