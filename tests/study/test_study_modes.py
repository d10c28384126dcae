"""Assembly modes of known mechanisms, as textbooks count them, and where a machine has which."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from studied_arm import SHIPPED, arm_file, plan_of, python_kernels, results_of

from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.study.assembly_modes import assembly_modes

pytestmark = pytest.mark.toolchain
RAPKM = SHIPPED / "rapkm_2rrr_rr.yaml"
# Legs a of length 1 and 1.2 from (0, 0) and (2, 0) to a common pin at (x, y).
FIVE_BAR = """\
model: five_bar
coordinates: {a: {}, b: {}, c: {}, d: {}}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2
definitions:
  x: cos(a) + 1.2*cos(b)
  y: sin(a) + 1.2*sin(b)
constraints:
  geometric:
    across: x - 2 - cos(c) - 1.2*cos(d)
    up: y - sin(c) - 1.2*sin(d)
inputs: {u: {acts_on: {a: 1}}, v: {acts_on: {c: 1}}}
task: {x: x, y: y}
measured: [a, c]
configuration: {a: 2.2, b: 0.4, c: 0.9, d: 2.7}
"""


@cache
def five_bar(further: str = "{}") -> Model:
    text = FIVE_BAR.replace("b: {}", f"b: {further}")
    return load_text(text, "five_bar.yaml")


def places(q: tuple[float, ...]) -> tuple[float, float, float, float]:
    """The pin as each of the legs has it."""
    a, b, c, d = q
    left = math.cos(a) + 1.2 * math.cos(b), math.sin(a) + 1.2 * math.sin(b)
    return *left, 2 + math.cos(c) + 1.2 * math.cos(d), math.sin(c) + 1.2 * math.sin(d)


def test_each_leg_bends_both_ways() -> None:
    made = assembly_modes(five_bar(), by_task=True)
    assert len(made) == 4
    own = places(made[0])
    for q in made:
        assert np.allclose(places(q), own, atol=1e-9)
    bends = {(math.sin(b - a) > 0, math.sin(d - c) > 0) for a, b, c, d in made}
    assert len(bends) == 4


def test_the_pin_is_on_either_side_of_the_drives() -> None:
    made = assembly_modes(five_bar(), by_task=False)
    assert len(made) == 2
    assert made[0][0] == pytest.approx(made[1][0])
    assert made[0][2] == pytest.approx(made[1][2])
    assert places(made[0])[1] != pytest.approx(places(made[1])[1])


def test_modes_out_of_the_range_of_a_coordinate_are_none() -> None:
    assert len(assembly_modes(five_bar("{range: [-0.5, 1]}"), by_task=True)) == 2


def test_three_legs_bend_in_eight_ways() -> None:
    model = load_model(RAPKM)
    made = assembly_modes(model, by_task=True)
    assert len(made) == 8
    module = python_kernels(("constraint_residual", "task_position"), RAPKM)
    q = np.array(made)
    assert np.abs(module.constraint_residual(q)).max() < 1e-9
    assert np.ptp(module.task_position(q), axis=0).max() < 1e-9


def results(folder: Path, over: list[str], model: Path) -> Any:
    return results_of(folder / "partial", plan_of(over, "modes,reach", model))


def test_all_of_them_are_reached_where_one_is(tmp_path: Path) -> None:
    made = results(tmp_path, ["x=-0.05:0.45:9", "y=-0.1:0.4:9"], RAPKM)
    assert (made.modes.sel(mode="mode 1").values == made.reach.values).all()
    assert (made.mode_count.values == made.modes.values.sum(axis=-1)).all()
    assert set(np.unique(made.mode_count.values)) == {0, 8}


def test_an_elbow_that_bends_one_way_has_one(tmp_path: Path) -> None:
    made = results(tmp_path, ["x=-1.2:1.2:9", "y=-1.2:1.2:9"], arm_file())
    assert set(np.unique(made.mode_count.values)) == {0, 1}
    # b from 0.3 to 2.5: neither stretched nor folded
    distance = np.hypot(*np.meshgrid(np.linspace(-1.2, 1.2, 9), np.linspace(-1.2, 1.2, 9)))
    assert (made.mode_count.values[(distance < 0.3) | (distance > 1)] == 0).all()
    assert (made.reach.values >= made.mode_count.values).all()
