"""`symgen excite` from a model file to its files, and what it answers where there is no motion."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from excited_machines import ARM_WITH_LIMITS, SWINGING_FOUR_BAR, short_designs
from identified_machines import ARM_WITH_FRICTION, ROOT

from symgen.cli.main import main

PERIOD = ("--period", "4")


@pytest.fixture(autouse=True)
def few_states() -> Iterator[None]:
    with short_designs():
        yield


def excite(folder: Path, text: str, *options: str, out: str = "out") -> int:
    (folder / "machine.yaml").write_text(text, encoding="utf-8")
    return main(["excite", str(folder / "machine.yaml"), "--out", str(folder / out), *options])


def said(capsys: pytest.CaptureFixture[str]) -> str:
    return " ".join(capsys.readouterr().err.split())


@pytest.mark.campaign
def test_the_same_seed_gives_the_same_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    texts = []
    for out, seed in (("first", "0"), ("again", "0"), ("other", "1")):
        assert excite(tmp_path, ARM_WITH_LIMITS, *PERIOD, "--seed", seed, out=out) == 0
        made = tmp_path / out / "arm_with_friction"
        texts.append({path.name: path.read_bytes() for path in made.iterdir() if path.name[0] != "."})
    assert texts[0] == texts[1]
    assert {*texts[0]} == {"excitation.csv", "excitation.svg", "excitation.paths.yaml"}
    assert all(texts[0][name] != texts[2][name] for name in texts[0])
    printed = capsys.readouterr()
    assert max(map(len, printed.out.replace(str(tmp_path), "").splitlines())) <= 80
    assert "arm_with_friction: 4 s, led by a, b; condition number" in printed.out
    # all limits are those of the file
    assert "no range" not in printed.out
    assert "no `limits`" not in printed.out
    for stage in ("verifying", "looking for motions within limits", "improving", "checking the motion"):
        assert f"machine: {stage}" in printed.err
    assert b"<svg" in texts[0]["excitation.svg"]


def test_identify_reads_the_file(tmp_path: Path) -> None:
    """Its inputs are those of the file's parameters, so that these come out as they are."""
    assert excite(tmp_path, ARM_WITH_LIMITS, *PERIOD, "--quiet") == 0
    log = tmp_path / "out" / "arm_with_friction" / "excitation.csv"
    with log.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [*rows[0]] == ["t", "a", "b", "a_dot", "b_dot", "a_ddot", "b_ddot", "u_a", "u_b"]
    assert len(rows) == 1001
    assert main(["identify", str(tmp_path / "machine.yaml"), str(log), "--out", str(tmp_path / "id"), "--quiet"]) == 0
    record = json.loads((tmp_path / "id" / "arm_with_friction" / "identified.json").read_text(encoding="utf-8"))
    assert record["unexplained"] < 1e-3
    for one in record["parameters"]:
        assert one["value"] == pytest.approx(one["before"], abs=2e-3 + 0.02 * abs(one["before"]))


@pytest.mark.campaign
def test_what_the_file_leaves_open_is_taken_and_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert excite(tmp_path, ARM_WITH_FRICTION, *PERIOD) == 0
    printed = " ".join(capsys.readouterr().out.split())
    for text in (
        "no range of a, b: half a turn or a unit about the configuration is taken",
        "no range of a_dot, b_dot: one range of the coordinate in a second is taken",
        "no range of a_ddot, b_ddot: accelerations are as the rates and the period have them",
        "no `limits` of all inputs under `allocation`",
    ):
        assert text in printed
    table = np.genfromtxt(
        tmp_path / "out/arm_with_friction/excitation.csv", delimiter=",", names=True, dtype=np.float64
    )
    # half a turn to both sides, which is passed in half a second at least
    for name in ("a", "b"):
        assert np.max(np.abs(table[name])) <= np.pi
        assert np.max(np.abs(table[f"{name}_dot"])) <= 2 * np.pi


@pytest.mark.parametrize(
    ("changes", "options", "message"),
    [
        ((("u_a: [-16, 16]", "u_a: [-3, 3]"),), (), "u_a is beyond its limit; give it wider limits, a longer --period"),
        ((("a: [-1.2, 1.4]", "a: [0.2, 1.4]"),), (), "a is beyond its limit; give it a wider range, or a `conf"),
    ],
)
def test_no_motion_within_limits(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    changes: tuple[tuple[str, str], ...],
    options: tuple[str, ...],
    message: str,
) -> None:
    text = ARM_WITH_LIMITS
    for old, new in changes:
        text = text.replace(old, new)
    assert excite(tmp_path, text, *options) == 1
    errors = said(capsys)
    assert "machine.yaml: no motion: no feasible motion: even next to the configuration of the model" in errors
    assert message in errors
    assert not (tmp_path / "out").exists()


