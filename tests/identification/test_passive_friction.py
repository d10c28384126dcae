"""Friction where no drive is: of passive joints and of the pin that closes a loop, and offsets of drives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import FOUR_BAR_WITH_NAMES
from simulated_logs import Motion, Sensors, of_file, simulated_log

WITHIN = 3.0
# Dry and viscous friction of the joint between crank and coupler and of the pin at the rocker's top, and an offset.
ROUGH_BARS = (
    FOUR_BAR_WITH_NAMES.replace(
        "gravity:",
        """  e: {value: 0, unit: N*m*s, range: [0, 1]}
  f: {value: 0, unit: N*m, range: [0, 1]}
  p: {value: 0, unit: N*m*s, range: [0, 1]}
  h: {value: 0, unit: N*m, range: [0, 1]}
  o: {value: 0, unit: N*m, range: [-2, 2]}
gravity:""",
    )
    .replace("  c: {viscous: d}", "  c: {viscous: d}\n  b: {viscous: e, coulomb: f, width: 0.1}")
    .replace(
        "inputs:",
        """forces:
  pin: {torque_on: coupler, reaction: rocker, direction: [0, 0, 1],
        magnitude: "-p*(a_dot + b_dot - c_dot) - h*tanh((a_dot + b_dot - c_dot)/0.1)"}
applied_forces:
  a: -o
inputs:""",
    )
)
TRUTH = {"d": 0.35, "e": 0.25, "f": 0.15, "p": 0.12, "h": 0.3, "o": -1.5}


@pytest.mark.campaign
def test_drives_show_friction_of_passive_joints_and_loop_pins(tmp_path: Path) -> None:
    """Each is estimated by itself, from drives at crank and rocker alone, and none of them is 0."""
    log = simulated_log(ROUGH_BARS, Motion({"a": (1.1, 0.9)}), ("a", "c"), TRUTH, Sensors(), seconds=20.0)
    made = of_file(log.write(tmp_path), ROUGH_BARS, ("a", "c"))
    assert {*made.names.linear} == {*TRUTH}
    count = len(made.names.linear)
    values = dict(zip(made.names.linear, made.estimate.values[-count:], strict=True))
    errors = dict(zip(made.names.linear, made.estimate.errors[-count:], strict=True))
    off = {name: (values[name] - true) / errors[name] for name, true in TRUTH.items()}
    assert max(map(abs, off.values())) < WITHIN, off
    assert {name for name, true in TRUTH.items() if abs(true) <= WITHIN * errors[name]} == set()
    assert np.isfinite(made.estimate.condition)
