"""Logs that are cut out of a motion, and estimates of which some are open: what the data say is not bent by either."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pytest

from symgen.identification.estimates.least_squares import LinearEstimate, estimated
from symgen.identification.estimates.observations import Observations
from symgen.identification.estimates.whitened import whitening
from symgen.identification.logs.filtering import FilterSettings

Array = npt.NDArray[np.float64]
SAMPLES = 300
SEEDS = range(12)
NOISE = 0.02


def observed(columns: Array, values: Array, noise: Array) -> Observations:
    """A log of one input."""
    inputs = (columns @ values + noise)[:, None]
    blank = np.zeros_like(inputs)
    return Observations(np.arange(len(columns)) * 1.0, inputs, blank, columns[:, None, :], blank[0], blank[0], 1)


def misfit(estimate: LinearEstimate, truth: Array) -> float:
    """How far the truth is from the estimates, in standard errors of all of them together (rms)."""
    off = whitening(estimate) @ (estimate.shown(truth) - estimate.values[estimate.closed_columns])
    return float(np.sqrt(np.mean(off**2)))


@pytest.mark.parametrize("speed", [0.0, 0.7, -2.0])
def test_accelerations_of_a_log_that_begins_and_ends_at_speed(speed: float) -> None:
    t = np.arange(4001) / 1000
    turning = 2 * np.pi * 0.25
    settings = FilterSettings(1000.0, 1.25, 6.25, 80, 400)
    smoothed = settings.smoothed(np.cos(turning * t + 0.4) + speed * t)
    accelerations = settings.differentiated(settings.differentiated(smoothed))
    exact = -(turning**2) * np.cos(turning * t + 0.4)
    places = settings.places(len(t))
    # 1 % and more where less is given beyond the ends than the filter remembers
    assert np.max(np.abs(accelerations[places] - exact[places])) < 2e-3 * turning**2


def test_errors_of_columns_that_are_nearly_alike_hold_together() -> None:
    """Three columns that differ by 1e-5, and noise that neighbours share: single errors are large, sums are not."""
    t = np.linspace(0, 6, SAMPLES)
    common = np.sin(t) + 0.3 * t
    columns = np.stack([common + 1e-5 * np.cos(k * t) for k in (2, 3, 5)], axis=-1)
    truth = np.array([4.0, -1.0, 2.5])
    misfits = []
    for seed in SEEDS:
        noise = np.random.default_rng(seed).normal(0, NOISE, SAMPLES + 4)
        estimate = estimated(observed(columns, truth, np.convolve(noise, np.ones(5) / 5, "valid")))
        assert np.min(estimate.errors) > 50
        assert abs(np.sum(estimate.values - truth)) < 0.01
        misfits.append(misfit(estimate, truth))
    assert np.mean(misfits) < 2
    assert max(misfits) < 4


def test_what_a_motion_leaves_open_is_part_of_the_rest() -> None:
    """The third column is made of the others: its value of 7 shows in theirs, which are right all the same."""
    t = np.linspace(0, 6, SAMPLES)
    first, second = np.sin(t), np.cos(2 * t)
    columns = np.stack([first, second, 0.5 * first - 2 * second], axis=-1)
    truth = np.array([1.0, 2.0, 7.0])
    noise = np.random.default_rng(3).normal(0, NOISE, SAMPLES)
    estimate = estimated(observed(columns, truth, noise))
    assert estimate.open_columns == (2,)
    assert np.allclose(estimate.shares, [[0.5], [-2.0]])
    assert np.allclose(estimate.values[:2], [4.5, -12.0], atol=0.02)
    assert misfit(estimate, truth) < 2
    # as rows, which whole bodies take
    assert np.allclose(estimate.shown(np.eye(3)), [[1, 0, 0.5], [0, 1, -2]])
    seen = SimpleNamespace(columns=columns[:, None, :])
    assert np.allclose(estimate.predicted(seen)[:, 0], columns @ truth, atol=0.02)  # type: ignore[arg-type]
