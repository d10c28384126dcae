"""Quaternions in every attitude: a body that tumbles knows nothing of where it points."""

from __future__ import annotations

from functools import cache
from itertools import product
from types import ModuleType

import numpy as np
import pytest
from generated_python import load_generated

from symgen.backends.python.module import emit_python
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.verify.reference.reference import Reference, State

TEXT = """\
model: tumbling
joints: {free: {type: floating, child: base, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}}
bodies: {base: {mass: 2, com: [0.1, -0.05, 0.2], inertia: {xx: 0.3, yy: 0.25, zz: 0.1, xy: 0.02, yz: -0.03}}}
gravity: [0, 0, 0]
inputs:
  f_x: {unit: N, point: base, direction: [1, 0, 0], axes: base}
  f_y: {unit: N, point: base, direction: [0, 1, 0], axes: base}
  f_z: {unit: N, point: base, direction: [0, 0, 1], axes: base}
  n_x: {unit: N*m, torque_on: base, direction: [1, 0, 0], axes: base}
  n_y: {unit: N*m, torque_on: base, direction: [0, 1, 0], axes: base}
  n_z: {unit: N*m, torque_on: base, direction: [0, 0, 1], axes: base}
outputs: [inverse_dynamics, forward_dynamics, singularity]
"""
VELOCITY, SPIN = np.array([0.3, -0.4, 0.2]), np.array([1.1, -0.7, 2.3])
U = np.array([1.0, -2.0, 0.5, 0.3, 0.1, -0.4])


@cache
def model() -> Model:
    return load_text(TEXT, "tumbling.yaml")


@pytest.fixture(scope="module")
def tumbling(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    # the method that is chosen by itself, without the search for a shorter one
    derived = derive_quantities(model(), model().outputs, {"inverse_dynamics": "minor"})
    files = emit_python(model(), schedule(derived.mechanics, derived.quantities, ("float64",))["float64"])
    (text,) = (text for name, text in files.items() if name.endswith("tumbling.py"))
    path = tmp_path_factory.mktemp("tumbling") / "tumbling.py"
    path.write_text(text, encoding="utf-8")
    return load_generated(path)


def attitudes() -> np.ndarray:
    """All turns of the cube and 400 at random, each with both signs of its quaternion."""
    corners = np.array(list(product((-1, 0, 1), repeat=4)), dtype=float)
    sizes = (np.abs(corners).sum(axis=1))[:, None]
    cube = corners[np.isin(sizes[:, 0], (1, 2, 4))]
    drawn = np.random.default_rng(3).normal(size=(400, 4))
    every = np.concatenate([cube, drawn])
    return np.asarray(every / np.linalg.norm(every, axis=1, keepdims=True))


def products(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of quaternions, row by row."""
    scalar = a[:, :1] * b[:, :1] - (a[:, 1:] * b[:, 1:]).sum(axis=1, keepdims=True)
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
    return np.concatenate([scalar, vector], axis=1)


def turned(e: np.ndarray, v: np.ndarray) -> np.ndarray:
    """v in the axes of the body, brought into those of the world."""
    pure = np.concatenate([np.zeros((len(e), 1)), np.broadcast_to(v, (len(e), 3))], axis=1)
    return products(products(e, pure), e * [1, -1, -1, -1])[:, 1:]


def states(e: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """q and q_dot with the same velocities in the axes of the body."""
    spin = np.broadcast_to(np.array([0, *SPIN]), e.shape)
    place = np.broadcast_to(np.array([1.0, 2.0, 3.0]), (len(e), 3))
    return np.concatenate([place, e], axis=1), np.concatenate([turned(e, VELOCITY), products(e, spin) / 2], axis=1)


def test_accelerations_are_the_same_in_every_attitude(tumbling: ModuleType) -> None:
    e = attitudes()
    q, qd = states(e)
    qdd = tumbling.forward_dynamics(q, qd, np.broadcast_to(U, (len(e), 6)))
    assert np.isfinite(qdd).all()
    back = e * [1, -1, -1, -1]
    linear = products(products(back, np.concatenate([np.zeros((len(e), 1)), qdd[:, :3]], axis=1)), e)[:, 1:]
    angular = 2 * products(back, qdd[:, 3:])[:, 1:]
    assert np.ptp(linear, axis=0).max() < 1e-13
    assert np.ptp(angular, axis=0).max() < 1e-13
    # and they are what the inputs were: round about, in every attitude
    assert np.abs(tumbling.inverse_dynamics(q, qd, qdd) - U).max() < 1e-13
    assert np.ptp(tumbling.singularity(q), axis=0).max() < 1e-13


def test_one_attitude_is_the_reference(tumbling: ModuleType) -> None:
    q, qd = (rows[0] for rows in states(np.array([[0.5, -0.5, 0.5, 0.5]])))
    state = State(tuple(q.tolist()), tuple(qd.tolist()), (0.0,) * 7, tuple(U.tolist()), ())
    expected = Reference(model()).matrices(state, ["forward_dynamics"])["forward_dynamics"]
    assert tumbling.forward_dynamics(q, qd, U) == pytest.approx([float(x) for x in expected.entries()], abs=1e-14)
