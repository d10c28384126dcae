"""Models of energies: products of parameters, what counts as geometry, and the arm that is also given by bodies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import MACHINES_WITH_LOGS, ROOT
from simulated_logs import Motion, Sensors, functions_of, of_file, simulated_log

from symgen.cli.main import main
from symgen.diagnostics import ModelError
from symgen.identification.combinations import default_like
from symgen.identification.energies.energy_terms import energy_terms
from symgen.identification.estimates.identification import Identification
from symgen.identification.reported.notes import notes
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model, load_text

ARM = MACHINES_WITH_LOGS["arm"]
WITHIN = 3.0
# The arm with friction and a spring once more, by its energies; its block of parameters is that of the other file.
ENERGIES = """
coordinates:
  a: {unit: rad}
  b: {unit: rad}
definitions:
  turn: a_dot + b_dot
kinetic_energy: >-
  (J_1 + m_1*c_1**2)/2*a_dot**2 + J_2/2*turn**2
  + m_2/2*(l**2*a_dot**2 + 2*l*c_2*cos(b)*a_dot*turn + c_2**2*turn**2)
potential_energy: 9.81*(m_1*c_1*sin(a) + m_2*(l*sin(a) + c_2*sin(a + b))) + k/2*(b - 0.2)**2
friction:
  a: {viscous: d_1, coulomb: f_1, width: w}
  b: {viscous: d_2, coulomb: f_2, width: w}
inputs:
  u_a: {joint: a, unit: N*m}
  u_b: {joint: b, unit: N*m}
"""
PARAMETERS = ARM.text[: ARM.text.index("gravity:")]
BY_ENERGIES = PARAMETERS + ENERGIES
SAID = BY_ENERGIES + "identify: {geometry: [l]}\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of the arm by its bodies."""
    made = tmp_path_factory.mktemp("energies")
    simulated_log(ARM.text, ARM.motion, ARM.measured, ARM.truth, Sensors()).write(made)
    return made


@pytest.fixture(scope="module")
def said(folder: Path) -> Identification:
    return of_file(folder / "log.csv", SAID, ARM.measured)


def test_products_of_what_is_not_geometry() -> None:
    """By hand: J_1, J_2, k, m_2 times squares of l, and m c and m c**2 of both links."""
    terms = energy_terms(load_text(SAID, "arm.yaml"))
    assert terms.names == ("m_1", "c_1", "J_1", "m_2", "c_2", "J_2", "k")
    assert {*terms.labels} == {"J_1", "J_2", "k", "m_2", "c_1*m_1", "c_1**2*m_1", "c_2*m_2", "c_2**2*m_2"}
    assert terms.geometry == ("l",)
    numbers = {"m_1": 2, "c_1": 3, "J_1": 5, "m_2": 7, "c_2": 11, "J_2": 13, "k": 17}
    assert dict(zip(terms.labels, terms.at(numbers), strict=True))["c_2**2*m_2"] == 847


def test_units_say_what_geometry_is() -> None:
    terms = energy_terms(load_text(BY_ENERGIES, "arm.yaml"))
    assert terms.names == ("m_1", "J_1", "m_2", "J_2", "k")
    assert terms.geometry == ("l", "c_1", "c_2")
    assert {*terms.labels} == {*terms.names}


def test_what_is_fixed_and_what_no_product_has_stays() -> None:
    text = SAID.replace("geometry: [l]", "geometry: [l], fixed: [k]").replace("J_2/2*turn**2", "sqrt(J_2)**2/2*turn**2")
    terms = energy_terms(load_text(text, "arm.yaml"))
    assert "k" in terms.geometry
    assert "J_2" in terms.geometry
    assert "k" not in terms.names


def test_friction_may_be_fixed(folder: Path) -> None:
    made = of_file(folder / "log.csv", SAID.replace("geometry: [l]", "geometry: [l], fixed: [d_2, f_1]"), ARM.measured)
    assert made.names.linear == ("d_1", "f_2")


def test_energies_show_what_bodies_show(folder: Path, said: Identification) -> None:
    """From the same log: as many combinations as count in the plane, the same inputs, the truth within its errors."""
    bodies = of_file(folder / "log.csv", ARM.text, ARM.measured)
    # bodies have first moments across their links besides, which energies leave out
    assert len(said.parameters) == len(bodies.parameters) - 2
    difference = said.estimate.predicted(said.aside) + said.aside.known
    difference -= bodies.estimate.predicted(bodies.aside) + bodies.aside.known
    noise = np.array([one.noise for one in bodies.drives])
    assert np.all(np.sqrt(np.mean(difference**2, axis=0)) < noise)
    numbers = default_like(said.model, functions_of(SAID, ARM.measured).parameters, ARM.truth)
    truth = np.array([*said.combinations.at(numbers), *(numbers[name] for name in said.names.linear)])
    assert np.abs((said.estimate.values - truth) / said.estimate.errors).max() < WITHIN
    assert said.values.misfit < WITHIN
    assert said.whole is None


