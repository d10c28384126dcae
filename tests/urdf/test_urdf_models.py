"""Robot descriptions become the models that a user would have written by hand."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from math import cos, sin
from pathlib import Path

import pytest
from robots import ARM, HEAD, LIMIT, balance, joint, link, load, mass_matrix, robot, state_of

from symgen.diagnostics import ModelError
from symgen.generation.results import Options
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Number
from symgen.model.load import load_text
from symgen.pipeline import generate
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import cost

ARM_AS_FRAMES = """\
model: arm
gravity: [0, 0, -9.81]
coordinates: {shoulder: {unit: rad}, elbow: {unit: rad}}
frames:
  base: {}
  upper: {parent: base, translation: [0, 0, 0.3], rotation: [[x, pi/2], [z, shoulder]]}
  lower: {parent: upper, translation: [0.5, 0, 0], rotation: [[z, elbow]]}
bodies:
  upper: {mass: 2, com: [0.25, 0, 0], inertia: {xx: 0.01, yy: 0.05, zz: 0.05}}
  lower: {mass: 1.5, com: [0.2, 0, 0.01], inertia: {xx: 0.008, xy: 0.001, yy: 0.04, zz: 0.04}}
friction: {elbow: {viscous: 0.1}}
"""
CARRIED = robot(
    link("base", 0),
    link("arm"),
    link("tool", 0.5, 0.01, '<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.5 0.7"/>').replace(
        'ixx="0.01" ixy="0"', 'ixx="0.013" ixy="0.002"'
    ),
    joint("turn", "continuous", "base", "arm", '<axis xyz="0 1 0"/>'),
    joint("mount", "fixed", "arm", "tool", '<origin xyz="0.4 0 0.1" rpy="0.2 0.4 -0.6"/>'),
)


def test_an_arm_equals_the_same_arm_written_as_frames(tmp_path: Path) -> None:
    imported, written = load(tmp_path, ARM), load_text(ARM_AS_FRAMES, "m.yaml")
    assert [c.name for c in imported.coordinates] == ["shoulder", "elbow"]
    assert all(c.is_angle and c.unit == "rad" for c in imported.coordinates)
    sides = System(imported), System(written)
    assert cost(sides[0].balance) == cost(sides[1].balance)
    for seed in range(3):
        state = state_of(imported, seed)
        assert balance(imported, state) == balance(written, state)
        assert mass_matrix(imported, state) == mass_matrix(written, state)


def test_limits_become_ranges(tmp_path: Path) -> None:
    shoulder, elbow = load(tmp_path, ARM).coordinates
    assert (shoulder.range, shoulder.rate_range) == ((-2, 2), (-3, 3))
    assert elbow.rate_range == (-1, 1)
    own = f"{HEAD}ranges: {{shoulder: [0, 1]}}\ncoordinates: {{elbow: {{unit: rad, range: [-1, 0]}}}}\n"
    ranges = {c.name: c.range for c in load(tmp_path, ARM, own).coordinates}
    assert ranges == {"shoulder": (0, 1), "elbow": (-1, 0)}


def test_what_takes_no_part_is_told_by_name(tmp_path: Path) -> None:
    text = ARM.replace(
        "</robot>", '<transmission name="gear"/><gazebo reference="upper"/><material name="red"/></robot>'
    ).replace('<link name="base"/>', '<link name="base"><visual/><collision/></link>')
    messages = [notice.message for notice in load(tmp_path, text).notices]
    assert messages == [
        "`visual` and `collision` of the URDF are geometry, for animations alone",
        "`transmission` of the URDF takes no part (gear): inputs stand in the model file, as forces and torques of the "
        "joints",
        "`gazebo` of the URDF takes no part (upper): it is for a simulator",
        "`material` of the URDF takes no part (red)",
        "effort limits of the URDF bound no input (shoulder 50)",
    ]


@pytest.mark.parametrize(
    ("inputs", "endings"),
    [
        ("", [""]),
        ("inputs: {s: {unit: N*m, joint: shoulder}, e: {unit: N*m, joint: elbow}}\n", [""]),
        (
            "inputs: {s: {unit: N*m, joint: shoulder}, e: {unit: N*m, joint: elbow}, f: {unit: N*m, joint: elbow}}\n",
            [": `limits` under `allocation` can"],
        ),
        (
            "inputs: {s: {unit: N*m, joint: shoulder}, e: {unit: N*m, joint: elbow}, f: {unit: N*m, joint: elbow}}\n"
            "allocation: {limits: {e: [-5, 5]}}\n",
            [],
        ),
    ],
)
def test_limits_of_drives_are_offered_where_they_can_be_kept(tmp_path: Path, inputs: str, endings: list[str]) -> None:
    messages = [notice.message for notice in load(tmp_path, ARM, HEAD + inputs).notices]
    start = "effort limits of the URDF bound no input (shoulder 50)"
    assert [message.removeprefix(start) for message in messages if message.startswith(start)] == endings


def test_links_on_fixed_joints_are_carried_by_one_body(tmp_path: Path) -> None:
    merged = load(tmp_path, CARRIED)
    assert [body.name for body in merged.mechanism.bodies] == ["arm"]
    turned = "{xx: 0.013, xy: 0.002, yy: 0.01, zz: 0.01}"
    apart = load_text(
        f"""\
