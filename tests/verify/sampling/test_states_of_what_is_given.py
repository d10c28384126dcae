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

# Two loops of which one is closed twice, its rows a million apart, and more encoders than it takes.
TWICE = """
model: twice
coordinates: {a: {}, b: {}, c: {}, d: {}, e: {}}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + e_dot**2
constraints:
  geometric:
    east: 0.5*cos(a) + 0.9*cos(a + b) + 0.6*cos(a + b + c) - 0.65
    north: 250*(0.5*sin(a) + 0.9*sin(a + b) + 0.6*sin(a + b + c) + 0.2)
    tip_east: 0.5*cos(a) + 0.9*cos(a + b) + 0.6*cos(a + b + d) + 0.2*cos(a + b + d + e) - 1.5
    tip_north: 1e6*(0.5*sin(a) + 0.9*sin(a + b) + 0.6*sin(a + b + d) + 0.2*sin(a + b + d + e) - 0.2)
    again: 2*(0.5*cos(a) + 0.9*cos(a + b) + 0.6*cos(a + b + d) + 0.2*cos(a + b + d + e) - 1.5)
measured: [c, d]
outputs: [configuration_from_measured]
configuration: {a: -0.86, b: 1.89, c: -2.81, d: -1.27, e: -0.48}
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


def test_steps_end_where_rows_in_units_far_apart_round_them() -> None:
    reference = Reference(load_text(TWICE, "twice.yaml"))
    for sample in sample_states(reference, ("configuration_from_measured",), 8):
        (solved,) = reference.evaluate(sample.state, ("configuration_from_measured",)).values()
        residual, _ = reference.system.geometry(solved, [], reference.literals())
        rows = zip(residual.entries(), (1, 250, 1, 1e6, 2), strict=True)
        assert all(abs(float(row)) < 1e-14 * size for row, size in rows)
