"""Energy and momentum of free motions, integrated with the generated accelerations."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from shipped import ROOT

from symgen.generation.runnable import RunnableKernels
from symgen.mechanics.system import System
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model
from symgen.simulate.integrate import SimulatedMotion, consistent_start, integrate
from symgen.simulate.plant import QUANTITIES, Plant
from symgen.symbolic.evaluate import Evaluator

MODELS = {name: ROOT / "models" / f"{name}.yaml" for name in ("rolling_disc", "gough_stewart")}
MODELS["floating_body"] = Path(__file__).parent / "floating_body.yaml"


def free_motion(name: str, folder: Path, duration: float, rates: dict[str, float]) -> SimulatedMotion:
    model = load_model(MODELS[name])
    plant = Plant(model, tuple(default_values(model.parameters).values()), RunnableKernels(model, folder, QUANTITIES))
    q = [float(dict(model.configuration).get(c.name, 0)) for c in model.coordinates]
    start = consistent_start(plant, q, [rates.get(c.name, 0.0) for c in model.coordinates])
    times = np.linspace(0, duration, 11).tolist()
    motion = integrate(plant, start, (0.0,) * model.m, times, lambda _: None)
    assert motion.stopped is None
    assert np.abs(np.array(motion.q[-1]) - motion.q[0]).max() > 0.05
    return motion


@pytest.mark.parametrize(
    ("name", "duration", "rates"),
    [
        pytest.param("rolling_disc", 1.0, {"phi": 6.0, "psi": 0.8}),
        pytest.param("floating_body", 1.0, {"a": 20.0, "e_1": 0.5, "x": 1.0}),
        pytest.param("gough_stewart", 0.2, {"x": 0.3, "z": 0.5, "psi": 0.4}, marks=pytest.mark.mechanisms),
    ],
)
def test_energy_of_a_free_motion(name: str, duration: float, rates: dict[str, float], tmp_path: Path) -> None:
    motion = free_motion(name, tmp_path, duration, rates)
    total = np.array([kinetic + potential for kinetic, potential in motion.energy])
    kinetic = np.array([kinetic for kinetic, _ in motion.energy])
    assert np.ptp(total) < 1e-8 * kinetic.max()
    assert np.ptp(kinetic) > 1e-4 * kinetic.max()


def test_momentum_of_a_floating_body(tmp_path: Path) -> None:
    """Weight acts along z: momentum along x and y, and angular momentum about the z axis of the world, stay."""
    model = load_model(MODELS["floating_body"])
    motion = free_motion("floating_body", tmp_path, 1.0, {"a": 20.0, "e_1": 0.5, "e_3": 0.3, "x": 1.0})
    evaluate = Evaluator([entry for row in System(model).mass_matrix for entry in row])
    names = [c.name for c in model.coordinates]
    kept = []
    for q, qd in zip(motion.q, motion.qd, strict=True):
        values = default_values(model.parameters) | dict(zip(names, q, strict=True))
        p = np.array(evaluate(values)).reshape(model.n, model.n) @ np.array(qd)
        e_0, e_1, e_2, e_3 = q[3:7]
        # omega = 2 E e_dot in world axes with E E^T = 1, so that the momentum about the base's origin is E p_e/2
        row = np.array([-e_3, -e_2, e_1, e_0])
        kept.append((p[0], p[1], row @ p[3:7] / 2 + q[0] * p[1] - q[1] * p[0]))
    assert np.ptp(np.array(kept), axis=0).max() < 1e-8 * np.abs(kept).max()
    assert np.ptp(np.array(motion.qd)[:, 4]) > 1e-2
