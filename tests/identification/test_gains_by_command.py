"""`symgen identify` with gains: what it prints and writes, and what it says of gains that a log does not tell."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path

import pytest
from gain_machines import MACHINES_BY_CURRENTS, MachineByCurrents, log_of_currents
from simulated_logs import Sensors

from symgen.cli.main import main
from symgen.generation.results import Options
from symgen.identification import machine_functions
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model


@pytest.fixture(autouse=True)
def few_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """Functions are verified at few states: they are the same."""
    monkeypatch.setattr(machine_functions, "Options", partial(Options, states=8))


def identify(folder: Path, machine: MachineByCurrents, *gains: str) -> int:
    (folder / "machine.yaml").write_text(machine.asked(*gains), encoding="utf-8")
    log_of_currents(machine, Sensors()).write(folder)
    return main(["identify", str(folder / "machine.yaml"), str(folder / "log.csv"), "--out", str(folder / "out")])


def test_gains_are_printed_and_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert identify(tmp_path, MACHINES_BY_CURRENTS["payload"], "k_1", "k_2") == 0
    printed = capsys.readouterr().out
    assert max(map(len, printed.replace(str(tmp_path), "").splitlines())) <= 80
    estimated, in_file = (re.findall(rf"^  k_1 .*{ending}$", printed, re.M) for ending in (r"\d", r"0\.9 .*\d"))
    assert len(estimated) == 2
    assert len(in_file) == 1
    made = tmp_path / "out" / "arm_with_friction"
    record = json.loads((made / "identified.json").read_text(encoding="utf-8"))
    rows = {one["name"]: one for one in record["parameters"]}
    assert rows["k_1"]["before"] == 0.9
    assert abs(rows["k_1"]["value"] - 0.72) < 3 * rows["k_1"]["standard_error"] < 0.03
    assert len(record["covariance"]) == len(record["parameters"])
    assert any(note.startswith("taken for known, as gains are told by what is") for note in record["notes"])
    (written,) = (one["value"] for one in record["file"] if one["name"] == "k_2")
    model = load_model(made / "machine.identified.yaml")
    values = default_values(model.parameters)
    assert values["k_2"] == pytest.approx(written, rel=1e-5)
    assert model.identify is not None
    assert model.identify.gains == ("k_1", "k_2")
    page = (made / "identified.html").read_text(encoding="utf-8")
    assert page.count("k_1") >= 2


def test_gains_that_stay_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert identify(tmp_path, MACHINES_BY_CURRENTS["slides"], "k_y") == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "k_y stays as it is: the log does not determine this gain" in printed
    record = json.loads((tmp_path / "out" / "two_slides" / "identified.json").read_text(encoding="utf-8"))
    assert "k_y" in record["kept"]
    assert "k_y" not in {one["name"] for one in (*record["parameters"], *record["file"])}
    text = (tmp_path / "out" / "two_slides" / "machine.identified.yaml").read_text(encoding="utf-8")
    assert "k_y: {value: 10.0, unit: N/A}" in text


def test_ratios_end_with_a_remedy(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert identify(tmp_path, MACHINES_BY_CURRENTS["arm"], "k_1", "k_2") == 1
    text = " ".join(capsys.readouterr().err.split())
    assert "machine.yaml: not identified: the log says how the gains `k_1`, `k_2` stand to each other" in text
    assert "leave one that is known out of `gains`, or state what is known" in text
    assert not (tmp_path / "out").exists()


def test_gains_that_are_not_asked_stay(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine = MACHINES_BY_CURRENTS["payload"]
    (tmp_path / "machine.yaml").write_text(machine.text, encoding="utf-8")
    log_of_currents(machine, Sensors()).write(tmp_path)
    main(["identify", str(tmp_path / "machine.yaml"), str(tmp_path / "log.csv"), "--out", str(tmp_path / "out")])
    printed = capsys.readouterr().out
    assert "k_1" not in printed
    assert "elbow.mx " in printed
    assert "taken for known" not in printed