def test_sums_are_those_of_the_arm(said: Identification) -> None:
    """m_2 at the elbow is a mass on the first link at l: J_1 and m_1 c_1 take l^2 and l of it."""
    sums = dict(zip((label.split(" ")[0] for label in said.combinations.labels), said.combinations.labels, strict=True))
    assert {*sums} == {"J_1", "J_2", "k", "m_2", "c_2*m_2"}
    assert sums["J_1"] == "J_1 - 0.4 c_1*m_1 + c_1**2*m_1"
    assert sums["m_2"] == "m_2 + 2.5 c_1*m_1"
    assert sums["J_2"] == "J_2 + c_2**2*m_2"


@pytest.mark.campaign
def test_a_loop_with_a_rod_whose_inertia_follows_from_its_mass(tmp_path: Path) -> None:
    """The shipped slider-crank: three masses, a spring, a damper, the drive's torque alone."""
    text = (ROOT / "models" / "slider_crank.yaml").read_text(encoding="utf-8")
    truth = {"m_crank": 0.7, "m_rod": 1.0, "m_s": 0.9, "k": 70.0, "d": 5.0}
    log = simulated_log(text, Motion({"alpha": (0.5, 1.2)}), ("alpha",), truth, Sensors())
    made = of_file(log.write(tmp_path), text, ("alpha",))
    assert made.names.inertial == ("m_crank", "m_rod", "m_s", "k")
    assert made.names.linear == ("d",)
    numbers = default_like(made.model, functions_of(text, ("alpha",)).parameters, truth)
    true = np.array([*made.combinations.at(numbers), numbers["d"]])
    assert np.abs((made.estimate.values - true) / made.estimate.errors).max() < WITHIN
    assert made.left_over < 0.05


def test_the_command_says_what_it_takes_for_geometry(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "arm.yaml").write_text(BY_ENERGIES, encoding="utf-8")
    options = ("--out", str(folder / "out"))
    main(["identify", str(folder / "arm.yaml"), str(folder / "log.csv"), *options])
    text = " ".join(capsys.readouterr().out.split())
    assert "taken for known, as geometry is: l, c_1, c_2; `identify: {geometry: [...]}` in the model file" in text
    page = (folder / "out" / "arm_with_friction" / "identified.html").read_text(encoding="utf-8")
    assert "Whole bodies" not in page


def test_values_go_into_the_file(folder: Path) -> None:
    (folder / "said.yaml").write_text(SAID, encoding="utf-8")
    assert main(["identify", str(folder / "said.yaml"), str(folder / "log.csv"), "--quiet", "--out", str(folder)]) == 0
    model = load_model(folder / "arm_with_friction" / "said.identified.yaml")
    values = default_values(model.parameters)
    for name in ("k", "d_1", "f_1", "d_2"):
        assert values[name] == pytest.approx(ARM.truth[name], rel=0.05)
    assert values["c_2"] * values["m_2"] == pytest.approx(ARM.truth["c_2"] * ARM.truth["m_2"], rel=0.05)


def test_notes_are_silent_where_the_file_says(said: Identification) -> None:
    assert not any("taken for known" in note for note in notes(said))


def test_a_name_that_is_no_parameter() -> None:
    with pytest.raises(ModelError) as caught:
        load_text(SAID.replace("[l]", "[ll]"), "arm.yaml")
    (mistake,) = caught.value.mistakes
    assert mistake.message == "`ll` under `geometry` of `identify` is no parameter"
    assert mistake.span is not None
    assert SAID.splitlines()[mistake.span.line - 1].startswith("identify:")
    assert "`l`" in mistake.remedy


def test_nothing_is_left_to_identify(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "known.yaml").write_text(
        SAID.replace("geometry: [l]", "geometry: [l, c_1, c_2], fixed: [m_1, m_2, J_1, J_2, k]"), encoding="utf-8"
    )
    assert main(["identify", str(folder / "known.yaml"), str(folder / "log.csv"), "--out", str(folder)]) == 1
    assert "no parameter of the energies is left to identify" in " ".join(capsys.readouterr().err.split())
