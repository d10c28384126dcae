"""The log of a motion under control: what drives say of a sample, noise that is theirs, columns that are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from symgen.identification.logs.read_log import read_log
from symgen.model.load import load_text
from symgen.simulate.drive_log import drive_log, drive_log_csv

SLED = """
model: sled
coordinates: {x: {unit: m}}
parameters: {m: {value: 2, unit: kg}}
kinetic_energy: m/2*x_dot**2
inputs: {f: {unit: N, acts_on: {x: 1}}}
"""
STEP = 1e-3


def readings(count: int) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """A place that grows with the time, a force that grows with its square."""
    return [(k * STEP, np.array([k * STEP]), np.array([float(k) ** 2])) for k in range(count)]


def test_a_drive_says_the_mean_about_a_sample() -> None:
    """Held inputs are half a sample late; the mean of both sides is where the encoder is."""
    log = drive_log(("x",), readings(5), 0.0, 1)
    assert log.t.tolist() == pytest.approx([k * STEP for k in range(5)])
    assert log.measured[:, 0].tolist() == log.t.tolist()
    assert log.inputs[:, 0].tolist() == [0, 0.5, 2.5, 6.5, 12.5]


def test_noise_of_inputs_is_theirs_alone() -> None:
    plain, noisy, again = (drive_log(("x",), readings(4000), noise, 1) for noise in (0.0, 0.3, 0.3))
    assert np.std(noisy.inputs - plain.inputs) == pytest.approx(0.3, rel=0.05)
    assert np.array_equal(noisy.measured, plain.measured)
    assert np.array_equal(noisy.inputs, again.inputs)


def test_identification_reads_it(tmp_path: Path) -> None:
    model = load_text(SLED, "sled.yaml")
    made = drive_log(("x",), readings(200), 0.01, 1)
    (tmp_path / "log.csv").write_text(drive_log_csv(model, made), encoding="utf-8")
    read = read_log(tmp_path / "log.csv", model)
    assert read.measured == ("x",)
    assert read.rate == pytest.approx(1 / STEP)
    assert read.columns["x"] == pytest.approx(made.measured[:, 0])
    assert read.columns["f"] == pytest.approx(made.inputs[:, 0], rel=1e-8)
