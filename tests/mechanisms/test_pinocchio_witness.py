"""Pinocchio's recursions and Jacobians, with NumPy's linear algebra for the loops, against the generated Python."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from generated_python import generated_python
from pinocchio_tree import Tree
from shipped import ROOT

from symgen.model.load import load_model
from symgen.model.model import Model

WITHIN = 1e-9
# Loops by the points that they close, as distances or, in the plane, as coincidences.
RODS = {"delta": [(f"elbow_end_{i}", f"ball_{i}") for i in (1, 2, 3)]}
LEGS = {"gough_stewart": [(f"head_{i}", f"foot_{i}", f"s_{i}") for i in range(1, 7)]}
PINS = {"three_rrr": [(f"tip_{i}", f"corner_{i}") for i in (1, 2, 3)]}
SERIAL = ("arm7", "scara")
LOOPED = (*RODS, *LEGS, *PINS)
# The others take many times as long to derive.
FEW = ("scara", "arm7")
NAMES = [name if name in FEW else pytest.param(name, marks=pytest.mark.mechanisms) for name in (*SERIAL, *LOOPED)]


@cache
def tree(name: str) -> Tree:
    return Tree(load_model(ROOT / "models" / f"{name}.yaml"))


def states(model: Model, count: int) -> list[tuple[Any, Any, Any, Any]]:
    """q within its ranges or, for a mechanism with loops, near its configuration; rates, accelerations, inputs."""
    source = np.random.default_rng(5)
    near = dict(model.configuration)
    drawn = []
    for _ in range(count):
        low, high = np.array([[float(x) for x in c.range] for c in model.coordinates]).T
        q = source.uniform(low, high)
        if model.r:
            q = np.array([float(near[c.name]) for c in model.coordinates]) + 0.02 * (high - low) * source.normal(
                size=model.n
            )
        drawn.append((q, source.normal(size=model.n), source.normal(size=model.n), 5 * source.normal(size=model.m)))
    return drawn


def rows(name: str, q: Any, qd: Any) -> tuple[Any, Any]:
    """B (r, n) and B-dot qd (r) of the loops."""
    body_tree = tree(name)
    index = {coordinate.name: i for i, coordinate in enumerate(body_tree.model.coordinates)}
    B, bias = [], []
    for one, other in PINS.get(name, []):
        p, a = body_tree.point(one, q, qd), body_tree.point(other, q, qd)
        B += [*(p[1] - a[1])[:2]]
        bias += [*(p[2] - a[2])[:2]]
    for one, other, *length in [*RODS.get(name, []), *LEGS.get(name, [])]:
        p, a = body_tree.point(one, q, qd), body_tree.point(other, q, qd)
        across, jacobian, drift = (x - y for x, y in zip(p, a, strict=True))
        row, rest = across @ jacobian, across @ drift + (jacobian @ qd) @ (jacobian @ qd)
        for coordinate in length:
            row = row - q[index[coordinate]] * np.eye(len(q))[index[coordinate]]
            rest -= qd[index[coordinate]] ** 2
        B.append(row)
        bias.append(rest)
    return np.array(B).reshape(-1, len(q)), np.array(bias)


def friction(name: str, qd: Any) -> Any:
    """Q_a of the SCARA's joints, the one tree with friction: by its file, -d rate - c tanh(rate/width)."""
    force = np.zeros_like(qd)
    if name == "scara":
        for coordinate, (d, c, width) in {"q_1": (0.8, 1.5, 0.02), "q_2": (0.5, 1, 0.02), "z": (20, 5, 0.005)}.items():
            i = tree(name).names.index(coordinate)
            force[i] = -d * qd[i] - c * np.tanh(qd[i] / width)
    return force


def control(model: Model) -> Any:
    M = np.zeros((model.n, model.m))
    names = [c.name for c in model.coordinates]
    for j, given in enumerate(model.inputs):
        for coordinate, _ in given.acts_on:
            M[names.index(coordinate), j] = 1  # every input of these models is `joint: ...`
    return M


def close(computed: Any, expected: Any) -> bool:
    return bool(np.abs(computed - expected).max() <= WITHIN * np.abs(expected).max())


@pytest.mark.mechanisms
@pytest.mark.parametrize("name", NAMES)
def test_inverse_dynamics(name: str) -> None:
    model = tree(name).model
    for q, qd, qdd, _ in states(model, 5):
        tau = tree(name).balance(q, qd, qdd) - friction(name, qd)
        B, _ = rows(name, q, qd)
        N = np.eye(model.n) - np.linalg.pinv(B) @ B if model.r else np.eye(model.n)
        assert close(
            generated_python(name).inverse_dynamics(q, qd, qdd), np.linalg.lstsq(N @ control(model), N @ tau, 1e-9)[0]
        )


@pytest.mark.parametrize("name", NAMES)
def test_forward_dynamics(name: str) -> None:
    model = tree(name).model
    n, r = model.n, model.r
    for q, qd, _, u in states(model, 5):
        B, bias = rows(name, q, qd)
        load = control(model) @ u + friction(name, qd) - tree(name).balance(q, qd, np.zeros(n))
        kkt = np.block([[tree(name).mass_matrix(q), B.T], [B, np.zeros((r, r))]])
        expected = np.linalg.solve(kkt, np.concatenate([load, -bias]))[:n]
        assert close(generated_python(name).forward_dynamics(q, qd, u), expected)


def test_the_witness_can_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """A centre of mass moved by a millimetre is seen."""
    check: Callable[[str], None] = test_inverse_dynamics
    moved = Tree(load_model(ROOT / "models" / "arm7.yaml"))
    joint = moved.tree.inertias[3]
    joint.lever = joint.lever + np.array([1e-3, 0, 0])
    moved.data = moved.tree.createData()
    monkeypatch.setattr("test_pinocchio_witness.tree", lambda _: moved)
    with pytest.raises(AssertionError):
        check("arm7")
