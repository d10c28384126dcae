"""Estimates of an arm with seven joints, all ten parameters of each link: logs that are fitted, over many seeds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import ROOT
from simulated_logs import Array, Motion, Sensors, functions_of, machine_of, simulated_log

from symgen.identification.combinations import default_like
from symgen.identification.estimates.identify import FittedLog, fitted_by
from symgen.identification.logs.filtering import filter_settings
from symgen.identification.logs.read_log import read_log
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text

SEVEN_JOINTS = (ROOT / "models" / "arm7.yaml").read_text(encoding="utf-8")
ANGLES = tuple(f"q_{k}" for k in range(1, 8))
# What the true parameters of links differ by from those of the file, at most; the first letters of their names.
OFF_BY, OF_LINKS = 0.15, ("m_", "c_", "I_")
# Of logs, and the seconds of each: four periods of the motion, as 43 numbers are to be fitted.
LOGS, LASTS = 20, 20.0


def links_in_truth() -> dict[str, float]:
    """Drawn once."""
    generator = np.random.default_rng(7)
    given = default_values(load_text(SEVEN_JOINTS, "machine.yaml").parameters)
    return {
        name: value * generator.uniform(1 - OFF_BY, 1 + OFF_BY)
        for name, value in given.items()
        if name.startswith(OF_LINKS)
    }


def fitted_log(folder: Path, truth: dict[str, float], seed: int) -> FittedLog:
    motion = Motion(dict.fromkeys(ANGLES, (0.2, 1.6)))
    path = simulated_log(SEVEN_JOINTS, motion, ANGLES, truth, Sensors(), seed, LASTS).write(folder)
    machine = machine_of(SEVEN_JOINTS, ANGLES)
    log = read_log(path, machine.base.model)
    return fitted_by(machine, log, filter_settings(log, None), lambda _: None)


@pytest.mark.campaign
def test_links_of_an_arm_with_seven_joints(tmp_path: Path) -> None:
    """43 combinations a log: within three standard errors for 97 %, unseen torques within 1.2 times their noise."""
    truth = links_in_truth()
    off, added = list[Array](), list[Array]()
    for seed in range(LOGS):
        made = fitted_log(tmp_path, truth, seed)
        numbers = default_like(made.functions.model, functions_of(SEVEN_JOINTS, ANGLES).parameters, truth)
        true = made.functions.combinations.at(numbers)
        assert made.names.linear == ()
        assert len(true) == 43
        off.append((made.estimate.values - true) / made.estimate.errors)
        seen = made.aside
        left = np.sqrt(np.mean((seen.inputs - seen.columns @ true) ** 2, axis=0))
        added.append(np.sqrt(np.mean((seen.inputs - made.estimate.predicted(seen)) ** 2, axis=0)) / left)
    assert np.mean(np.abs(off) < 3) >= 0.97
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.3
    assert np.mean(np.array(added) < 1.2) >= 0.97
