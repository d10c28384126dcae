"""MJCF files as models: what is called how, what the model file says instead, and what takes no part."""

from __future__ import annotations

from pathlib import Path

import pytest
from mjcf_files import COUPLED, FOUR_BAR, HEAD, TREE, load

from symgen.diagnostics import ModelError
from symgen.generation.results import Options
from symgen.mechanics.system import System
from symgen.pipeline import generate
from symgen.symbolic.evaluate import Evaluator


def test_dry_friction_is_smooth(tmp_path: Path) -> None:
    text = FOUR_BAR.replace('name="c"', 'name="c" frictionloss="0.3"')
    moving = {"a_dot": 0.0, "b_dot": 0.0, "c_dot": 0.5}
    assert Evaluator(list(System(load(tmp_path, text)).applied_force))(moving) == pytest.approx([0, 0, -0.3])
    with pytest.raises(ModelError, match="has no width in which it changes its sign"):
        load(tmp_path, text, "model: robot\nmjcf: robot.xml\n")


def test_names(tmp_path: Path) -> None:
    model = load(tmp_path, TREE)
    names = ["turn", "slide", "ball_e0", "ball_e1", "ball_e2", "ball_e3", "wrist", "fly_x", "fly_y", "fly_z", "fly_e0"]
    assert [c.name for c in model.coordinates][:11] == names
    assert {"base", "arm", "tool", "finger", "stone"} <= {frame.name for frame in model.mechanism.frames}
    # the finger moves with the tool, whose body holds both masses
    assert [body.name for body in model.mechanism.bodies] == ["base", "arm", "tool", "stone"]


def test_a_motor_that_is_called_like_its_joint(tmp_path: Path) -> None:
    model = load(tmp_path, FOUR_BAR.replace('name="drive"', 'name="a"'))
    assert [(given.name, given.acts_on[0][0]) for given in model.inputs] == [("u_a", "a")]
    assert any("is the input `u_a`" in notice.message for notice in model.notices)


def test_what_the_model_file_says_replaces_the_rest(tmp_path: Path) -> None:
    own = (
        "gravity: [0, 0, -1]\nranges: {turn: [-0.1, 0.2]}\nfriction: {wrist: {viscous: 7}}\n"
        "rotor_inertias: {wrist: 0.5}\nsprings: {slide_spring: {joint: slide, stiffness: 9}}\n"
        "inputs: {other: {joint: wrist}}\n"
    )
    model = load(tmp_path, TREE.replace("</mujoco>", '<actuator><motor joint="turn"/></actuator></mujoco>'), HEAD + own)
    assert [given.name for given in model.inputs] == ["other"]
    assert float(model.coordinates[0].range[1]) == pytest.approx(0.2)
    assert sum(rotor.coordinate == "wrist" for rotor in model.mechanism.rotor_inertias) == 1
    rest = dict.fromkeys((c.rate for c in model.coordinates), 0.0)
    assert min(Evaluator(list(System(model).applied_force))({**rest, "wrist_dot": 1.0})) == -7


def test_a_second_coupling_of_a_joint_is_a_row(tmp_path: Path) -> None:
    text = COUPLED.replace('joint1="c" joint2="b"', 'joint1="a" joint2="c"')
    model = load(tmp_path, text)
    assert [row.name for row in model.constraints] == ["cam", "a_coupling"]


def test_what_takes_no_part_is_told(tmp_path: Path) -> None:
    text = COUPLED.replace('name="cam"', 'name="cam" active="false"').replace(
        "</mujoco>", '<sensor><jointpos joint="a"/></sensor><keyframe/></mujoco>'
    )
    messages = [notice.message for notice in load(tmp_path, text).notices]
    for part in ("`sensor` of the MJCF", "`keyframe` of the MJCF", "`joint, which is not active,`", "`contact` of the"):
        assert any(part in message for message in messages), part


def test_what_is_refused_may_be_left_out_by_name(tmp_path: Path) -> None:
    text = COUPLED.replace("</mujoco>", '<actuator><position name="servo" joint="a" kp="3"/></actuator></mujoco>')
    model = load(tmp_path, text, "model: robot\nmjcf: {file: robot.xml, leave_out: [position]}\n")
    assert "`position` of the MJCF takes no part (servo)" in [notice.message for notice in model.notices]


@pytest.mark.slow
def test_a_four_bar_is_verified_all_the_way(tmp_path: Path) -> None:
    load(tmp_path, FOUR_BAR)
    (tmp_path / "robot.yaml").write_text(HEAD, encoding="utf-8")
    result = generate(tmp_path / "robot.yaml", Options(parts=("python",), states=8), lambda _: None)
    assert result.failures == ()
    assert result.certificate is not None
