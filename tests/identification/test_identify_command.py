"""`symgen identify` from log to model file, and what it answers where it cannot."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from identified_machines import FOUR_BAR_WITH_NAMES, MACHINES_WITH_LOGS
from simulated_logs import Sensors, of_file, simulated_log

from symgen.backends.backend import Variant
from symgen.backends.python import backend
from symgen.backends.python.module import emit_python
from symgen.cli.main import main
from symgen.generation.results import Options
from symgen.identification import machine_functions
from symgen.identification.bodies.pseudo_inertia import pseudo_inertia
from symgen.identification.combinations import base_map, inertial_values
from symgen.identification.estimates import command
from symgen.identification.estimates.parameter_file import WrittenFile
from symgen.identification.reported.document import identification_document
from symgen.ir.kernel import Program
from symgen.model.combinations.base_parameters import base_parameters
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.report.document import Table
from symgen.report.html import plain, render_html
from symgen.report.mathematics.typst import quoted
from symgen.report.pdf import render_typst

ARM_MACHINE = MACHINES_WITH_LOGS["arm"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The arm's model file and a log of it."""
    made = tmp_path_factory.mktemp("identify")
    (made / "arm.yaml").write_text(ARM_MACHINE.text, encoding="utf-8")
    log = simulated_log(ARM_MACHINE.text, ARM_MACHINE.motion, ARM_MACHINE.measured, ARM_MACHINE.truth, Sensors())
    log.write(made)
    return made


@pytest.fixture(autouse=True)
def few_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """Functions are verified at few states: they are the same."""
    monkeypatch.setattr(machine_functions, "Options", partial(Options, states=8))


def run(folder: Path, log: str, out: str, *options: str) -> int:
    return main(["identify", str(folder / "arm.yaml"), str(folder / log), "--out", str(folder / out), *options])


def changed_log(folder: Path, file: str, header: str, columns: str = "t,a,b,u_a,u_b") -> str:
    """The log with another first line, and with columns left or changed by an expression of their names."""
    lines = (folder / "log.csv").read_text(encoding="utf-8").splitlines()
    places = {column: k for k, column in enumerate(lines[0].split(","))}
    rows = [line.split(",") for line in lines[1:]]
    names = columns.split(",")
    kept = [",".join(row[places[name]] if name in places else name for name in names) for row in rows]
    (folder / file).write_text("\n".join([header, *kept]) + "\n", encoding="utf-8")
    return file


def test_from_a_log_to_a_model_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "log.csv", "out") == 0
    printed = capsys.readouterr()
    assert max(map(len, printed.out.replace(str(folder), "").splitlines())) <= 80
    made = folder / "out" / "arm_with_friction"
    assert f"written:\n  {made}/identified.json" in printed.out
    assert "shoulder.mx + l elbow.m" in printed.out
    assert "w stays as it is: the inputs are not linear in it" in printed.out
    model = load_model(made / "arm.identified.yaml")
    values = default_values(model.parameters)
    for name in ("d_1", "f_1", "d_2", "k"):
        assert values[name] == pytest.approx(ARM_MACHINE.truth[name], rel=0.05)
    assert "# upper arm" in (made / "arm.identified.yaml").read_text(encoding="utf-8")


