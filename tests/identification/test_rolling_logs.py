"""Estimates of a car that rolls, whose loops are none: all places measured, rates by its wheels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from rolling_log import CAR, CAR_PLACES, CAR_TRUTH, rolling_log
from simulated_logs import Array, functions_of, of_file

from symgen.identification.combinations import default_like
from symgen.identification.estimates.identification import Identification

# Standard errors, the share of estimates within them, and what estimates may add to the noise of unseen motion.
CLOSE, CLOSE_SHARE, NEAR_NOISE = 3.0, 0.97, 1.2
COURSES = 20


def of_course(folder: Path, seed: int) -> Identification:
    path = folder / "log.csv"
    rolling_log(path, seed)
    return of_file(path, CAR, CAR_PLACES)


def car_truth(made: Identification) -> Array:
    """Base parameters of the car that the logs are of."""
    numbers = default_like(made.model, functions_of(CAR, CAR_PLACES).parameters, CAR_TRUTH)
    return np.array([*made.combinations.at(numbers), *(numbers[name] for name in made.names.linear)])


def test_a_car_that_rolls(tmp_path: Path) -> None:
    """The mass of the whole car, its inertia about the rear axle, the rotor of the steering drive."""
    made = of_course(tmp_path, 0)
    shown = {one.name.split(" ")[0]: one for one in made.parameters}
    length = functions_of(CAR, CAR_PLACES).parameters["L"]
    for name, value in (("chassis.m", 1380), ("chassis.Izz", 1800 + 80 * length**2), ("phi.Ir", 2)):
        assert abs(shown[name].value - value) < CLOSE * shown[name].error
        assert shown[name].error < 0.01 * value


@pytest.mark.campaign
def test_errors_are_honest_over_many_courses(tmp_path: Path) -> None:
    logs = [of_course(tmp_path, seed) for seed in range(COURSES)]
    off = np.concatenate([(made.estimate.values - car_truth(made)) / made.estimate.errors for made in logs])
    assert np.mean(np.abs(off) < CLOSE) >= CLOSE_SHARE
    assert 0.5 < np.sqrt(np.mean(off**2)) < 1.3
    added = []
    for made in logs:
        left = np.sqrt(np.mean((made.aside.inputs - made.aside.columns @ car_truth(made)) ** 2, axis=0))
        added += [*(np.sqrt(np.mean(made.residuals(made.aside) ** 2, axis=0)) / left)]
    assert np.mean(np.array(added) < NEAR_NOISE) >= CLOSE_SHARE
