"""Every kind of input against virtual power by places alone: a column of M is what its force does to q.

Slopes are differences over 2^-200 at 600 bits, exact far beyond a float64.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import flint
import numpy as np
import pytest

from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.reference import Reference, State

TEXT = """\
model: crane
joints:
  mast: {type: revolute, axis: z, coordinate: a}
  boom: {type: revolute, parent: mast, at: [0, 0, 1], axis: y, rotation: [[x, 0.1]], coordinate: b}
  trolley: {type: prismatic, parent: boom, axis: x, coordinate: s}
bodies:
  mast: {mass: 3, inertia: {xx: 1, yy: 1, zz: 1}}
  boom: {mass: 2, com: [0.4, 0, 0], inertia: {xx: 0.2, yy: 0.3, zz: 0.3}}
  trolley: {mass: 1, inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
gravity: [0, 0, -9.81]
points:
  hook: {frame: trolley, at: [0.2, 0.1, -0.3]}
  pulley: {frame: mast, at: [0.1, 0, 1.4]}
  bollard: {at: [1, 0.5, 0]}
  # the axes of the boom, as points at distance 1 from its origin
  boom_o: {frame: boom}
  boom_x: {frame: boom, at: [1, 0, 0]}
  boom_y: {frame: boom, at: [0, 1, 0]}
  boom_z: {frame: boom, at: [0, 0, 1]}
inputs:
  in_the_joint: {unit: N*m, joint: b}
  by_coefficients: {unit: N, acts_on: {s: cos(b), a: s}}
  at_a_point: {unit: N, point: hook, direction: [0.6, 0, 0.8]}
  in_the_axes_of_a_body: {unit: N, point: hook, direction: [0, 0.6, -0.8], axes: boom}
  between_points: {unit: N, point: hook, direction: [0, 1, 0], axes: boom, reaction: pulley}
  along_a_cable: {unit: N, cable: [hook, pulley, bollard]}
  torque: {unit: N*m, torque_on: boom, direction: [0, 0.8, 0.6]}
  torque_between_bodies: {unit: N*m, torque_on: boom, direction: [0, 1, 0], axes: boom, reaction: mast}
outputs: [control_matrix, point_position]
"""
Q = (0.4, 0.3, 0.5)
BITS, STEP = 600, flint.arb(2) ** -200
EXACT = {"rel": 1e-14, "abs": 1e-15}


@cache
def crane() -> Reference:
    return Reference(load_text(TEXT, "crane.yaml"))


def places(q: tuple[Any, ...]) -> dict[str, np.ndarray]:
    """The points at a configuration, as balls."""
    zero = (0,) * 3
    state = State(q, zero, zero, (0,) * 8, ())
    rows = crane().matrices(state, ["point_position"], BITS)["point_position"].tolist()
    return {point.name: np.array(row) for point, row in zip(crane().model.mechanism.points, rows, strict=True)}


def column(name: str) -> np.ndarray:
    """The input's column of the control matrix."""
    zero = (0,) * 3
    matrix = crane().matrices(State(Q, zero, zero, (0,) * 8, ()), ["control_matrix"])["control_matrix"]
    k = [one.name for one in crane().model.inputs].index(name)
    return np.array([float(matrix[i, k]) for i in range(3)])


def slopes(of: Callable[[tuple[Any, ...]], Any]) -> np.ndarray:
    """Derivatives by q of what places make, in columns."""
    with precision(BITS):
        moved = [[tuple(x + side * STEP * (k == i) for k, x in enumerate(Q)) for side in (1, -1)] for i in range(3)]
        made = [np.atleast_1d((of(there) - of(here)) / (2 * STEP)) for there, here in moved]
    return np.array([floats(one) for one in made]).T


def floats(balls: np.ndarray) -> np.ndarray:
    return np.array([float(x.mid()) for x in balls.ravel()]).reshape(balls.shape)


def slope(point: str) -> np.ndarray:
    """d place / d q (3 x 3)."""
    return slopes(lambda q: places(q)[point])


def boom_axes(q: tuple[Any, ...] = Q) -> np.ndarray:
    """The matrix of the boom's axes in those of the world, as balls."""
    at = places(q)
    return np.array([at[f"boom_{axis}"] - at["boom_o"] for axis in "xyz"]).T


def turning(of: int) -> np.ndarray:
    """The boom's rate of turn, in world axes, per rate of a coordinate: the skew part of R' R^T."""
    rates = slopes(lambda q: boom_axes(q).ravel())[:, of].reshape(3, 3)
    skew = rates @ floats(boom_axes()).T
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def test_in_a_joint_and_by_coefficients() -> None:
    assert column("in_the_joint").tolist() == [0, 1, 0]
    assert column("by_coefficients") == pytest.approx([0.5, 0, math.cos(0.3)])


def test_forces_at_points() -> None:
    assert column("at_a_point") == pytest.approx(slope("hook").T @ [0.6, 0, 0.8], **EXACT)
    direction = floats(boom_axes()) @ [0, 0.6, -0.8]
    assert column("in_the_axes_of_a_body") == pytest.approx(slope("hook").T @ direction, **EXACT)


def test_a_force_between_points_is_equal_and_opposite() -> None:
    direction = floats(boom_axes()) @ [0, 1, 0]
    assert column("between_points") == pytest.approx((slope("hook") - slope("pulley")).T @ direction, **EXACT)


def test_a_cable_pulls_its_points_together() -> None:
    def length(q: tuple[Any, ...]) -> Any:
        at = places(q)
        ends = (at["hook"] - at["pulley"], at["pulley"] - at["bollard"])
        return sum(sum(end * end).sqrt() for end in ends)

    assert column("along_a_cable") == pytest.approx(-slopes(length)[0], **EXACT)


def test_torques() -> None:
    expected = [turning(i) @ [0, 0.8, 0.6] for i in range(3)]
    assert column("torque") == pytest.approx(expected, **EXACT)
    # about the hinge between the two bodies it is the torque in that joint
    assert column("torque_between_bodies") == pytest.approx([0, 1, 0], abs=1e-15)
