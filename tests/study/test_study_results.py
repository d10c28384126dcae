"""The command from end to end, the Zarr that xarray reads, the page and its pictures."""

from __future__ import annotations

import re
import subprocess
import sys
from base64 import b64decode
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from studied_arm import ARM, SHIPPED, arm_file, opened, plan_of, results_of

from symgen.cli.main import main
from symgen.model.load import load_model
from symgen.study import estimate
from symgen.study.asked.request import check_request
from symgen.study.asked.study_file import read_study
from symgen.study.plan import planned_study
from symgen.study.shown.page import study_page
from symgen.study.shown.pictures import StudyPicture, study_pictures

pytestmark = [pytest.mark.toolchain, pytest.mark.slow]


def test_a_study_file_from_end_to_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "arm.yaml").write_text(ARM)
    study = tmp_path / "study.yaml"
    study.write_text(
        "model: arm.yaml\nover: {m: [1, 8, 5], g: [5, 10, 4]}\nalong: swing\n"
        "show: [utilisation]\nquantiles: [1/10, 0.9]\n"
    )
    assert main(["study", str(study), "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr()
    assert "20 points of 41 states each, 820 states" in printed.err
    assert re.search(r"largest utilisation +\d\.\d+ +m = 8, g = 10, t = ", printed.out)
    folder = tmp_path / "out" / "arm"
    assert sorted(path.name for path in folder.iterdir()) == [".symgen-files", "study.html", "study.zarr"]
    with opened(folder / "study.zarr") as results:
        assert results.utilisation_max.dims == ("m", "g")
        assert results.utilisation_quantiles.dims == ("m", "g", "quantile")
        assert results["quantile"].values.tolist() == [0.1, 0.9]
        assert results.m.attrs == {"long_name": "mass at the tip", "units": "kg"}
        assert results.utilisation_max.attrs["units"] == "1"
        assert results.attrs["over"] == {"m": [1.0, 8.0, 5], "g": [5.0, 10.0, 4]}
        assert re.fullmatch("[0-9a-f]{64}", results.attrs["model_hash"])
        assert results.attrs["statuses"] == {"0": 820}
        low, high = results.utilisation_quantiles.values[..., 0], results.utilisation_quantiles.values[..., 1]
        assert (low <= high).all()
        assert (high <= results.utilisation_max.values).all()
    page = (folder / "study.html").read_text()
    assert "m from 1 to 8 kg, 5 values" in page
    assert "path swing, 41 states" in page


@pytest.mark.campaign
def test_more_states_than_anybody_asks_for_by_mistake(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(estimate, "MOST_UNASKED_STATES", 100)
    monkeypatch.setattr("symgen.study.command.MOST_UNASKED_STATES", 100)
    given = ["study", str(arm_file()), "--over", "b=0.4:2:101", "--show", "inputs", "--out", str(tmp_path), "--quiet"]
    assert main(given) == 2
    assert re.search(
        r"arm: 101 points, 101 states, \d+ kB of results, about 1 s of one core; add --yes", capsys.readouterr().err
    )
    assert not (tmp_path / "arm" / "study.partial").exists()
    assert main([*given, "--yes"]) == 0


def test_an_estimate_grows_with_the_points() -> None:
    plan = plan_of(["m=1:8:1000000", "g=5:10:1000000"], "inputs", along=("swing",))
    assert plan.points * plan.states == 41 * 10**12
    assert estimate.study_size(plan) == 10**12 * (6 * 3 + 2) * 8
    durations = [estimate.duration(seconds) for seconds in (0.1, 100.0, 600.0, 9000.0, 9e5)]
    assert durations == ["1 s", "100 s", "10 min", "2 h", "10 days"]


def test_nothing_can_be_assembled(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--over", "x=3:4:5", "--over", "y=3:4:5", "--show", "inputs", "--out", str(tmp_path), "--quiet"]
    assert main(["study", str(arm_file()), *given]) == 1
    complaint = capsys.readouterr().err
    assert "the model cannot be assembled anywhere in the study\n  25 states: the place is out of reach" in complaint
    assert list((tmp_path / "arm").iterdir()) == []


def pictures(folder: Path, over: list[str], show: str, **more: Any) -> list[StudyPicture]:
    plan = plan_of(over, show, **more)
    made = study_pictures(plan, results_of(folder / "partial", plan))
    for picture in made:
        root = ElementTree.fromstring(picture.text)
        assert root.tag.endswith("svg")
        assert "href" not in re.sub('xlink:href="(#|data:image/png)[^"]*"', "", picture.text).replace("xmlns:xlink", "")
    return made


def filled(picture: StudyPicture) -> int:
    """Paths of a picture that are drawn with a colour of their own."""
    return len(set(re.findall(r"fill: (#[0-9a-f]{6})", picture.text)))


def test_one_axis_is_a_curve_with_a_band(tmp_path: Path) -> None:
    (along,) = pictures(tmp_path / "a", ["m=1:8:9"], "inputs", along=("swing",), quantiles=("0.1", "0.9"))
    assert "outer quantiles" in along.caption
    assert along.text.count("FillBetweenPolyCollection") == 6
    (alone,) = pictures(tmp_path / "b", ["m=1:8:9"], "utilisation")
    assert alone.text.count("FillBetweenPolyCollection") == 0


def test_two_axes_are_a_map_with_the_curve_where_drives_are_singular(tmp_path: Path) -> None:
    made = pictures(tmp_path, ["a=-1:1:9", "b=0.4:2.4:31"], "utilisation,singularity")
    assert [picture.title.partition(" ")[0] for picture in made] == ["share", "distances", "det", "singular"]
    assert filled(made[0]) > 8
    assert "thick one is where it vanishes" in made[2].caption
    assert "singular" in made[3].title
    # u_1 and u_2 alone are singular nowhere: all three are as far from it as can be
    assert made[3].caption.endswith("distance from singularities is 1 or more at each point.")


def test_more_axes_are_scattered_and_many_are_lines_across(tmp_path: Path) -> None:
    (three,) = pictures(tmp_path / "a", ["m=1:8:4", "l=0.3:0.8:4", "g=1:9:4"], "inputs")
    assert three.text.count("PathCollection") == 3
    more = {"sample": "sobol", "count": 64}
    (five,) = pictures(tmp_path / "b", ["m=1:8", "l=0.3:0.8", "g=1:9", "a=-1:1", "b=1:2"], "inputs", **more)
    assert "line is a point" in five.caption
    (one,) = pictures(tmp_path / "c", ["m=1:8"], "inputs", **more)
    assert "dot is a point" in one.caption


def test_the_same_results_have_the_same_pictures(tmp_path: Path) -> None:
    plan = plan_of(["a=-1:1:9", "b=0.4:2.4:11"], "utilisation")
    results = results_of(tmp_path / "partial", plan)
    assert study_pictures(plan, results) == study_pictures(plan, results)


def test_a_page_holds_all_it_shows_and_nothing_of_others() -> None:
    picture = StudyPicture("a <b>", "c & d", "<svg/>")
    page = study_page("<script>", [("model", "<i>")], [("worst", ("x",), [("<u>",)]), ("none", ("y",), [])], [picture])
    assert not re.search("<(script|i|u|b)>", page)
    assert "None" not in page
    (data,) = re.findall(r'src="data:image/svg\+xml;base64,([^"]*)"', page)
    assert b64decode(data) == b"<svg/>"
    assert not re.search("https?://", page)


def test_a_study_is_light_where_nothing_is_studied() -> None:
    code = "import sys, symgen.cli.main; sys.exit(any(n in sys.modules for n in ('dask', 'zarr', 'xarray', 'numpy')))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_values_of_a_grid_are_those_that_were_asked_for(tmp_path: Path) -> None:
    results = results_of(tmp_path / "partial", plan_of(["m=1:8:5"], "inputs"))
    assert (results.m.values == np.linspace(1, 8, 5)).all()


def test_the_study_file_of_the_documentation_is_one() -> None:
    page = (SHIPPED.parent / "docs" / "study.md").read_text(encoding="utf-8")
    (block,) = re.findall("```yaml\n(.*?)```", page, re.DOTALL)
    request, mistakes = read_study(SHIPPED / "study.yaml", block)
    check_request(mistakes, request)
    plan = planned_study(load_model(request.model), request, mistakes)
    assert (plan.points, plan.states, plan.shown) == (4096, 201, ("inputs", "power"))
    options = set(re.findall(r"`--(\w+)", page)) - {"yes"}
    assert options == {"over", "along", "show", "sample", "count", "seed", "quantiles", "size", "workers", "scheduler"}
