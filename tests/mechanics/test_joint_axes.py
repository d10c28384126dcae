"""Bodies that turn about oblique axes, in axes of which that axis is one."""

from __future__ import annotations

import random

import numpy as np
import pytest

from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor
from symgen.mechanics.rigid_bodies.bodies import Bodies
from symgen.mechanics.rigid_bodies.joint_axes import along_joints
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached

# A base with a slide that turns, and with an arm that has a fixed bracket, another frame and a ball joint on it.
TREE = """model: tree
parameters:
  l: {value: 0.4}
  I: {value: 0.03}
  m: {value: 2}
  k: {value: 5}
joints:
  base: {type: revolute, axis: [0, 1, 1], coordinate: b}
  slide: {type: cylindrical, parent: base, at: [0.1, l, 0], axis: [1, -2, 2], coordinates: [s, r]}
  arm: {type: revolute, parent: base, at: [l, 0.2, -0.1], axis: [-3, 1, 2], rotation: [[x, pi/4]], coordinate: a}
  hand: {type: revolute, parent: arm, at: [0, l, 0.3], axis: [-3, 1, 2], coordinate: h}
  ball: {type: spherical, parent: arm, at: [l, 0, 0.1], coordinates: [e_0, e_1, e_2, e_3]}
frames:
  bracket: {parent: arm, translation: [0.05, 0, l/2], rotation: [[y, 0.3]]}
bodies:
  base: {mass: 3, com: [0.1, 0, 0], inertia: {zz: 0.2}}
  slide: {mass: m, com: [0, l/2, 0.1], inertia: {xx: I, yy: I, zz: I}}
  arm: {mass: 1, com: [l, 0, l], inertia: {xx: I, yy: 0.05, zz: 0.04, xy: 0.002, xz: -0.003, yz: 0.001}}
rotor_inertias: {h: 0.1}
points:
  tip: {frame: arm, at: [l, 0.1, 0.2]}
  grip: {frame: bracket, at: [0, 0, 0.1]}
kinetic_energy: 0.1*(e_0_dot**2 + e_1_dot**2 + e_2_dot**2 + e_3_dot**2)
potential_energy: k*tip.x**2
inputs: {u_1: {joint: b}}
gravity: [0, 0, -9.81]
outputs: [forward_dynamics]
configuration: {e_0: 1}
"""

# A wheel about an oblique axis, on a base that turns about another one.
WHEEL = """model: wheel
joints:
  base: {type: revolute, axis: [0, 1, 1], coordinate: b}
  wheel: {type: revolute, parent: base, at: [0.3, 0.1, 0], axis: [0.7, -0.3, 1.1], coordinate: w}
bodies:
  base: {mass: 3, com: [0.1, 0, 0.2], inertia: {xx: 0.1, yy: 0.3, zz: 0.2}}
  wheel: {mass: 1.4, com: COM, inertia: {xx: 0.021, yy: 0.034, zz: 0.017, xy: 0.002}}
gravity: [0, 0, 0]
inputs: {u_1: {joint: b}}
outputs: [forward_dynamics]
"""


def _both() -> tuple[System, Bodies, Bodies]:
    model = load_text(TREE, "tree.yaml")
    system = System(model)
    plain = Bodies(model.mechanism, system.graph, system.names, system.q, system.qd)
    turned = Bodies(along_joints(model.mechanism), system.graph, system.names, system.q, system.qd)
    assert plain.mechanism != turned.mechanism
    return system, plain, turned


def _values(scalars: list[Scalar], seed: int) -> np.ndarray:
    names = sorted(str(node.payload) for node in reached(scalars) if node.op == "symbol")
    point = {name: random.Random(f"{seed} {name}").uniform(0.2, 0.9) for name in names}
    return np.array(Evaluator(scalars)(point))


@pytest.mark.parametrize("frame", ["base", "slide", "arm", "hand", "bracket", "ball"])
def test_frames_of_the_model_are_where_they_were(frame: str) -> None:
    _, plain, turned = _both()
    poses = []
    for bodies in (plain, turned):
        kinematics = bodies.kinematics
        rows, twist = kinematics.axes(frame), kinematics.twist(frame)
        poses.append([*kinematics.origin(frame), *(x for row in rows for x in row), *twist.angular, *twist.linear])
    assert _values(poses[1], 1) == pytest.approx(_values(poses[0], 1), abs=1e-13)


def test_points_and_energies_are_what_they_were() -> None:
    _, plain, turned = _both()
    scalars = [
        [
            bodies.kinetic_energy,
            bodies.potential_energy,
            *(x for point in ("tip", "grip") for x in (*bodies.kinematics.position(point),)),
            *(x for point in ("tip", "grip") for x in (*bodies.kinematics.velocity(point),)),
        ]
        for bodies in (plain, turned)
    ]
    for seed in range(3):
        assert _values(scalars[1], seed) == pytest.approx(_values(scalars[0], seed), rel=1e-13, abs=1e-14)
    exact = ExactValues(signs=False)([a - b for a, b in zip(*scalars, strict=True)])
    assert not any(exact)


def test_what_hangs_on_a_body_keeps_it_in_its_own_axes() -> None:
    _, _, turned = _both()
    assert {body.frame for body in turned.mechanism.bodies} & {"base", "slide", "arm"} == {"base"}


def test_an_equal_inertia_about_all_axes_stays_one() -> None:
    _, plain, turned = _both()
    assert turned.inertia("slide") == plain.inertia("slide")


def test_main_axes_change_nothing() -> None:
    text = WHEEL.replace("[0, 1, 1]", "y").replace("[0.7, -0.3, 1.1]", "[0, 0, -1]").replace("COM", "[0, 0, 0]")
    mechanism = load_text(text, "wheel.yaml").mechanism
    assert along_joints(mechanism) is mechanism


@pytest.mark.parametrize("com", ["[0, 0, 0]", "[0.14, -0.06, 0.22]"])
def test_a_wheel_on_a_base_that_rests_has_no_bias_force(com: str) -> None:
    """e . (w x I w) of w along e is 0, and no rounding of it is left."""
    system = System(load_text(WHEEL.replace("COM", com), "wheel.yaml"))
    for place in range(8):
        point = {"b": 0.3, "w": 0.2 + place, "b_dot": 0.0, "w_dot": 1.7 + place / 7}
        base, wheel = Evaluator(system.coriolis_force)(point)
        assert base != 0
        assert wheel == 0


@pytest.mark.parametrize("com", ["[0, 0, 0]", "[0.02, -0.1, 0.05]"])
def test_articulated_inertias_meet_a_wheel_along_its_axis(com: str) -> None:
    """One direction is a unit one, along which nothing is taken off and added again."""
    factor = ArticulatedFactor(System(load_text(WHEEL.replace("COM", com), "wheel.yaml")).bodies)
    ((_, direction),) = next(own for name, own in factor.directions.items() if name.startswith("wheel ") and own)
    assert sorted((x.is_zero, x.is_one) for x in direction) == [(False, True)] + [(True, False)] * 5
