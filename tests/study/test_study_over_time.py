"""What a path asks for at each time, over the points of a study: bands against each point by itself."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from studied_arm import ARM, arm_file, opened, plan_of, results_of, study_of

from symgen.cli.main import main
from symgen.study.shown.over_time import MOST_BAND_POINTS, TimeBand, band_pictures, time_bands
from symgen.study.work import StudyWork

pytestmark = [pytest.mark.toolchain, pytest.mark.slow]


def of_inputs(work: StudyWork) -> TimeBand:
    (band,) = (one for one in time_bands(work) if one.interest.name == "inputs")
    return band


def test_bands_are_those_of_the_points_one_by_one(tmp_path: Path) -> None:
    band = of_inputs(study_of(tmp_path / "all", plan_of(["m=1:8:5"], "inputs", along=("swing",))))
    alone = [
        of_inputs(study_of(tmp_path / str(k), plan_of([f"m={mass}:{mass}:1"], "inputs", along=("swing",))))
        for k, mass in enumerate(np.linspace(1, 8, 5).tolist())
    ]
    each = np.stack([one.mean for one in alone])
    assert band.points == 5
    assert np.array_equal(band.times, np.linspace(0, 1, 41))
    assert np.array_equal(band.low, each.min(axis=0))
    assert np.array_equal(band.high, each.max(axis=0))
    assert np.allclose(band.mean, each.mean(axis=0), rtol=1e-14)
    assert [value for value, _ in band.lines] == np.linspace(1, 8, 5).tolist()
    assert all(np.array_equal(values, one) for (_, values), one in zip(band.lines, each, strict=True))
    # what a path asks for differs from one time to another and from one mass to another
    assert (np.ptp(band.high, axis=1) > 1).all()
    assert (band.high - band.low > 1e-3).any(axis=1).all()


def test_bands_reach_to_what_the_points_have_along_the_path(tmp_path: Path) -> None:
    plan = plan_of(["m=1:8:5", "l=0.4:0.6:3"], "inputs,utilisation", along=("swing",))
    bands = {one.interest.name: one for one in time_bands(study_of(tmp_path / "work", plan))}
    results = results_of(tmp_path / "partial", plan)
    for name, band in bands.items():
        largest = results[f"{name}_max"].values.reshape(15, -1).max(axis=0)
        assert np.array_equal(band.high.max(axis=1), largest)
        smallest = results[f"{name}_min"].values.reshape(15, -1).min(axis=0)
        assert np.array_equal(band.low.min(axis=1), smallest)
        assert band.lines == ()
    assert set(bands) == {"inputs", "utilisation"}


@pytest.mark.parametrize("sample", ["sobol", "latin_hypercube", "random"])
def test_of_many_points_some_are_looked_at(sample: str, tmp_path: Path) -> None:
    plan = plan_of(["m=1:8"], "inputs", along=("swing",), sample=sample, count=4096, seed=1)
    work = study_of(tmp_path / "work", plan)
    band = of_inputs(work)
    results = results_of(tmp_path / "partial", plan)
    assert band.points == MOST_BAND_POINTS < plan.points
    assert (band.high.max(axis=1) <= results.inputs_max.values.max(axis=0)).all()
    # masses that stand evenly among all reach nearly as far
    assert (band.high.max(axis=1) > 0.95 * results.inputs_max.values.max(axis=0)).all()
    (picture,) = band_pictures(plan, [band])
    assert f"{MOST_BAND_POINTS} of 4,096 points" in picture.caption


def test_a_point_without_the_path_stands_in_no_band(tmp_path: Path) -> None:
    model = tmp_path / "arm.yaml"
    conditions = '{of_x: "tip_x - 0.7 - 0.05*sin(2*pi*t)", of_y: tip_y - 0.1}'
    model.write_text(re.sub(r"(?m)(?<=conditions: ).*$", conditions, ARM))
    plan = plan_of(["l=0.3:0.5:2"], "inputs", model, ("swing",))
    band = of_inputs(study_of(tmp_path / "both", plan))
    alone = of_inputs(study_of(tmp_path / "one", plan_of(["l=0.5:0.5:1"], "inputs", model, ("swing",))))
    # links of 0.3 m do not reach that far
    assert band.points == 2
    assert np.isnan(band.lines[0][1]).all()
    assert np.array_equal(band.mean, alone.mean)
    assert np.array_equal(band.low, alone.low)
    (picture,) = band_pictures(plan, [band])
    assert picture.text.startswith("<?xml")


def test_results_and_page_have_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["--over", "m=1:8:5", "--along", "swing", "--show", "inputs", "--out", str(tmp_path)]
    assert main(["study", str(arm_file()), *asked]) == 0
    assert "study.html" in capsys.readouterr().out
    with opened(tmp_path / "arm" / "study.zarr") as results:
        assert results.inputs_t_max.dims == ("t", "input")
        assert results.t.attrs == {"long_name": "time along the path", "units": "s"}
        assert results.inputs_t_max.attrs["units"] == "N*m"
        assert float(results.inputs_t_max.max()) == float(results.inputs_max.max())
    assert "over the time" in (tmp_path / "arm" / "study.html").read_text()


def test_without_a_path_there_are_none(tmp_path: Path) -> None:
    work = study_of(tmp_path / "work", plan_of(["x=0.4:0.6:3", "y=0.2:0.4:3"], "singularity"))
    assert time_bands(work) == ()
