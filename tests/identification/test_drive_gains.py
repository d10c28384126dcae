"""Gains of drives, estimated with all else from logs of currents: truth, biases, what a log cannot say."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from gain_machines import MACHINES_BY_CURRENTS, TWO_SLIDES, MachineByCurrents, log_of_currents
from simulated_logs import Array, Sensors, machine_of, of_file

from symgen.identification.combinations import default_like
from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.identify import FittedLog, fitted_by
from symgen.identification.estimates.least_squares import LinearEstimate, estimated
from symgen.identification.logs.filtering import filter_settings
from symgen.identification.logs.read_log import read_log
from symgen.identification.not_identified import NotIdentifiedError
from symgen.identification.reported.notes import MORE_THAN_NOISE, notes
from symgen.model.configurations.mechanics import default_values

# Standard errors, the share of estimates within them, and logs of a campaign.
WITHIN, SHARE, SEEDS = 3.0, 0.97, 20
# Gains that are asked, where others are known or a load is.
ASKED = {"arm": ("k_2",), "payload": ("k_1", "k_2"), "rapkm": ("k_2", "k_3")}
ARM_BY_CURRENTS = MACHINES_BY_CURRENTS["arm"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("currents")


def fitted(
    folder: Path,
    machine: MachineByCurrents,
    gains: tuple[str, ...],
    sensors: Sensors,
    seed: int = 0,
    seconds: float = 10.0,
) -> FittedLog:
    """The fit alone, without values of the file and bodies."""
    made = machine_of(machine.asked(*gains), machine.measured)
    log = read_log(log_of_currents(machine, sensors, seed, seconds).write(folder), made.base.model)
    return fitted_by(made, log, filter_settings(log, None), lambda _: None)


@cache
def known(folder: Path, name: str) -> Identification:
    machine = MACHINES_BY_CURRENTS[name]
    log = log_of_currents(machine, Sensors())
    return of_file(log.write(folder), machine.asked(*ASKED[name]), machine.measured)


def truth(made: FittedLog | Identification, machine: MachineByCurrents) -> Array:
    """What the log is of, in the order of columns."""
    functions = machine_of(machine.text, machine.measured).functions
    values = default_values(functions.model.parameters)
    gains = {
        name: values[name] * machine.factors.get(one.name, 1.0)
        for one in functions.model.inputs
        for name in values
        if one.acts_on[0][1] == type(one.acts_on[0][1])(name)
    }
    numbers = default_like(functions.model, functions.parameters, {**machine.truth, **gains})
    combinations = made.combinations if isinstance(made, Identification) else made.functions.combinations
    return np.array([*combinations.at(numbers), *(numbers[name] for name in made.names.with_columns)])


def in_errors(made: FittedLog | Identification, machine: MachineByCurrents) -> Array:
    return np.asarray((made.estimate.values - truth(made, machine)) / made.estimate.errors)


def by_least_squares(made: FittedLog) -> LinearEstimate:
    """The same equations without instruments, gains as differences from the file."""
    seen = made.fitted_to
    assert seen.drives is not None
    count = len(seen.drives.names)
    return estimated(replace(seen, inputs=seen.inputs - seen.columns[..., -count:] @ seen.drives.before))


@pytest.mark.parametrize("name", ["arm", "payload", pytest.param("rapkm", marks=pytest.mark.campaign)])
def test_gains_are_estimated_with_all_else(folder: Path, name: str) -> None:
    made, machine = known(folder, name), MACHINES_BY_CURRENTS[name]
    assert made.names.gains == ASKED[name]
    assert np.abs(in_errors(made, machine)).max() < WITHIN
    for one in made.parameters[-len(ASKED[name]) :]:
        assert abs(one.before - one.value) > 10 * one.error
        assert one.error < 0.02 * one.value
    values = dict(zip(made.values.names, made.values.values, strict=True))
    for one in made.parameters[-len(ASKED[name]) :]:
        assert abs(values[one.name] - one.value) < WITHIN * one.error
    assert made.left_over < 0.02


@pytest.mark.parametrize("name", ["arm", pytest.param("rapkm", marks=pytest.mark.campaign)])
def test_inputs_are_predicted_as_they_were_measured(folder: Path, name: str) -> None:
    """In amperes of the log, not in those that the gains of the file would take; nothing drives against anything."""
    made, machine = known(folder, name), MACHINES_BY_CURRENTS[name]
    size = log_of_currents(machine, Sensors())
    currents = size.u / [machine.factors.get(one.name, 1.0) for one in made.model.inputs]
    for one, current in zip(made.drives, currents.T, strict=True):
        assert one.predicted < 1.5 * one.noise
        # in the direction that no motion takes there is noise, too
        assert one.inner < MORE_THAN_NOISE * one.noise
        if name == "arm":
            assert one.inputs == pytest.approx(np.sqrt(np.mean(current**2)), rel=0.1)
    if name == "rapkm":  # by the gains of the file drives would work against each other
        assert made.fitted_to.inner.min() > 10 * MORE_THAN_NOISE * min(one.noise for one in made.drives)
    part = made.aside
    left = part.inputs + part.known - made.predicted(part)
    assert np.allclose(left, made.residuals(part), rtol=1e-9, atol=1e-12)


@pytest.mark.campaign
@pytest.mark.parametrize("name", [*ASKED])
def test_errors_of_gains_are_honest_over_many_logs(tmp_path: Path, name: str) -> None:
    machine = MACHINES_BY_CURRENTS[name]
    logs = [fitted(tmp_path, machine, ASKED[name], Sensors(), seed) for seed in range(SEEDS)]
    off = np.concatenate([in_errors(made, machine) for made in logs])
    assert np.mean(np.abs(off) < WITHIN) >= SHARE
    assert 0.5 < np.sqrt(np.mean(off**2)) < 1.3


@pytest.mark.campaign
def test_a_preload_does_not_bias_gains(tmp_path: Path) -> None:
    """Three drives against each other as hard as they drive, by their true gains."""
    machine = MACHINES_BY_CURRENTS["rapkm"]
    logs = [fitted(tmp_path, machine, ASKED["rapkm"], Sensors(preload=1.0), seed) for seed in range(SEEDS)]
    off = np.array([in_errors(made, machine) for made in logs])
    assert np.mean(np.abs(off) < WITHIN) >= SHARE
    assert np.abs(np.mean(off, axis=0)).max() < WITHIN / np.sqrt(SEEDS)


@pytest.mark.campaign
def test_six_gains_of_an_arm_with_seven_joints(tmp_path: Path) -> None:
    """From 20 s, with all of its links: to a percent where only few links are behind, to a thousandth elsewhere."""
    machine, gains = MACHINES_BY_CURRENTS["arm7"], tuple(f"k_{k}" for k in range(2, 8))
    made = fitted(tmp_path, machine, gains, Sensors(), seconds=20.0)
    assert made.names.gains == gains
    assert np.mean(np.abs(in_errors(made, machine)) < WITHIN) >= SHARE
    assert np.abs(in_errors(made, machine)[-6:]).max() < WITHIN
    errors = made.estimate.errors[-6:] / made.estimate.values[-6:]
    assert errors[:3].max() < 0.002
    assert errors.max() < 0.015


def test_least_squares_make_gains_small(folder: Path) -> None:
    """The noise of the log in a column: the more of it, the nearer to 0, and errors do not say so."""
    pairs = []
    for seed in range(3):
        made = fitted(folder, ARM_BY_CURRENTS, ("k_2",), Sensors(noise=0.3), seed)
        true = truth(made, ARM_BY_CURRENTS)[-1] - made.fitted_to.drives.before[0]
        plain = by_least_squares(made)
        pairs.append(((plain.values[-1] - true) / plain.errors[-1], in_errors(made, ARM_BY_CURRENTS)[-1]))
    straight, instrumental = np.mean(pairs, axis=0)
    assert straight < -1.5
    assert abs(instrumental) < WITHIN / np.sqrt(3)


def test_gains_of_slides_by_themselves_are_left_open(folder: Path) -> None:
    """Least squares would say that a drive without gain moves a slide without mass: all equations hold."""
    machine = MACHINES_BY_CURRENTS["slides"]
    made = of_file(log_of_currents(machine, Sensors()).write(folder), machine.asked("k_x", "k_y"), machine.measured)
    assert made.names.gains == ()
    assert {name for name, _ in made.names.kept} == {"k_x", "k_y"}
    assert all("the log does not determine this gain" in why for _, why in made.names.kept)
    assert {"k_x", "k_y"}.isdisjoint({*made.values.names, *(one.name for one in made.parameters)})
    # the rest is what it is by the gains of the file
    values = {one.name.replace("\u00a0", " "): one.value for one in made.parameters}
    assert values["d_x"] == pytest.approx(3.0, rel=0.02)
    assert values["along.m"] == pytest.approx(2.0 / 1.3, rel=0.02)
    assert made.left_over < 0.03


def test_least_squares_would_answer_for_slides_with_nothing(folder: Path) -> None:
    machine = MACHINES_BY_CURRENTS["slides"]
    made = machine_of(machine.asked("k_y"), machine.measured)
    log = read_log(log_of_currents(machine, Sensors()).write(folder), made.base.model)
    seen = log.columns["i_y"]
    flat = np.column_stack([np.gradient(np.gradient(log.columns["y"], log.t), log.t), -seen / 10.0])
    solved = np.linalg.lstsq(flat, seen, rcond=None)[0]
    assert 10.0 + solved[1] == pytest.approx(0.0, abs=1e-9)
    assert solved[0] == pytest.approx(0.0, abs=1e-12)


def test_gains_of_some_drives_are_told_beside_others_left_open(folder: Path) -> None:
    """The arm beside a slide of its own."""
    machine = replace(
        ARM_BY_CURRENTS,
        text=ARM_BY_CURRENTS.text.replace("gravity:", "  m_s: {value: 2}\n  k_3: {value: 10}\ngravity:")
        .replace("bodies:", "  slide: {type: prismatic, axis: x, coordinate: s}\nbodies:\n  slide: {mass: m_s}")
        + "  u_s: {acts_on: {s: k_3}}\n",
        motion=replace(ARM_BY_CURRENTS.motion, leading={**ARM_BY_CURRENTS.motion.leading, "s": (0.0, 0.3)}),
        measured=("a", "b", "s"),
        factors={"u_b": 1.25, "u_s": 0.9},
    )
    made = fitted(folder, machine, ("k_2", "k_3"), Sensors())
    assert made.names.gains == ("k_2",)
    assert [name for name, _ in made.names.kept if name != "w"] == ["k_3"]
    gain = made.estimate.values[-1]
    assert abs(gain - 1.25 * 0.35) < WITHIN * made.estimate.errors[-1]


def test_ratios_are_no_gains(folder: Path) -> None:
    """Both gains of an arm of which nothing is known: told, with what to do."""
    with pytest.raises(NotIdentifiedError) as caught:
        fitted(folder, ARM_BY_CURRENTS, ("k_1", "k_2"), Sensors())
    text = str(caught.value)
    assert "the log says how the gains `k_1`, `k_2` stand to each other, not how large they are" in text
    assert "leave one that is known out of `gains`" in text


@pytest.mark.parametrize("factor", [0.3, 3.0, -1.0])
def test_gains_may_be_far_off(folder: Path, factor: float) -> None:
    """Another order of magnitude, nearly, or a motor that turns the other way."""
    machine = replace(ARM_BY_CURRENTS, factors={"u_b": factor})
    made = fitted(folder, machine, ("k_2",), Sensors())
    assert np.abs(in_errors(made, machine)).max() < WITHIN
    assert made.estimate.errors[-1] < 0.02 * abs(made.estimate.values[-1])


def test_bodies_that_are_fixed_make_gains_known(folder: Path) -> None:
    """The same as by numbers: what `fixed` names stays, and so do sums of it."""
    machine = replace(ARM_BY_CURRENTS, factors={"u_a": 0.8, "u_b": 1.25})
    text = machine.text
    for before, after in (("m_2: {value: 1.0", "m_2: {value: 0.8"), ("c_2: {value: 0.15", "c_2: {value: 0.17"),
                          ("J_2: {value: 0.012", "J_2: {value: 0.009")):  # fmt: skip
        assert before in text
        text = text.replace(before, after)
    asked = f"{text}identify: {{gains: [k_1, k_2], fixed: [m_2, c_2, J_2]}}\n"
    made = of_file(log_of_currents(machine, Sensors()).write(folder), asked, machine.measured)
    assert made.names.gains == ("k_1", "k_2")
    assert made.names.inertial == ("m_1", "c_1", "J_1")
    assert {"elbow.mx", "elbow.Izz"}.isdisjoint(made.combinations.labels)
    assert np.abs(in_errors(made, machine)).max() < WITHIN


def test_what_is_fixed_makes_gains_known(folder: Path) -> None:
    """A spring that was measured: `fixed` holds it, and both gains follow."""
    machine = replace(ARM_BY_CURRENTS, factors={"u_a": 0.8, "u_b": 1.25})
    text = machine.text.replace("  k:   {value: 1.0,", "  k:   {value: 1.6,")
    assert text != machine.text
    asked = f"{text}identify: {{gains: [k_1, k_2], fixed: [k]}}\n"
    made = of_file(log_of_currents(machine, Sensors()).write(folder), asked, machine.measured)
    assert made.names.gains == ("k_1", "k_2")
    assert "k" not in made.values.names
    assert np.abs(in_errors(made, machine)).max() < WITHIN


def test_numbers_of_bodies_are_known_where_gains_are_asked(folder: Path) -> None:
    made = known(folder, "payload")
    assert "taken for known, as gains are told by what is: elbow.mx, elbow.Izz" in " ".join(notes(made))
    # a moment that is 0 in the file loads nothing, and may be other than that
    assert [label for label in made.combinations.labels if label.startswith("elbow")] == ["elbow.my"]
    ten = made.whole.values[10:20]
    assert ten[1] == pytest.approx(0.8 * 0.17, rel=0.01)


def test_a_known_machine_tells_all_gains(folder: Path) -> None:
    """Nothing but gains: drives of slides that were weighed."""
    slides = MACHINES_BY_CURRENTS["slides"]
    text = TWO_SLIDES.replace("{mass: m_x}", "{mass: 3.5}").replace("{mass: m_y}", "{mass: 2.0}")
    text = text.replace("{viscous: d_x}", "{viscous: 3.0}")
    for line in [line for line in text.splitlines() if line.startswith(("  m_", "  d_"))]:
        text = text.replace(line + "\n", "")
    machine = replace(slides, text=text, truth={}, factors={"i_x": 0.9, "i_y": 1.3})
    made = of_file(log_of_currents(machine, Sensors()).write(folder), machine.asked("k_x", "k_y"), machine.measured)
    assert [one.name for one in made.parameters] == ["k_x", "k_y"] == list(made.values.names)
    assert np.abs(in_errors(made, machine)).max() < WITHIN
    assert made.values.values == pytest.approx([18.0, 13.0], rel=0.01)


def test_energies_have_gains_too(folder: Path) -> None:
    """What is geometry still follows from units; gains have a kilogram in theirs, and are no part of energies."""
    text = """