def test_the_model_file_is_as_good_as_the_estimates(folder: Path) -> None:
    """Identified once more from the same log, it does not move by more than its errors."""
    assert run(folder, "log.csv", "once", "--quiet") == 0
    made = folder / "once" / "arm_with_friction"
    second = folder / "second.yaml"
    second.write_text((made / "arm.identified.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    assert main(["identify", str(second), str(folder / "log.csv"), "--out", str(folder / "twice"), "--quiet"]) == 0
    record = json.loads((folder / "twice" / "arm_with_friction" / "identified.json").read_text(encoding="utf-8"))
    for one in record["file"]:
        assert abs(one["value"] - one["before"]) < one["standard_error"]


@pytest.mark.campaign
def test_the_record_is_the_same_each_time(folder: Path) -> None:
    assert run(folder, "log.csv", "first", "--quiet") == run(folder, "log.csv", "again", "--quiet") == 0
    texts = [
        {path.name: path.read_bytes() for path in (folder / out / "arm_with_friction").iterdir() if path.name[0] != "."}
        for out in ("first", "again")
    ]
    assert texts[0] == texts[1]
    assert {*texts[0]} == {"identified.json", "identified.html", "identified.pdf", "arm.identified.yaml"}
    record = json.loads(texts[0]["identified.json"])
    assert record["measured"] == ["a", "b"]
    assert len(record["covariance"]) == len(record["parameters"]) == 11
    assert str(folder) not in texts[0]["identified.json"].decode()


def test_the_page_stands_by_itself(folder: Path) -> None:
    assert run(folder, "log.csv", "page", "--quiet") == 0
    page = (folder / "page" / "arm_with_friction" / "identified.html").read_text(encoding="utf-8")
    assert page.count("<svg") == page.count("</svg>") == 2
    assert not re.search(r'(src|href)="(?!#)', page)
    for text in ("shoulder.mx + l elbow.m", "u_a", "Parameters of the file", "one of "):
        assert text.replace(" ", "") in page.replace("\u00a0", "").replace(" ", "")


def test_page_and_pdf_say_the_same(folder: Path) -> None:
    """Both are made of one document: what its tables hold is in the page and in the source of the PDF."""
    made = of_file(folder / "log.csv", ARM_MACHINE.text, ARM_MACHINE.measured)
    document = identification_document(made, WrittenFile(None, "it is not asked for"))
    page, source = render_html(document), render_typst(document)
    cells = [cell[0] for section in document.sections for block in section.blocks if isinstance(block, Table)
             for row in block.rows for cell in row if cell]  # fmt: skip
    assert len(cells) > 100
    assert isinstance(cells[0], str)
    for cell in map(str, cells):
        assert plain(cell) in page
        assert quoted(cell) in source
    for text in ("Whole bodies", "No model file is written: it is not asked for.", "As entries of a model file"):
        assert text in page
        assert text in source


def test_the_pdf_is_one(folder: Path) -> None:
    assert run(folder, "log.csv", "pdf", "--quiet") == 0
    made = (folder / "pdf" / "arm_with_friction" / "identified.pdf").read_bytes()
    assert made.startswith(b"%PDF-")
    assert made.rstrip().endswith(b"%%EOF")


def test_the_pdf_is_left_out_where_its_package_lacks(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "find_spec", lambda name: None if name == "typst" else object())
    assert run(folder, "log.csv", "without") == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "the PDF is left out: it needs typst, which is not installed: pip install 'symgen[report]'" in text
    assert not (folder / "without" / "arm_with_friction" / "identified.pdf").exists()


@pytest.mark.slow
def test_whole_bodies_generate_and_verify_at_once(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The file with whole bodies has the estimates as base parameters, and what cannot be is in no body."""
    assert run(folder, "log.csv", "whole", "--whole-bodies") == 0
    assert "bodies that can be are " in capsys.readouterr().out
    made = folder / "whole" / "arm_with_friction"
    model = load_model(made / "arm.identified.yaml")
    assert all("is not used" in notice.message for notice in model.notices)
    tens = inertial_values(model, default_values(model.parameters)).reshape(2, 10)
    assert all(np.linalg.eigvalsh(pseudo_inertia(ten))[0] > 0 for ten in tens)
    record = json.loads((made / "identified.json").read_text(encoding="utf-8"))
    combined = base_map(base_parameters(model)) @ tens.ravel()
    estimates = [(one["value"], one["standard_error"]) for one in record["parameters"][: len(combined)]]
    for value, (estimate, error) in zip(combined, estimates, strict=True):
        assert abs(value - estimate) < 0.5 * error
    options = ("--only", "python", "--states", "8", "--quiet", "--out", str(folder / "generated"))
    assert main([str(made / "arm.identified.yaml"), *options]) == 0


def test_numbers_that_are_wrong_lead_to_whole_bodies(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A lower arm in numbers cannot follow the log: the command says what can, and that file is right."""
    numbers = folder / "numbers.yaml"
    lower = "elbow: {mass: 1.0, com: [0.15, 0, 0], inertia: {zz: 0.012}}"
    text = ARM_MACHINE.text.replace("elbow: {mass: m_2, com: [c_2, 0, 0], inertia: {zz: J_2}}", lower)
    assert lower in text
    numbers.write_text(text, encoding="utf-8")
    asked = ["identify", str(numbers), str(folder / "log.csv"), "--out", str(folder / "wider"), "--whole-bodies"]
    assert main(asked[:-1]) == 0
    plain = " ".join(capsys.readouterr().out.split())
    assert "`--whole-bodies` writes bodies that do" in plain
    assert "numbers, which stay as they are" in plain
    assert main(asked) == 0
    whole = capsys.readouterr().out
    assert "--whole-bodies" not in whole
    assert "which stay as they are" not in whole
    model = load_model(folder / "wider" / "arm_with_friction" / "numbers.identified.yaml")
    # what is printed of the file is what stands in it
    printed = dict(re.findall(r"^  ([df]_\d|k) +\S+ +(\S+) +\S+$", whole.split("in the file")[1], re.M))
    assert sorted(printed) == ["d_1", "d_2", "f_1", "f_2", "k"]
    written = default_values(model.parameters)
    assert all(float(x) == pytest.approx(written[name], rel=1e-3) for name, x in printed.items())
    tens = inertial_values(model, default_values(model.parameters))
    truth = ARM_MACHINE.truth
    assert tens[11] == pytest.approx(truth["m_2"] * truth["c_2"], rel=0.05)
    assert tens[16] == pytest.approx(truth["J_2"] + truth["m_2"] * truth["c_2"] ** 2, rel=0.1)


def test_rates_of_the_log_are_used(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Rates that are wrong by far spoil the fit: so they are read."""
    name = changed_log(folder, "rates.csv", "t,a,b,u_a,u_b,a_dot", "t,a,b,u_a,u_b,7")
    run(folder, name, "rates")
    assert "more than noise is left" in capsys.readouterr().out


def test_a_cut_off_may_be_given(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "log.csv", "cut", "--cutoff", "9") == 0
    assert "low-pass at 9 Hz" in capsys.readouterr().out.replace("\n  ", " ")


@pytest.mark.parametrize(
    ("cutoff", "message"),
    [
        ("101", "a cut-off is at most 100 Hz, a fifth of the rate of samples"),
        ("0.5", "samples are left at a cut-off of 0.5 Hz, too few for 11 parameters: record a longer motion"),
    ],
)
def test_a_cut_off_that_leaves_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], cutoff: str, message: str
) -> None:
    assert run(folder, "log.csv", "none", "--cutoff", cutoff) == 1
    assert message in " ".join(capsys.readouterr().err.split())


def test_a_log_of_another_machine(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = changed_log(folder, "other.csv", "t,b,a,u_a,u_b")
    assert run(folder, name, "other") == 1
    assert "the log is not of this machine as the model has it" in capsys.readouterr().err.replace("\n  ", " ")
    made = folder / "other" / "arm_with_friction"
    assert not (made / "arm.identified.yaml").exists()
    assert "the log contradicts the model" in (made / "identified.html").read_text(encoding="utf-8")


def test_a_log_without_motion(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = changed_log(folder, "still.csv", "t,a,b,u_a,u_b", "t,0.3,0.5,u_a,u_b")
    assert run(folder, name, "still") == 1
    assert "still.csv: not identified: nothing moves in this log" in capsys.readouterr().err.replace("\n  ", " ")
    assert not (folder / "still").exists()


def test_functions_that_verification_rejects_are_not_fitted_with(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Differences that are sums in the Python are refused by name, and nothing is written."""

    def wrong(model: Model, program: Program) -> dict[str, str]:
        return {path: text.replace(" - ", " + ") for path, text in emit_python(model, program).items()}

    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=(Variant(wrong),)))
    assert run(folder, "log.csv", "rejected") == 1
    errors = capsys.readouterr().err.replace("\n  ", " ")
    assert "arm.yaml: not identified: verification rejects what would be fitted with" in errors
    for text in ("inverse_dynamics,", "inverse_dynamics: remedy: give narrower `ranges`"):
        assert text in errors
    assert not (folder / "rejected").exists()


def test_one_joint_that_stands_still(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What it would show stays as it is, by name, and the rest is estimated."""
    name = changed_log(folder, "half.csv", "t,a,b,u_a,u_b", "t,a,0.5,u_a,u_b")
    run(folder, name, "half")
    printed = capsys.readouterr().out
    assert "d_2 stays as it is: this motion does not show it" in printed
    assert re.search(r"f_1 +0\.\d+ +0\.\d+", printed)


def test_mistakes_in_a_log_are_told_with_their_places(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = changed_log(folder, "wrong.csv", "t,a [deg],b,u_a,u", "t,a,b,nan,u_b")
    assert run(folder, name, "wrong") == 1
    text = capsys.readouterr().err
    for message in ("wrong.csv:1:3: the unit of `a`", "unknown column `u`", "no column `u_b`", "no measured value"):
        assert message in text
    assert text.count("remedy:") >= 4


def test_models_that_cannot_be_identified(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pendulum = folder / "pendulum.yaml"
    pendulum.write_text(
        "model: pendulum\ncoordinates: {a: {unit: rad}}\nkinetic_energy: a_dot**2/2\npotential_energy: -cos(a)\n"
        "inputs: {u: {acts_on: {a: 1}}}\n",
        encoding="utf-8",
    )
    assert main(["identify", str(pendulum), str(folder / "log.csv"), "--out", str(folder / "none")]) == 1
    assert "no parameter of the energies is left to identify" in capsys.readouterr().err.replace("\n  ", " ")
    rough = folder / "rough.yaml"
    friction = "b: {viscous: d_2, coulomb: f_2, width: w}"
    text = ARM_MACHINE.text.replace(friction, "elbow: {coulomb: 0.1, radius: 0.01, width: 0.1}")
    rough.write_text(text, encoding="utf-8")
    assert main(["identify", str(rough), str(folder / "log.csv"), "--out", str(folder / "none")]) == 1
    assert "friction that grows with reactions is not linear" in capsys.readouterr().err.replace("\n  ", " ")


@pytest.mark.parametrize(
    ("first", "last", "message"),
    [
        (1.8, 1.2, r"log\.csv:(\d+): not identified: no configuration of the model has these measured coordinates"),
        (1.2, 1.1, r"log\.csv:(2): not identified: the first sample is not reached from the configuration"),
    ],
)
def test_a_rocker_out_of_reach(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], first: float, last: float, message: str
) -> None:
    """Crank and coupler in line are 1.3 long: the law of cosines gives the angle at which the rocker stops."""
    (tmp_path / "bars.yaml").write_text(FOUR_BAR_WITH_NAMES, encoding="utf-8")
    t = np.arange(1000) / 100
    c = first + (last - first) * np.sin(np.pi * t / 10) ** 2
    rows = (f"{a:.2f},{b:.9g},0,0" for a, b in zip(t, c, strict=True))
    (tmp_path / "log.csv").write_text("\n".join(["t,c,u,v", *rows]) + "\n", encoding="utf-8")
    assert main(["identify", str(tmp_path / "bars.yaml"), str(tmp_path / "log.csv"), "--out", str(tmp_path)]) == 1
    printed = " ".join(capsys.readouterr().err.split())
    line = re.search(message, printed)
    assert line, printed
    least = np.arccos((1.3**2 - 1 - 0.7**2) / (2 * 0.7))
    sample = int(line[1]) - 2
    # filtered, the rocker gets there a little earlier or later
    assert c[sample] < least + 0.02
    assert sample == 0 or c[sample] > least - 0.02


def test_a_missing_log(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "nothing.csv", "nothing") == 2
    assert "no such file" in capsys.readouterr().err
