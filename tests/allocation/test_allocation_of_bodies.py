"""Inputs on frames share their work like others: a plate pulled at three points along two directions and turned."""

from __future__ import annotations

import pytest
from laws_harness import System

from symgen.ir.kernel import Status
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

PLATE = """\
model: pulled
coordinates: {x: {unit: m}, y: {unit: m}, a: {unit: rad}}
parameters: {m: {value: 2, unit: kg}, J: {value: 0.3, unit: kg*m**2}, l: {value: 0.4, unit: m}}
frames: {plate: {parent: world, translation: [x, y, 0], rotation: [[z, a]]}}
bodies: {plate: {mass: m, inertia: {zz: J}}}
points:
  left: {frame: plate, at: [-l, 0, 0]}
  right: {frame: plate, at: [l, 0, 0]}
inputs:
  up: {unit: N, point: left, direction: [0, 1, 0], axes: plate}
  down: {unit: N, point: right, direction: [0, 1, 0], axes: plate}
  east: {unit: N, point: right, direction: [1, 0, 0], axes: plate}
  turn: {unit: N*m, joint: a}
allocation: {weights: {turn: 9}, preload: 0.3, limits: {up: [-1, 1], turn: [-0.1, 0.1]}}
"""


def test_inputs_at_points() -> None:
    made = System(PLATE, ("inverse_dynamics",))
    for sample in sample_states(made.reference, ["inverse_dynamics"], 8):
        status, u = made.run("inverse_dynamics", sample.state)
        assert status is Status.OK
        expected = expectations(made.reference, sample.state, ["inverse_dynamics"], "float64", "bodies")
        expectation = expected["inverse_dynamics"]
        assert expectation.in_units(expectation.distance(u)) <= FACTOR


def test_points_count_as_inputs_in_the_check() -> None:
    three = PLATE.replace("  east: {unit: N, point: right, direction: [1, 0, 0], axes: plate}\n", "")
    with pytest.raises(Exception, match="the inputs reach 2 of δ = 3 directions of motion"):
        System(three, ("inverse_dynamics",))
