"""Motors of a catalogue: what each has to do at each drive, with its own inertia in place of the model's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from studied_arm import arm_file, plan_of, results_of

from symgen.cli.main import main
from symgen.study.sizing.choice import motor_fits, sizing_lines, sizing_tables

pytestmark = pytest.mark.toolchain

HEAD = "motor,peak_torque [N*m],rated_torque [N*m],speed [rad/s],inertia [kg*m**2],ratio\n"
MOTORS = HEAD + "small,0.4,0.15,400,2e-5,30\nlarge,5,3,600,3e-4,30\nslow,15,8,20,3e-3,10\n"
# the forearm is driven by a belt from the base, so that its drive acts on b with a share of -2; the slide by a screw
GANTRY = """model: gantry
parameters: {arm: {value: 0.3, unit: m}, J: {value: 0.02, range: [0.01, 0.05]}, m: {value: 3, range: [1, 5]}}
joints:
  slide: {type: prismatic, axis: z, coordinate: s}
  elbow: {type: revolute, parent: slide, at: [0.1, 0, 0], axis: y, coordinate: b}
bodies:
  slide: {mass: 4}
  elbow: {mass: m, com: [0.4, 0, 0], inertia: {yy: 0.1}}
gravity: [0, 0, -9.81]
ROTORS
inputs:
  lift: {joint: s, unit: N}
  bend: {unit: N*m, acts_on: {b: -2}}
  both: {unit: N, acts_on: {s: 1, b: arm}}
allocation: {weights: {both: 1e9}}
outputs: [inverse_dynamics]
configuration: {s: 0.2, b: 0.3}
paths:
  hop: {duration: 1, samples: 33, conditions: {of_s: s - 0.2 - 0.1*sin(7*t), of_b: b - 0.3 - 0.5*sin(9*t)}}