model: m
gravity: [0, 0, -9.81]
joints: {{turn: {{type: revolute, child: arm, axis: y, coordinate: turn}}}}
frames:
  tool: {{parent: arm, translation: [0.4, 0, 0.1], rotation: [[z, -0.6], [y, 0.4], [x, 0.2]]}}
  inertial: {{parent: tool, translation: [0.1, 0.2, 0.3], rotation: [[z, 0.7], [y, -0.5], [x, 0.3]]}}
bodies:
  arm: {{mass: 1, inertia: {{xx: 0.02, yy: 0.02, zz: 0.02}}}}
  inertial: {{mass: 0.5, inertia: {turned}}}
""",
        "m.yaml",
    )
    for seed in range(3):
        state = state_of(merged, seed)
        assert balance(merged, state)["turn"] == pytest.approx(balance(apart, state)["turn"], rel=1e-13)
    assert {frame.name for frame in merged.mechanism.frames} == {"base", "arm", "tool"}


def test_a_point_on_a_carried_link_is_where_it_is(tmp_path: Path) -> None:
    points = "points: {tip: {frame: tool, at: [0, 0, 1]}}\ndefinitions: {h: tip.z}\n"
    model = load(tmp_path, CARRIED, HEAD + points)
    height = Evaluator([System(model).names["h"]])({"turn": 0.0})[0]
    assert height == pytest.approx(0.1 + 0.92106099400288508 * 0.98006657784124163, rel=1e-15)


def test_ways_have_axes_of_length_one(tmp_path: Path) -> None:
    parts = link("base", 0), link("slide", 2), joint("s", "prismatic", "base", "slide", f'<axis xyz="0 3 4"/>{LIMIT}')
    model = load(tmp_path, robot(*parts))
    assert model.coordinates[0].unit == "m"
    assert mass_matrix(model, {"s": 0.3}) == pytest.approx([2.0], rel=1e-14)
    forces = balance(model, {"s": 0.1, "s_dot": 0.2, "s_ddot": 0.0})
    assert forces["s"] == pytest.approx(2 * 9.81 * 0.8)


def test_the_axis_of_a_joint_is_x_where_none_is_given(tmp_path: Path) -> None:
    along_x = link("a").replace('ixx="0.02"', 'ixx="0.035"')
    model = load(tmp_path, robot(link("base", 0), along_x, joint("turn", "continuous", "base", "a")))
    assert mass_matrix(model, {"turn": 0.3}) == pytest.approx([0.035])


def test_planar_and_floating_joints(tmp_path: Path) -> None:
    parts = link("base", 0), link("cart", 3), link("drone", 2)
    model = load(
        tmp_path,
        robot(
            *parts,
            joint("drive", "planar", "base", "cart", '<axis xyz="0 0 1"/>'),
            joint("fly", "floating", "base", "drone"),
        ),
    )
    names = ["drive_x", "drive_y", "drive_angle", "fly_x", "fly_y", "fly_z", "fly_e0", "fly_e1", "fly_e2", "fly_e3"]
    assert [c.name for c in model.coordinates] == names
    assert [row.name for row in model.constraints] == ["fly_norm"]
    state = {**dict.fromkeys([c.name for c in model.coordinates], 0.0), "fly_e0": 1.0}
    assert mass_matrix(model, state)[:23:11] == pytest.approx([3, 3, 0.02])


def test_mimics_are_constraints(tmp_path: Path) -> None:
    mimic = f'<axis xyz="0 0 1"/><mimic joint="a" multiplier="-2.5" offset="0.1"/>{LIMIT}'
    text = robot(
        link("base", 0),
        link("one"),
        link("two"),
        joint("a", "continuous", "base", "one", '<axis xyz="0 0 1"/>'),
        joint("b", "revolute", "one", "two", mimic),
    )
    model = load(tmp_path, text, f"{HEAD}inputs: {{drive: {{joint: a}}}}\n")
    assert [(row.name, row.kind) for row in model.constraints] == [("b_mimic", "geometric")]
    mechanics = System(model)
    assert Evaluator(mechanics.constraint_residual)({"a": 0.4, "b": 0.7}) == pytest.approx([0.7 + 2.5 * 0.4 - 0.1])


def test_the_model_file_places_the_root(tmp_path: Path) -> None:
    joints = "joints: {free: {type: prismatic, child: base, axis: z, coordinate: lift}}\n"
    model = load(tmp_path, ARM, HEAD + joints)
    assert [c.name for c in model.coordinates] == ["shoulder", "elbow", "lift"]
    state = state_of(model, 1)
    assert mass_matrix(model, state)[8] == pytest.approx(3.5)
    fixed = load(tmp_path, ARM, f"{HEAD}frames: {{base: {{translation: [0, 0, 7]}}}}\ndefinitions: {{h: upper.z}}\n")
    assert Evaluator([System(fixed).names["h"]])({"shoulder": 0.0}) == pytest.approx([7.3])


def test_a_root_called_world_is_the_world(tmp_path: Path) -> None:
    model = load(tmp_path, ARM.replace('"base"', '"world"'))
    assert [frame.parent for frame in model.mechanism.frames] == ["world", "upper"]


def test_names_of_their_own(tmp_path: Path) -> None:
    text = ARM.replace('"shoulder"', '"joint-1"').replace('"upper"', '"2nd link"')
    model = load(tmp_path, text, HEAD.replace("robot.urdf", "{file: robot.urdf, frames: {second: 2nd link}}"))
    assert [c.name for c in model.coordinates] == ["joint_1", "elbow"]
    assert "second" in {frame.name for frame in model.mechanism.frames}
    assert "names of the URDF with characters that names of a model cannot have: joint-1 is joint_1" in [
        notice.message for notice in model.notices
    ]


def test_dry_friction_needs_its_width(tmp_path: Path) -> None:
    text = ARM.replace('damping="0.1"', 'damping="0.1" friction="0.4"')
    with pytest.raises(ModelError, match="the dry friction of the joint `elbow` has no width"):
        load(tmp_path, text)
    model = load(tmp_path, text, HEAD.replace("robot.urdf", "{file: robot.urdf, friction_width: 0.01}"))
    rest = {"shoulder": 0.2, "elbow": 0.3, "elbow_dot": 0.5}
    force = Evaluator(System(model).applied_force)({**rest, "shoulder_dot": 0.0})
    assert force == pytest.approx([0, -0.1 * 0.5 - 0.4])
    other = load(tmp_path, text, f"{HEAD}friction: {{elbow: {{viscous: 3}}}}\n")
    assert Evaluator(System(other).applied_force)(rest) == pytest.approx([0, -1.5])


def test_numbers_stay_as_they_are_written(tmp_path: Path) -> None:
    model = load(tmp_path, ARM.replace('value="1.5"', 'value="+1.234567890123456789"'))
    mass = next(body.mass for body in model.mechanism.bodies if body.name == "lower")
    assert mass == Number(Fraction("1.234567890123456789"))


def test_a_long_line_of_fixed_links_is_added_up_at_once(tmp_path: Path) -> None:
    """200 small masses along a line that turns back and forth, against their sum in doubles."""
    count = 200
    parts = [link("base", 0), *(link(f"l{k}", 0.01, 1e-5) for k in range(count))]
    joints = [joint("turn", "continuous", "base", "l0", '<axis xyz="0 0 1"/>')]
    for k in range(1, count):
        angle = 0.3 if k % 2 else -0.3
        joints.append(joint(f"w{k}", "fixed", f"l{k - 1}", f"l{k}", f'<origin xyz="0.01 0 0" rpy="0 0 {angle}"/>'))
    x = y = total = 0.0
    for k in range(count):
        total += 1e-5 + 0.01 * (x * x + y * y)
        x, y = x + 0.01 * cos(0.3 * (k % 2)), y + 0.01 * sin(0.3 * (k % 2))
    model = load(tmp_path, robot(*parts, *joints))
    assert len(model.mechanism.bodies) == 1
    assert mass_matrix(model, {"turn": 0.1}) == pytest.approx([total], rel=1e-12)


def test_the_robot_is_part_of_the_model_s_identity(tmp_path: Path) -> None:
    assert load(tmp_path, ARM).text_hash != load(tmp_path, ARM.replace("1.5", "1.6")).text_hash


FOUR_BAR = robot(
    link("ground", 0),
    link("crank", 1, 0.01, '<origin xyz="0.1 0 0"/>'),
    link("coupler", 2, 0.03, '<origin xyz="0.25 0 0"/>'),
    link("rocker", 1.5, 0.02, '<origin xyz="0.2 0 0"/>'),
    joint("a", "continuous", "ground", "crank", '<axis xyz="0 0 1"/>'),
    joint("b", "continuous", "crank", "coupler", '<origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>'),
    joint("c", "continuous", "ground", "rocker", '<origin xyz="0.6 0 0"/><axis xyz="0 0 1"/>'),
)
CLOSED = """\
model: four_bar
urdf: robot.urdf
gravity: [0, -9.81, 0]
points:
  tip: {frame: coupler, at: [0.5, 0, 0]}
  pin: {frame: rocker, at: [0.4, 0, 0]}
loops: {cut: {type: point, between: [tip, pin]}}
inputs: {motor: {unit: N*m, joint: a}}
configuration: {a: 1, b: 5.7, c: 1.4}
outputs: [inverse_dynamics, forward_dynamics]
"""


@pytest.mark.campaign
@pytest.mark.slow
def test_a_loop_in_the_model_file_closes_a_four_bar_verified_all_the_way(tmp_path: Path) -> None:
    model = load(tmp_path, FOUR_BAR, CLOSED)
    assert [row.name for row in model.constraints] == ["cut_x", "cut_y"]
    (tmp_path / "robot.yaml").write_text(CLOSED, encoding="utf-8")
    result = generate(tmp_path / "robot.yaml", Options(parts=("python",), states=8), lambda _: None)
    assert result.failures == ()
    assert result.certificate is not None


def test_the_reader_is_loaded_where_it_is_used_only(tmp_path: Path) -> None:
    script = (
        "import sys; from symgen.model.load import load_text; "
        "load_text('model: m\\ncoordinates: {x: {}}\\nkinetic_energy: x_dot**2\\n', 'm.yaml'); print(*sys.modules)"
    )
    made = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert not [name for name in made.stdout.split() if "urdf" in name or "expat" in name]