model: slides_by_energies
coordinates: {x: {unit: m}, b: {unit: rad}}
parameters:
  l: {value: 0.4, unit: m}
  m: {value: 2, unit: kg}
  M: {value: 5, unit: kg}
  k_x: {value: 20, unit: N/A}
  k_b: {value: 3, unit: N*m/A}
kinetic_energy: M/2*x_dot**2 + m/2*(x_dot**2 + 2*l*cos(b)*x_dot*b_dot + l**2*b_dot**2)
potential_energy: 9.81*m*l*cos(b)
inputs:
  i_x: {acts_on: {x: k_x}, unit: A}
  i_b: {acts_on: {b: k_b}, unit: A}
"""
    motion = replace(ARM_BY_CURRENTS.motion, leading={"x": (0.0, 0.4), "b": (0.3, 1.0)})
    machine = MachineByCurrents(text, motion, ("x", "b"), {"m": 2.4, "M": 4.0}, {"i_b": 0.8})
    made = of_file(log_of_currents(machine, Sensors()).write(folder), machine.asked("k_b"), machine.measured)
    assert [one.name for one in made.parameters] == ["M", "m", "k_b"]
    assert made.whole is None
    assert np.abs(in_errors(made, machine)).max() < WITHIN
    assert "taken for known, as geometry is: l" in " ".join(notes(made))