"""


@pytest.fixture
def catalogue(tmp_path: Path) -> Path:
    path = tmp_path / "motors.csv"
    path.write_text(MOTORS, encoding="utf-8")
    return path


def gantry(folder: Path, rotors: str) -> Path:
    """The model file with these rotor inertias."""
    path = folder / "gantry.yaml"
    path.write_text(GANTRY.replace("ROTORS", rotors), encoding="utf-8")
    return path


@pytest.mark.campaign
def test_a_motor_at_a_drive_is_the_model_with_its_inertia(catalogue: Path, tmp_path: Path) -> None:
    """What the third input, which hardly takes part, leaves to the two drives is what they would do with the inertia of
    the motor in the model, reflected by its gear."""
    model = gantry(tmp_path, "rotor_inertias: {s: J, b: 2*J}")
    over = ["J=0.01:0.05:3", "m=1:5:2"]
    plan = plan_of(over, "inputs", model=model, along=("hop",), size=catalogue)
    assert [(one.name, one.share) for one in plan.drives] == [("lift", 1.0), ("bend", -2.0)]
    sized = results_of(tmp_path / "first/partial", plan)
    for k, motor in enumerate(plan.request.motors):
        (tmp_path / motor.name).mkdir()
        at_s, at_b = (motor.inertia * (motor.ratio * share) ** 2 for share in (1, -2))
        other = gantry(tmp_path / motor.name, f"rotor_inertias: {{s: {at_s!r}, b: {at_b!r}}}")
        again = plan_of(["m=1:5:2"], "inputs", model=other, along=("hop",))
        inputs = results_of(tmp_path / motor.name / "partial", again)
        for d in range(2):
            own = sized.motor_torque_largest.values[..., len(plan.request.motors) * d + k] * motor.ratio
            expected = np.broadcast_to(inputs.inputs_largest.values[:, d], own.shape)
            # of the third input 1e-9 is left
            assert np.allclose(own, expected, rtol=1e-7)
            rms = sized.motor_torque_rms.values[..., len(plan.request.motors) * d + k] * motor.ratio
            assert np.allclose(rms, np.broadcast_to(inputs.inputs_rms.values[:, d], rms.shape), rtol=1e-7)
    assert np.allclose(sized.drive_speed_largest.values, [0.7, 9.0], rtol=1e-3)


def test_what_fits_is_listed_and_what_it_needs_most_of_otherwise(catalogue: Path, tmp_path: Path) -> None:
    plan = plan_of(["m=1:2:2"], "inputs", model=gantry(tmp_path, ""), along=("hop",), size=catalogue)
    results = results_of(tmp_path / "work/partial", plan)
    fits = motor_fits(plan, results)
    for k, of_drive in enumerate(fits):
        for j, one in enumerate(of_drive):
            column, motor = 3 * k + j, one.motor
            assert one.peak == float(results.motor_torque_largest.values[:, column].max()) / motor.peak_torque
            assert one.rated == float(results.motor_torque_rms.values[:, column].max()) / motor.rated_torque
            assert one.speed == float(results.drive_speed_largest.values[:, k].max()) * motor.ratio / motor.speed
    lines = list(sizing_lines(fits))
    assert [line.split()[:2] for line in lines[1:]] == [["lift", "large"], ["lift", "slow"], ["bend", "large"]]
    _, inertias = sizing_tables(plan, fits)
    assert [row[:2] for row in inertias[2]] == [("s", "large"), ("b", "large")]
    assert [float(row[2]) for row in inertias[2]] == [pytest.approx(3e-4 * 30**2), pytest.approx(3e-4 * 60**2)]


def test_without_one_that_fits_the_nearest_is_told(tmp_path: Path, catalogue: Path) -> None:
    catalogue.write_text(HEAD + "tiny,1e-3,1e-3,400,0,30\n", encoding="utf-8")
    plan = plan_of(["m=1:2:2"], "inputs", model=gantry(tmp_path, ""), along=("hop",), size=catalogue)
    fits = motor_fits(plan, results_of(tmp_path / "work/partial", plan))
    lines = list(sizing_lines(fits))
    assert "lift  none: tiny needs" in lines[1]
    assert "torque" in lines[1]
    assert sizing_tables(plan, fits)[1][2] == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "motors.csv:1:1: there is no column `motor`"),
        ("motor;peak_torque\n", "columns are separated by `;`"),
        (MOTORS.replace("[rad/s]", "[1/min]"), "the unit of `speed`, `1/min`, is not read"),
        (MOTORS.replace("ratio", "ration", 1), "motors.csv:1:76: unknown column `ration`"),
        (HEAD, "there is no motor in the catalogue"),
        (HEAD + "a,1,1,1,0,1\na,1,1,1,0,1\n", "motors.csv:3:1: a second motor `a`"),
        (HEAD + "a,1,1,1,0\n", "motors.csv:2:1: 5 cells where the first line has more"),
        (HEAD + "a,1,1,one,0,1\n", "motors.csv:2:7: `one` is no number"),
        (HEAD + "a,1,0,1,-1,1\n", "`rated_torque` is 0"),
        (HEAD + "a,1,0,1,-1,1\n", "`inertia` is -1"),
        (HEAD + "".join(f"a{k},1,1,1,0,1\n" for k in range(51)), "51 motors are too many"),
    ],
)
def test_a_mistake_in_a_catalogue_has_its_place(
    text: str, expected: str, catalogue: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    catalogue.write_text(text, encoding="utf-8")
    options = ["--over", "m=1:2:2", "--along", "swing", "--show", "inputs", "--size", str(catalogue), "--quiet"]
    assert main(["study", str(arm_file()), *options, "--out", str(tmp_path / "out")]) == 1
    assert expected in capsys.readouterr().err


def test_motors_need_a_motion_and_a_drive(
    catalogue: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    common = ["--over", "m=1:2:2", "--show", "inputs", "--size", str(catalogue), "--out", str(tmp_path), "--quiet"]
    assert main(["study", str(arm_file()), *common]) == 2
    assert "--size: motors are sized for a motion, and the study has none; add --along" in capsys.readouterr().err
    model = tmp_path / "pushed.yaml"
    text = GANTRY.replace("ROTORS", "").replace("joint: s", "acts_on: {s: 2, b: arm}")
    text = text.replace("{b: -2}", "{b: cos(b)}")
    model.write_text(text, encoding="utf-8")
    assert main(["study", str(model), *common, "--along", "hop"]) == 2
    assert "--size: no input acts along one coordinate in a constant ratio" in capsys.readouterr().err


@pytest.mark.usefixtures("catalogue")
def test_a_study_file_names_its_catalogue(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gantry(tmp_path, "")
    study = tmp_path / "study.yaml"
    text = "model: gantry.yaml\nover: {m: [1, 2, 2]}\nalong: hop\nshow: [inputs]\nsize: motors.csv\n"
    study.write_text(text, encoding="utf-8")
    assert main(["study", str(study), "--out", str(tmp_path / "out")]) == 0
    assert "motors that fit\n    lift  large  peak" in capsys.readouterr().out
    page = (tmp_path / "out/gantry/study.html").read_text(encoding="utf-8")
    assert "<td>bend</td><td>slow</td>" in page
    study.write_text(text.replace("motors.csv", "../etc/none.csv"), encoding="utf-8")
    assert main(["study", str(study), "--out", str(tmp_path / "out")]) == 1
    assert "study.yaml:5:7: there is no catalogue ../etc/none.csv seen from this file" in capsys.readouterr().err


