"""Estimates against machines whose parameters are known: errors, unseen motion, preload, outliers."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from identified_machines import MACHINES_WITH_LOGS
from simulated_logs import Array, Sensors, functions_of, machine_of, of_file, simulated_log

from symgen.identification.bodies.pseudo_inertia import pseudo_inertia
from symgen.identification.combinations import base_map, default_like
from symgen.identification.estimates.identification import Identification
from symgen.identification.reported.notes import notes

# Standard errors, the share of parameters within them, and what parameters may add to the noise of unseen motion.
WITHIN, SHARE, ADDED = 3.0, 0.97, 1.2
# Seeds of a campaign: logs of one machine.
SEEDS = 20
USUAL_SENSORS = Sensors()


def of_log(folder: Path, machine: str, sensors: Sensors, seed: int, seconds: float = 10.0) -> Identification:
    chosen = MACHINES_WITH_LOGS[machine]
    log = simulated_log(chosen.text, chosen.motion, chosen.measured, chosen.truth, sensors, seed, seconds)
    return of_file(log.write(folder), chosen.text, chosen.measured)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("logs")


@cache
def known(folder: Path, machine: str, sensors: Sensors = USUAL_SENSORS) -> Identification:
    """One for all tests of the module."""
    return of_log(folder, machine, sensors, seed=0)


def truth(made: Identification, machine: str) -> Array:
    """Base parameters and linear ones of the machine that the log is of."""
    chosen = MACHINES_WITH_LOGS[machine]
    names = tuple(c.name for c in made.model.coordinates if c.name in chosen.motion.leading)
    numbers = default_like(made.model, functions_of(chosen.text, names).parameters, chosen.truth)
    combined = made.combinations.at(numbers)
    return np.array([*combined, *(numbers[name] for name in made.names.linear)])


def in_errors(made: Identification, machine: str) -> Array:
    return np.asarray((made.estimate.values - truth(made, machine)) / made.estimate.errors)


def added_to_noise(made: Identification, machine: str) -> Array:
    """What is left of unseen inputs, by what the true parameters leave of them: noise of all sensors."""
    seen = made.aside
    left = np.sqrt(np.mean((seen.inputs - seen.columns @ truth(made, machine)) ** 2, axis=0))
    return np.asarray(np.sqrt(np.mean(made.residuals(seen) ** 2, axis=0)) / left)


@pytest.mark.parametrize(
    "machine", ["arm", *(pytest.param(name, marks=pytest.mark.campaign) for name in ("four_bar", "rapkm"))]
)
def test_estimates_are_within_their_errors(folder: Path, machine: str) -> None:
    made = known(folder, machine)
    assert np.abs(in_errors(made, machine)).max() < WITHIN
    assert added_to_noise(made, machine).max() < ADDED
    # the model file is further off than that: the estimates are worth something
    before = np.array([one.before for one in made.parameters])
    off = np.abs(before - truth(made, machine)) / made.estimate.errors
    assert np.sum(off > WITHIN) >= 3
    assert made.left_over < 0.02


@pytest.mark.campaign
@pytest.mark.parametrize("machine", [*MACHINES_WITH_LOGS])
def test_errors_are_honest_over_many_logs(tmp_path: Path, machine: str) -> None:
    """Within three standard errors for 97 %, and no larger than needed: their rms is about one."""
    seconds = 20.0 if machine == "four_bar" else 10.0
    logs = [of_log(tmp_path, machine, USUAL_SENSORS, seed, seconds) for seed in range(SEEDS)]
    off = np.concatenate([in_errors(made, machine) for made in logs])
    assert np.mean(np.abs(off) < WITHIN) >= SHARE
    assert 0.5 < np.sqrt(np.mean(off**2)) < 1.3
    added = np.concatenate([added_to_noise(made, machine) for made in logs])
    assert np.mean(added < ADDED) >= SHARE


@pytest.mark.campaign
def test_a_preload_changes_nothing(folder: Path) -> None:
    """Drives that work against each other as hard as they drive: 0.1 of a standard error at most."""
    plain, loaded = (known(folder, "four_bar", Sensors(preload=p)) for p in (0.0, 1.0))
    change = np.abs(loaded.estimate.values - plain.estimate.values) / plain.estimate.errors
    assert change.max() < 0.1
    inner = [one.inner for one in loaded.drives]
    assert max(inner) > 0.2 * max(one.inputs for one in loaded.drives)
    assert max(inner) > 20 * max(one.inner for one in plain.drives)


def test_wild_samples_count_less(folder: Path) -> None:
    plain, wild = (known(folder, "arm", Sensors(outliers=count)) for count in (0, 15))
    off = np.abs(in_errors(wild, "arm"))
    assert off.max() < WITHIN
    assert wild.estimate.outliers > plain.estimate.outliers
    # without weights the same log is worse
    seen = wild.fitted_to
    flat = seen.columns.reshape(-1, seen.columns.shape[2])
    straight = np.linalg.lstsq(flat, seen.inputs.ravel(), rcond=None)[0]
    lengths = np.linalg.norm(flat, axis=0)
    true = truth(wild, "arm")
    assert np.linalg.norm(lengths * (wild.estimate.values - true)) < np.linalg.norm(lengths * (straight - true)) / 2


def test_friction_springs_and_what_is_not_linear(folder: Path) -> None:
    made = known(folder, "arm")
    assert made.names.inertial == ("m_1", "c_1", "J_1", "m_2", "c_2", "J_2")
    assert made.names.linear == ("d_1", "f_1", "d_2", "f_2", "k")
    assert dict(made.names.kept) == {"w": "the inputs are not linear in it"}
    values = dict(zip(made.values.names, made.values.values, strict=True))
    for name in made.names.linear:
        assert values[name] == pytest.approx(MACHINES_WITH_LOGS["arm"].truth[name], rel=0.05)


def test_values_of_the_file_say_what_the_estimates_say(folder: Path) -> None:
    made = known(folder, "arm")
    assert made.values.misfit < WITHIN
    before = functions_of(MACHINES_WITH_LOGS["arm"].text, ("a", "b")).parameters
    numbers = default_like(made.model, before, dict(zip(made.values.names, made.values.values, strict=True)))
    combined = made.combinations.at(numbers)
    off = (combined - made.estimate.values[: len(combined)]) / made.estimate.errors[: len(combined)]
    assert np.abs(off).max() < WITHIN
    assert made.values.impossible == ()


@pytest.mark.parametrize("machine", ["arm", "four_bar", pytest.param("rapkm", marks=pytest.mark.campaign)])
def test_whole_bodies_say_what_the_estimates_say(folder: Path, machine: str) -> None:
    """Bodies that can be, with base parameters, friction and springs within the errors: of the truth, too."""
    made = known(folder, machine)
    whole, chosen = made.whole, MACHINES_WITH_LOGS[machine]
    base = machine_of(chosen.text, chosen.measured).base
    assert whole.misfit < 0.1
    count = len(made.model.mechanism.bodies)
    for ten in whole.values[: 10 * count].reshape(count, 10):
        assert np.linalg.eigvalsh(pseudo_inertia(ten))[0] > 0
    assert np.all(whole.values[10 * count :] > 0)
    combined = np.array([*(base_map(base) @ whole.values), *whole.linear.values()])
    assert np.abs((combined - truth(made, machine)) / made.estimate.errors).max() < WITHIN


@pytest.mark.campaign
def test_other_lengths_show_in_the_loops(tmp_path: Path) -> None:
    """A rocker of 0.72 in place of 0.7: both encoders together say so, and the fit is worse."""
    chosen = MACHINES_WITH_LOGS["four_bar"]
    longer = chosen.text.replace("l_3: {value: 0.7,", "l_3: {value: 0.72,")
    log = simulated_log(longer, chosen.motion, chosen.measured, chosen.truth, USUAL_SENSORS, seconds=5.0)
    made = of_file(log.write(tmp_path), chosen.text, chosen.measured)
    assert "measured coordinates are off closed loops" in " ".join(notes(made))
    made = of_file(tmp_path / "log.csv", longer, chosen.measured)
    assert "measured coordinates are off closed loops" not in " ".join(notes(made))


def test_notes_say_what_the_data_do_not_determine(folder: Path) -> None:
    made = known(folder, "four_bar")
    text = " ".join(notes(made))
    assert "may as well be 0" in text
    assert f"the condition number is {made.estimate.condition:.0f}, limited by" in text
