"""The machine in a map of its workspace."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from studied_arm import SHIPPED, plan_of

from symgen.study.shown.machine import machine_in_map

pytestmark = pytest.mark.toolchain

# links side by side along y, as of a real arm; it moves in the plane x-z
UPRIGHT = """model: upright
parameters: {l: {value: 0.4, range: [0.3, 0.5]}}
joints:
  lower: {type: revolute, axis: y, coordinate: a}
  upper: {type: revolute, parent: lower, at: [l, 0.05, 0], axis: AXIS, coordinate: b}
bodies: {lower: {mass: 2, com: [0.2, 0, 0]}, upper: {mass: 1, com: [0.2, 0, 0]}}
points: {tip: {frame: upper, at: [l, 0.03, 0]}}
inputs: {u: {joint: a}, v: {joint: b}}
task: {x: tip.x, z: TASK}
configuration: {a: -0.5, b: -0.7}
outputs: [inverse_dynamics, configuration_from_task]
"""


def upright(folder: Path, axis: str = "y", task: str = "tip.z") -> Path:
    path = folder / "upright.yaml"
    path.write_text(UPRIGHT.replace("AXIS", axis).replace("TASK", task), encoding="utf-8")
    return path


def test_a_machine_is_drawn_in_the_plane_of_its_map(tmp_path: Path) -> None:
    machine = machine_in_map(plan_of(["x=0.1:0.7:3", "z=0.1:0.7:3"], "reach", model=upright(tmp_path)))
    assert machine is not None
    joint = 0.4 * math.cos(0.5), 0.4 * math.sin(0.5)
    tip = joint[0] + 0.4 * math.cos(1.2), joint[1] + 0.4 * math.sin(1.2)
    bars = [stroke.places for stroke in machine.strokes if stroke.role == "link"]
    for ends in ((joint, (0.0, 0.0)), (joint, tip)):
        assert any(all(min(math.dist(end, place) for place in bar) < 1e-12 for end in ends) for bar in bars)


def test_links_at_different_heights_are_seen_from_above() -> None:
    plan = plan_of(["x=-0.1:0.1:2", "y=0.2:0.3:2"], "reach", model=SHIPPED / "five_bar.yaml")
    assert machine_in_map(plan) is not None


@pytest.mark.parametrize(
    ("over", "axis", "task"),
    [
        (["l=0.3:0.5:2", "x=0.1:0.7:3"], "y", "tip.z"),  # one of the two is no place
        (["x=0.1:0.7:3", "z=0.1:0.7:3"], "[1, 1, 0]", "tip.z"),  # it leaves the plane
        (["x=0.1:0.7:3", "z=0.1:0.7:3"], "y", "2*tip.z"),  # no place is there
    ],
)
def test_elsewhere_it_is_not(over: list[str], axis: str, task: str, tmp_path: Path) -> None:
    assert machine_in_map(plan_of(over, "reach", model=upright(tmp_path, axis, task))) is None


def test_a_model_without_frames_has_no_machine_to_draw() -> None:
    assert machine_in_map(plan_of(["x=0.1:0.7:3", "y=0.1:0.7:3"], "reach")) is None
