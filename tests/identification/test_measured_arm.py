"""A robot that was measured: what others published of it comes out of its log."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import pytest

from symgen.identification.estimates.identify import identified

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "staubli_tx40"
# What the configuration of FIGAROH's example of this robot has, by the sums of parameters that it is: the motor of the
# wrist adds to the rows of both joints that turn it.
PUBLISHED = {
    ("fv_1",): 8.05, ("fv_2",): 5.53, ("fv_3",): 1.97, ("fv_4",): 1.11,
    ("fv_5", "fv_w"): 1.86, ("fv_6", "fv_w"): 0.65, ("fv_w",): 0.616,
    ("fs_1",): 7.14, ("fs_2",): 8.26, ("fs_3",): 6.34, ("fs_4",): 2.48, ("fs_5",): 3.03, ("fs_6",): 0.282,
    ("fs_w",): 1.95,
    ("off_1",): 0.392, ("off_2",): 1.37, ("off_3",): 0.326, ("off_4",): -0.102, ("off_5",): -0.0288, ("off_w",): 0.127,
    ("q_3.Ir",): 0.0988, ("q_4.Ir",): 0.0313, ("q_5.Ir", "w.Ir"): 0.0468, ("link_6.Izz", "w.Ir"): 0.0105,
    ("w.Ir",): 0.00964,
}  # fmt: skip
# How near those come that are well known.
NEAR = {"fv_1": 0.015, "fv_3": 0.015, "fv_4": 0.015, "fs_3": 0.015, "fs_1": 0.1, "fs_2": 0.1, "fs_4": 0.1, "w.Ir": 0.1}


@pytest.mark.campaign
@pytest.mark.slow
def test_friction_and_rotors_of_a_measured_arm_are_those_published() -> None:
    made = identified(EXAMPLE / "tx40.yaml", EXAMPLE / "log.csv", None, lambda _: None)
    shown = {one.name.split(" ")[0]: one for one in made.parameters}
    for names, published in PUBLISHED.items():
        value, error = sum(shown[name].value for name in names), hypot(*(shown[name].error for name in names))
        assert abs(value - published) < 2 * error
    for name, share in NEAR.items():
        assert shown[name].value == pytest.approx(PUBLISHED[name,], rel=share)
    # the joints are somewhat elastic, and friction has more to it
    assert all(drive.fitted < 0.16 * drive.inputs for drive in made.drives)
