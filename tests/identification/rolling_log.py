"""Logs of the car that rolls: a course with changes of speed and curvature, all places measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from identified_machines import ROOT
from scipy import integrate
from simulated_logs import Array, functions_of

from symgen.identification.combinations import default_like

CAR = (ROOT / "models" / "front_car_bodies.yaml").read_text(encoding="utf-8")
CAR_PLACES = ("x", "y", "theta", "phi")
CAR_TRUTH = {"m_1": 1300.0, "Theta_1": 1800.0, "Theta_2": 2.0}
# Seconds of a log, of a sample and of a period; steps of places in m and rad; noise of inputs as a share of their size.
LASTING, SAMPLE, PERIOD, PLACE_STEP, INPUT_NOISE = 20.0, 0.002, 5.0, 1e-4, 0.02
# The speed in the middle in m/s, and how far speed and steering angle go from their middles.
MEAN_SPEED, SPEED_CHANGE, STEERING = 4.0, 3.0, 0.5
HARMONICS_OF_COURSE = 3


def rolling_log(path: Path, seed: int, truth: Mapping[str, float] = CAR_TRUTH) -> None:
    """Writes the log of a car whose parameters are those of its file but for the truth, on a course that is drawn."""
    functions, generator = functions_of(CAR, CAR_PLACES), np.random.default_rng(seed)
    t, length = np.arange(0, LASTING, SAMPLE), functions.parameters["L"]
    v, v_d, _ = _series(t, MEAN_SPEED, SPEED_CHANGE, generator)
    p, p_d, p_dd = _series(t, 0.0, STEERING, generator)
    turn, turn_d = v * np.tan(p) / length, (v_d * np.tan(p) + v * p_d / np.cos(p) ** 2) / length
    heading = integrate.cumulative_simpson(turn, dx=SAMPLE, initial=0)
    cos, sin = np.cos(heading), np.sin(heading)
    x, y = (integrate.cumulative_simpson(v * part, dx=SAMPLE, initial=0) for part in (cos, sin))
    q = np.stack([x, y, heading, p], axis=-1)
    rates = np.stack([v * cos, v * sin, turn, p_d], axis=-1)
    accelerations = np.stack([v_d * cos - v * turn * sin, v_d * sin + v * turn * cos, turn_d, p_dd], axis=-1)
    u = functions.inputs((q, rates, accelerations), default_like(functions.model, functions.parameters, truth))
    u = u + INPUT_NOISE * np.std(u, axis=0) * generator.standard_normal(u.shape)
    table = np.column_stack([t, np.round(q / PLACE_STEP) * PLACE_STEP, u])
    np.savetxt(path, table, "%.9g", ",", header="t,x,y,theta,phi,K_f,T", comments="")


def _series(t: Array, middle: float, most: float, generator: np.random.Generator) -> tuple[Array, Array, Array]:
    """A Fourier series that goes `most` from its middle, and its first two derivatives."""
    values = [np.zeros_like(t) for _ in range(3)]
    for k in range(1, HARMONICS_OF_COURSE + 1):
        w, share, phase = 2 * np.pi * k / PERIOD, generator.standard_normal() / k, generator.uniform(0, 2 * np.pi)
        for order in range(3):
            values[order] += share * w**order * np.sin(w * t + phase + order * np.pi / 2)
    scale = most / np.abs(values[0]).max()
    return middle + scale * values[0], scale * values[1], scale * values[2]