@pytest.mark.campaign
def test_a_distance_that_the_configuration_does_not_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert excite(tmp_path, SWINGING_FOUR_BAR, "--distance", "0.9") == 1
    errors = said(capsys)
    assert "the distance from singularities of" in errors
    assert "further from a singularity, or a smaller --distance" in errors


def test_models_without_a_motion_to_identify_by(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    energies = (
        "model: pendulum\ncoordinates: {a: {unit: rad}}\nkinetic_energy: a_dot**2/2\npotential_energy: -cos(a)\n"
        "inputs: {u: {acts_on: {a: 1}}}\n"
    )
    assert excite(tmp_path, energies) == 1
    assert "the model has no `bodies`" in said(capsys)
    assert excite(tmp_path, ARM_WITH_LIMITS.split("inputs:")[0]) == 1
    assert "the model has no inputs: name those" in said(capsys)
    car = (ROOT / "models" / "front_car_bodies.yaml").read_text(encoding="utf-8")
    assert excite(tmp_path, car) == 1
    assert "drive a course with changes of speed and curvature" in said(capsys)


@pytest.mark.parametrize("wrong", [("--seed", "-1"), ("--seed", "x"), ("--period", "0"), ("--distance", "-0.1")])
def test_wrong_options(tmp_path: Path, wrong: tuple[str, str]) -> None:
    with pytest.raises(SystemExit) as ending:
        excite(tmp_path, ARM_WITH_LIMITS, *wrong)
    assert ending.value.code == 2


@pytest.mark.campaign
def test_a_controller_follows_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The path in the model file: computed torque is never more than a few thousandths off."""
    assert excite(tmp_path, ARM_WITH_LIMITS, *PERIOD, "--quiet") == 0
    path = (tmp_path / "out" / "arm_with_friction" / "excitation.paths.yaml").read_text(encoding="utf-8")
    (tmp_path / "tracked.yaml").write_text(ARM_WITH_LIMITS + path, encoding="utf-8")
    assert main(["simulate", str(tmp_path / "tracked.yaml"), "--track", "excitation", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "a drive at its limit" not in printed
    tracked, planned = (
        np.genfromtxt(tmp_path / file, delimiter=",", names=True, dtype=np.float64)
        for file in ("arm_with_friction/tracking.csv", "out/arm_with_friction/excitation.csv")
    )
    for name in ("a", "b"):
        assert np.max(np.abs(tracked[name] - np.interp(tracked["t"], planned["t"], planned[name]))) < 5e-3


@pytest.mark.campaign
def test_a_task_leads(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = ROOT / "models" / "five_bar.yaml"
    assert main(["excite", str(model), "--out", str(tmp_path)]) == 0
    assert "led by x, y; condition number" in capsys.readouterr().out
    assert {path.name for path in (tmp_path / "five_bar").iterdir() if path.name[0] != "."} == {
        "excitation.csv",
        "excitation.svg",
    }


@pytest.mark.campaign
def test_three_drives_for_two_directions(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The RA-PKM: arms stay closed, rates are those of the file, and no drawn motion is nearly as good."""
    assert main(["excite", str(ROOT / "models" / "rapkm_bodies.yaml"), "--out", str(tmp_path)]) == 0
    table = np.genfromtxt(tmp_path / "rapkm_bodies/excitation.csv", delimiter=",", names=True, dtype=np.float64)
    bases = ((0.0, 0.0), (0.4, 0.0), (0.2, 0.3464))
    tips = [
        np.array([x, y])[:, None]
        + 0.2 * np.array([np.cos(table[f"a_{k}"]), np.sin(table[f"a_{k}"])])
        + 0.2 * np.array([np.cos(table[f"a_{k}"] + table[f"b_{k}"]), np.sin(table[f"a_{k}"] + table[f"b_{k}"])])
        for k, (x, y) in enumerate(bases, 1)
    ]
    assert np.max(np.abs(tips[1] - tips[0])) < 1e-9
    assert np.max(np.abs(tips[2] - tips[0])) < 1e-9
    for k in (1, 2, 3):
        assert np.max(np.abs(table[f"b_{k}_dot"])) <= 10
        assert np.max(np.abs(table[f"a_{k}_ddot"])) <= 100
    printed = " ".join(capsys.readouterr().out.split())
    numbers = re.search(r"condition number ([\d.]+) of .*of drawn motions ([\d.]+) at best", printed)
    assert numbers is not None
    assert float(numbers[1]) < 0.7 * float(numbers[2])
