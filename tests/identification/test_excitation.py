"""Designed motions: better than drawn ones, within every limit between samples too, and good to identify by."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from excited_machines import ARM_WITH_LIMITS, SWINGING_FOUR_BAR, designed_once
from identified_machines import MACHINES_WITH_LOGS, ROOT
from simulated_logs import machine_of

from symgen.identification.combinations import base_map, default_like, inertial_values
from symgen.identification.estimates.identify import identified_by
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.observations import equations
from symgen.identification.excitation.excitation import Excitation, ExcitationRequest, goes_on
from symgen.identification.excitation.leading import leading
from symgen.identification.excitation.series import HARMONICS, RestingSeries
from symgen.identification.logs.filtering import filter_settings
from symgen.identification.logs.read_log import MeasuredLog
from symgen.model.load import load_model, load_text

Array = npt.NDArray[np.float64]
TEXTS = {"arm": ARM_WITH_LIMITS, "four_bar": SWINGING_FOUR_BAR}


def at(made: Excitation, t: Array) -> list[Array]:
    """Leading coordinates, their rates and accelerations (N, d) at times t, by the factors of the series."""
    constants, factors = made.series
    w = 2 * np.pi / made.request.period * np.arange(1, HARMONICS + 1)
    waves = []
    for power in range(3):
        phase = np.outer(t, w) + power * np.pi / 2
        turned = np.hstack([np.sin(phase) * w**power, np.cos(phase) * w**power]) @ factors.T
        waves.append(turned + (constants if power == 0 else 0))
    return waves


def test_the_arm_keeps_all_limits_between_samples() -> None:
    """At seven times the samples, by the series itself and functions that were made for logs."""
    made = designed_once(ARM_WITH_LIMITS)
    t = np.linspace(0, made.request.period, 7001)
    q, qd, qdd = at(made, t)
    ends = ((q, [-1.2, -1.0], [1.4, 2.0]), (qd, [-4, -5], [4, 5]), (qdd, [-30, -40], [30, 40]))
    u = machine_of(ARM_WITH_LIMITS, ("a", "b")).functions.inputs((q, qd, qdd))
    for values, low, high in (*ends, (u, [-16, -4], [16, 4])):
        assert (values >= np.array(low)).all()
        assert (values <= np.array(high)).all()
    # and uses them: something is within a tenth of its limit
    assert 0.9 < np.max(made.shares) <= 1
    assert made.shares[made.limits.names.index("u_a")] == pytest.approx(np.max(np.abs(u[:, 0])) / 16, rel=1e-3)


@pytest.mark.parametrize("name", ["arm", pytest.param("four_bar", marks=pytest.mark.campaign)])
def test_it_begins_and_ends_at_rest(name: str) -> None:
    made = designed_once(TEXTS[name])
    for end in (0, -1):
        assert np.max(np.abs(made.qd[end])) < 1e-9 * np.max(np.abs(made.qd))
        assert np.max(np.abs(made.qdd[end])) < 1e-9 * np.max(np.abs(made.qdd))
    assert np.max(np.abs(made.q[0] - made.q[-1])) < 1e-9
    step = made.t[1]
    assert np.allclose(np.gradient(made.q, step, axis=0)[1:-1], made.qd[1:-1], atol=1e-3 * np.max(np.abs(made.qd)))
    assert np.allclose(np.gradient(made.qd, step, axis=0)[1:-1], made.qdd[1:-1], atol=2e-3 * np.max(np.abs(made.qdd)))


@pytest.mark.campaign
@pytest.mark.parametrize("name", [*TEXTS])
def test_it_shows_more_than_drawn_motions_within_the_same_limits(name: str) -> None:
    made = designed_once(TEXTS[name])
    best, half = made.drawn
    assert made.condition < 0.5 * best
    assert made.condition < 0.4 * half
    # the same number by functions that were made for logs
    machine = machine_of(TEXTS[name], ("a", "b") if name == "arm" else ("a", "c"))
    names = made_linear(made)
    state = made.q[:-1], made.qd[:-1], made.qdd[:-1]
    columns = equations(machine.functions, names, state)[1]
    if name == "arm":  # weighted by the ranges of its drives
        columns = columns / np.array([32.0, 8.0])[:, None]
    flat = columns.reshape(-1, columns.shape[2])
    assert np.linalg.cond(flat / np.linalg.norm(flat, axis=0)) == pytest.approx(made.condition, rel=0.02)


def made_linear(made: Excitation) -> EstimatedNames:
    return EstimatedNames((), tuple(name for name in made.shown if "." not in name), ())


def test_loops_stay_closed_and_rates_within_limits() -> None:
    made = designed_once(SWINGING_FOUR_BAR)
    assert made.leading.given_by == "measured"
    a, b, c = made.q.T
    assert np.allclose(0.4 * np.cos(a) + 0.9 * np.cos(a + b), 1 + 0.7 * np.cos(c), atol=1e-9)
    assert np.allclose(0.4 * np.sin(a) + 0.9 * np.sin(a + b), 0.7 * np.sin(c), atol=1e-9)
    assert (np.max(np.abs(made.qd), axis=0) <= [4, 6, 4]).all()
    # nowhere nearer to a singularity than half of what the file's configuration is
    assert (np.min(made.distances, axis=0) >= made.limits.distances).all()


def in_errors(made: Excitation, name: str, draw: int) -> Array:
    """Estimates from six periods with noise of 2 % of the inputs and steps of encoders, less the truth, in errors."""
    chosen = MACHINES_WITH_LOGS[name]
    machine = machine_of(TEXTS[name], chosen.measured)
    q, qd, qdd = (np.tile(part[:-1], (6, 1)) for part in (made.q, made.qd, made.qdd))
    numbers = default_like(machine.base.model, machine.functions.parameters, chosen.truth)
    u = machine.functions.inputs((q, qd, qdd), numbers)
    u = u + 0.02 * np.std(u, axis=0) * np.random.default_rng(draw).standard_normal(u.shape)
    names = [c.name for c in made.model.coordinates]
    columns = {x: np.round(q[:, names.index(x)] / 2e-5) * 2e-5 for x in chosen.measured}
    columns |= {one.name: u[:, k] for k, one in enumerate(made.model.inputs)}
    log = MeasuredLog("log.csv", np.arange(len(u)) * made.t[1], columns, chosen.measured)
    result = identified_by(machine, log, filter_settings(log, None), lambda _: None)
    true = [*(base_map(machine.base) @ inertial_values(machine.base.model, numbers))]
    true += [numbers[one] for one in result.names.linear]
    assert result.estimate.condition < 1.5 * made.condition
    return np.asarray((result.estimate.values - np.array(true)) / result.estimate.errors)


@pytest.mark.parametrize("name", ["arm", pytest.param("four_bar", marks=pytest.mark.campaign)])
def test_a_log_of_it_gives_the_truth(name: str) -> None:
    assert np.abs(in_errors(designed_once(TEXTS[name]), name, draw=0)).max() < 3


def test_a_jump_to_another_assembly_mode_is_seen() -> None:
    """From one sample on the coupler and the rocker are mirrored at the line from crank to ground."""
    made = designed_once(SWINGING_FOUR_BAR)
    assert goes_on((made.q, made.qd, made.qdd), made.t[1])
    a, b, c = made.q.T
    line = np.arctan2(-0.4 * np.sin(a), 1 - 0.4 * np.cos(a))
    mirrored = np.stack([a, 2 * (line - a) - b, 2 * line - c], axis=-1)
    # the rocker's top lies opposite
    assert np.allclose(0.4 * np.sin(a) + 0.9 * np.sin(mirrored[:, :2].sum(axis=1)), 0.7 * np.sin(mirrored[:, 2]))
    jumping = np.where(np.arange(len(a))[:, None] < 500, made.q, mirrored)
    assert not goes_on((jumping, made.qd, made.qdd), made.t[1])


def test_what_leads() -> None:
    """The task where it determines the motion, else encoders, else drives; of these those far from a singularity."""
    rapkm = leading(load_model(ROOT / "models" / "rapkm_bodies.yaml"))
    assert rapkm.given_by == "measured"
    assert len(rapkm.names) == 2
    assert {*rapkm.names} < {"a_1", "a_2", "a_3"}
    task = leading(load_model(ROOT / "models" / "five_bar.yaml"))
    assert (task.given_by, task.names) == ("task", ("x", "y"))
    assert leading(load_text(SWINGING_FOUR_BAR, "bars.yaml")).names in (("a",), ("c",))
    with_encoder = SWINGING_FOUR_BAR + "measured: [b]\n"
    assert leading(load_text(with_encoder, "bars.yaml")).names == ("b",)
    assert leading(load_text(ARM_WITH_LIMITS, "arm.yaml")).names == ("a", "b")


def test_series_begin_at_rest_and_their_rates_are_derivatives() -> None:
    series = RestingSeries(3.0, np.array([0.2, -1.0]), np.array([0.5, 2.0]))
    z = np.random.default_rng(5).standard_normal((4, series.variables))
    t = np.linspace(0, 3, 3001)
    q, qd, qdd = series.motions(z, t)
    assert np.max(np.abs(qd[:, [0, -1]])) < 1e-12
    assert np.max(np.abs(qdd[:, [0, -1]])) < 1e-11
    assert np.allclose(np.gradient(q, t[1], axis=1)[:, 1:-1], qd[:, 1:-1], atol=1e-4 * np.max(np.abs(qd)))
    assert np.allclose(np.gradient(qd, t[1], axis=1)[:, 1:-1], qdd[:, 1:-1], atol=1e-4 * np.max(np.abs(qdd)))
    assert series.variables == 2 * (1 + 2 * HARMONICS - 2)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(3))
def test_errors_are_honest_for_designed_motions(seed: int) -> None:
    """Twenty logs of each design: errors of the estimates have the size that they are given."""
    made = designed_once(ARM_WITH_LIMITS, ExcitationRequest(4.0, None, seed))
    off = np.concatenate([in_errors(made, "arm", draw) for draw in range(20)])
    assert np.mean(np.abs(off) < 3) >= 0.97
    assert 0.5 < np.sqrt(np.mean(off**2)) < 1.3
