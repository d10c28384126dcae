"""Of two criteria of a machine the variants that no other beats in both."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from studied_arm import SHIPPED, plan_of, results_of

from symgen.study.shown.compromises import best_points, compromise_picture, compromise_table, compromises

pytestmark = pytest.mark.toolchain


@pytest.mark.parametrize("seed", range(5))
def test_the_best_points_are_those_that_no_other_beats(seed: int) -> None:
    random = np.random.default_rng(seed)
    # ties in one of the two, or in both, and points without a result
    x, y = (np.where(random.random(60) < 0.1, np.nan, random.integers(0, 12, 60).astype(float)) for _ in range(2))
    best = best_points(x, y)
    expected = {
        (x[k], y[k])
        for k in range(60)
        if np.isfinite(x[k] + y[k])
        and not any(x[j] <= x[k] and y[j] <= y[k] and (x[j] < x[k] or y[j] < y[k]) for j in range(60))
    }
    assert [(x[k], y[k]) for k in best] == sorted(expected)


def test_nothing_known_has_no_best() -> None:
    assert len(best_points(np.array([np.nan, 1.0]), np.array([2.0, np.nan]))) == 0


def test_longer_arms_of_a_platform_need_more_and_are_further_from_singularities(tmp_path: Path) -> None:
    """Inputs are bad where they are large, singular values where they are small."""
    model = SHIPPED / "rapkm_2rrr_rr.yaml"
    plan = plan_of(["l_1=0.2:0.28:3", "l_2=0.2:0.28:3"], "inputs,control", model=model, along=("circle",))
    results = results_of(tmp_path / "work/partial", plan)
    (pair,) = compromises(plan, results)
    assert (pair.first.name, pair.second.name) == ("inputs", "control")
    inputs = results.inputs_largest.values.max(axis=-1).ravel()
    control = results.control_min.values.ravel()
    assert (pair.x == inputs).all()
    assert (pair.y == control).all()
    assert 1 < len(pair.best) < 9
    for k in range(9):
        better = (inputs < inputs[k]) | (control > control[k])
        beaten = bool(((inputs <= inputs[k]) & (control >= control[k]) & better).any())
        assert (k in pair.best) is not beaten
    heading, columns, rows = compromise_table(plan, results, pair)
    assert heading == "best of inputs and control"
    assert columns == ("l_1", "l_2", "worst inputs", "worst control")
    assert [float(row[2]) for row in rows] == sorted(float(row[2]) for row in rows)
    assert f"{len(pair.best)} of 9 variants are best" in compromise_picture(pair).caption


def test_places_are_no_variants(tmp_path: Path) -> None:
    plan = plan_of(["b=0.4:2:5"], "inputs,control")
    assert compromises(plan, results_of(tmp_path / "work/partial", plan)) == ()
