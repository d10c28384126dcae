"""SDF files as models: the five-bar linkage as its URDF gives it, trees, loops, mimics, gravity, what takes no part."""

from __future__ import annotations

import random
from math import acos, pi
from pathlib import Path

import numpy as np
import pytest
from five_bar_sdf import five_bar
from row_spaces import projector
from sdf_files import HEAD, joint, link, load, robot, rows
from shipped import ROOT

from symgen.diagnostics import ModelError
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator

WITHIN = 1e-13
YAML = (ROOT / "models" / "five_bar.yaml").read_text(encoding="utf-8")
OF_SDF = YAML.replace("urdf: {file: five_bar.urdf", "sdf: {file: robot.sdf")
SPINDLE = joint("spindle", "revolute", "left_end", "right_end")


def state_of(model: Model, seed: int) -> dict[str, float]:
    source = random.Random(seed)
    names = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    return {"J_m": 4e-4, **{name: source.uniform(-1, 1) for name in names}}


def test_the_five_bar_linkage_has_the_equations_of_its_urdf(tmp_path: Path) -> None:
    shipped, other = load_model(ROOT / "models" / "five_bar.yaml"), load(tmp_path, five_bar(""), OF_SDF)
    assert [(c.name, c.range, c.rate_range) for c in shipped.coordinates] == [
        (c.name, c.range, c.rate_range) for c in other.coordinates
    ]
    for seed in range(5):
        state = state_of(shipped, seed)
        for of in ("balance", "constraint_residual", "applied_force"):
            mine, theirs = (Evaluator(list(getattr(System(m), of)))(state) for m in (other, shipped))
            assert mine == theirs


def test_a_joint_beyond_the_tree_closes_the_loop(tmp_path: Path) -> None:
    """Its rows are those of the shipped loop, at the pose in which the file has both ends at one place."""
    turned = acos(0.06 / 0.38)
    text = five_bar(SPINDLE).replace("<pose>-0.06 0 0.2 0 0 0</pose>", f"<pose>-0.06 0 0.2 0 0 {turned}</pose>")
    text = text.replace("<pose>0.06 0 0.2 0 0 0</pose>", f"<pose>0.06 0 0.2 0 0 {pi - turned}</pose>")
    loop = "loops:\n  spindle: {type: revolute, between: [left_end, right_end], axis: z}\n"
    start = "configuration: {left_motor: 2.2, right_motor: 0.94, left_elbow: -1.2, right_elbow: 1.2}\n"
    own = OF_SDF.replace(loop, "").replace(start, "")
    model, shipped = load(tmp_path, text, own), load_model(ROOT / "models" / "five_bar.yaml")
    assert [row.name for row in model.constraints] == ["spindle_x", "spindle_y"]
    assert any("beyond a tree close loops, and have no coordinates (spindle)" in n.message for n in model.notices)
    names = [c.name for c in shipped.coordinates]
    mine = rows(model, dict.fromkeys(names, 0.0))
    theirs = rows(shipped, dict(zip(names, (turned, pi - turned, 0.0, 0.0), strict=True)))
    assert np.abs(projector(mine) - projector(theirs)).max() < WITHIN


def test_a_model_that_is_joined_to_nothing_moves_freely(tmp_path: Path) -> None:
    text_of_robot = robot(link("base"), link("arm"), joint("turn", "revolute", "base", "arm"))
    model = load(tmp_path, text_of_robot)
    assert [c.name for c in model.coordinates][:3] == ["base_free_x", "base_free_y", "base_free_z"]
    assert any("`base` of the SDF is joined to nothing: it moves freely" in notice.message for notice in model.notices)
    held = load(tmp_path, text_of_robot, f"{HEAD}frames: {{base: {{}}}}\n")
    assert [c.name for c in held.coordinates] == ["turn"]
    lifted = load(tmp_path, text_of_robot, f"{HEAD}joints: {{lift: {{type: prismatic, child: base, coordinate: s}}}}\n")
    assert [c.name for c in lifted.coordinates] == ["turn", "s"]


def test_mimics_follow(tmp_path: Path) -> None:
    mimic = (
        '<axis><xyz>0 1 0</xyz><mimic joint="a"><multiplier>-2</multiplier><offset>0.1</offset>'
        "<reference>0.3</reference></mimic></axis>"
    )
    text_of_robot = robot(
        link("one"),
        link("two"),
        joint("a", "revolute", "world", "one"),
        joint("b", "revolute", "one", "two", "", mimic),
    )
    model = load(tmp_path, text_of_robot)
    assert [row.name for row in model.constraints] == ["b_coupling"]
    residual = Evaluator(list(System(model).constraint_residual))({"a": 0.5, "b": 0.7})
    assert residual == pytest.approx([0.7 + 2 * 0.2 - 0.1])


def test_gravity_is_that_of_the_world(tmp_path: Path) -> None:
    inner = robot(link("one"), joint("a", "revolute", "world", "one")).replace("</model>", "</model></world>")
    world = inner.replace('<model name="robot">', '<world name="w"><gravity>0 0 -1.6</gravity><model name="robot">')
    head = "model: robot\nsdf: robot.sdf\n"
    assert float(load(tmp_path, world, head).mechanism.gravity[2].operand.value) == 1.6  # type: ignore[union-attr]
    usual = world.replace("<gravity>0 0 -1.6</gravity>", "")
    assert float(load(tmp_path, usual, head).mechanism.gravity[2].operand.value) == 9.8  # type: ignore[union-attr]


def test_limits_that_are_none(tmp_path: Path) -> None:
    limit = "<axis><xyz>0 0 1</xyz><limit><lower>{}</lower><upper>{}</upper><velocity>{}</velocity></limit></axis>"
    for lower, upper, velocity in (("-1.8e+308", "1.8e+308", "-1"), ("-inf", "1", "inf"), ("-1e16", "1e16", "0")):
        turning = limit.format(lower, upper, velocity)
        text_of_robot = robot(link("one"), joint("a", "revolute", "world", "one", "", turning))
        assert not load(tmp_path, text_of_robot).coordinates[0].has_range


def test_plugins_may_be_left_out(tmp_path: Path) -> None:
    text_of_robot = robot(link("one"), joint("a", "revolute", "world", "one"), '<plugin name="p" filename="p.so"/>')
    with pytest.raises(ModelError, match="plugins may bring forces"):
        load(tmp_path, text_of_robot)
    model = load(tmp_path, text_of_robot, HEAD.replace("friction_width: 0.01", "leave_out: [plugin]"))
    assert "`plugin` of the SDF takes no part (p)" in [notice.message for notice in model.notices]


def test_dry_friction_needs_its_width(tmp_path: Path) -> None:
    rough = "<axis><xyz>0 0 1</xyz><dynamics><friction>0.2</friction></dynamics></axis>"
    text_of_robot = robot(link("one"), joint("a", "revolute", "world", "one", "", rough))
    with pytest.raises(ModelError, match="the dry friction of the joint `a` has no width"):
        load(tmp_path, text_of_robot, "model: robot\nsdf: robot.sdf\n")
    assert load(tmp_path, text_of_robot).forces
