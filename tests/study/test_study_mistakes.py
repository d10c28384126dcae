"""Every mistake in a study is told with its place or its option, all at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from studied_arm import ARM, SHIPPED, arm_file

from symgen.cli import studying
from symgen.cli.main import main
from symgen.study.asked.request import SHOWN

RAPKM = SHIPPED / "rapkm_2rrr_rr.yaml"
OPTIONS = {
    "nothing": ([], "--over: nothing is varied"),
    "no range": (["--over", "m=1", "--show", "inputs"], "--over: 'm=1' is no range; write NAME=FIRST:LAST:COUNT"),
    "infinite": (["--over", "m=0:inf:3", "--show", "inputs"], "--over: 'm=0:inf:3' is no range"),
    "empty": (["--over", "m=3:1:4", "--show", "inputs"], "--over: the range of `m` from 3 to 1 is empty"),
    "no count": (["--over", "m=1:3", "--show", "inputs"], "--over: a grid needs the number of values of `m`"),
    "none": (["--over", "m=1:3:0", "--show", "inputs"], "--over: `m` has 0 values"),
    "one": (["--over", "m=1:3:1", "--show", "inputs"], "--over: one value of `m` cannot reach from 1 to 3"),
    "twice": (["--over", "m=1:3:3", "--over", "m=1:3:3", "--show", "inputs"], "--over: `m` is varied twice"),
    "unknown": (["--over", "mm=1:3:3", "--show", "inputs"], "the model has no parameter, coordinate or task `mm`"),
    "two places": (["--over", "x=0:1:2", "--over", "a=0:1:2", "--show", "reach"], "give places in two ways"),
    "path": (["--over", "m=1:3:3", "--along", "swig", "--show", "inputs"], "--along: the model has no path `swig`"),
    "place": (["--over", "a=0:1:3", "--along", "swing", "--show", "inputs"], "`a` is a place, and the path `swing`"),
    "two paths": (["--over", "m=1:3:3", "--along", "swing", "--along", "x=0:1:2"], "--along: swing, x=0:1:2 are"),
    "no show": (["--over", "m=1:3:3"], "--show: nothing to show; choose from inputs, power"),
    "shown": (["--over", "m=1:3:3", "--show", "inptus"], "--show: the model has no quantity of interest `inptus`"),
    "sample": (["--over", "m=1:3", "--sample", "sobl"], "--sample: 'sobl' is no sample; did you mean `sobol`?"),
    "no number": (["--over", "m=1:3", "--sample", "sobol", "--show", "inputs"], "--count: a sobol sample needs"),
    "count": (["--over", "m=1:3:4", "--count", "4", "--show", "inputs"], "--count: a grid has as many points"),
    "few": (["--over", "m=1:3", "--sample", "sobol", "--count", "0", "--show", "inputs"], "--count: 0 points"),
    "values": (["--over", "m=1:3:4", "--sample", "sobol", "--count", "4"], "`m` has a number of values"),
    "strata": (
        ["--over", "m=1:3", "--sample", "latin_hypercube", "--count", "100000000", "--show", "inputs"],
        "--count: a latin_hypercube sample has at most 10000000 points",
    ),
    "seed": (["--over", "m=1:3:4", "--seed", "-1", "--show", "inputs"], "--seed: -1 is no seed"),
    "modes": (["--over", "m=1:3:4", "--show", "modes"], "--show: `modes` are those of a place, which nothing gives"),
    "regular": (["--over", "m=1:3:4", "--show", "regular"], "--show: `regular` is said of a place, which nothing"),
    "level": (["--over", "m=1:3:4", "--quantiles", "2,x", "--show", "inputs"], "--quantiles: 'x' is no number"),
    "many": (["--over", "m=1:3:4", "--along", "x=0:1:9999999", "--show", "reach"], "states at each point"),
    "workers": (["--over", "m=1:3:4", "--workers", "0"], "argument --workers: '0' is no whole number from 1 up"),
}


@pytest.mark.parametrize("given", OPTIONS.values(), ids=OPTIONS)
def test_an_option_is_named(given: tuple[list[str], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options, expected = given
    try:
        code = main(["study", str(arm_file()), *options, "--out", str(tmp_path), "--quiet"])
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    assert expected in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--over", "mm=1:3:3", "--over", "l=3:1:2", "--along", "swig", "--show", "inptus", "--quantiles", "2"]
    assert main(["study", str(arm_file()), *options, "--out", str(tmp_path), "--quiet"]) == 2
    complaint = capsys.readouterr().err
    for expected in ("--over: the range of `l`", "task `mm`", "no path `swig`", "interest `inptus`", "2 is no level"):
        assert expected in complaint


OF_MODELS = {
    "follows": ("b_1=0:1:3", "inputs", "`b_1` follows from the others, which close the loops"),
    "no limits": ("m_1=0.1:1:3", "utilisation", "`utilisation` is the share of limits, which the inputs do not have"),
}


@pytest.mark.parametrize("given", OF_MODELS.values(), ids=OF_MODELS)
def test_what_a_model_does_not_have(
    given: tuple[str, str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    over, shown, expected = given
    assert main(["study", str(RAPKM), "--over", over, "--show", shown, "--out", str(tmp_path), "--quiet"]) == 2
    assert expected in capsys.readouterr().err


def test_a_model_without_inputs_has_none_to_show(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = ARM.splitlines()
    first, last = lines.index("inputs:"), lines.index("task: {x: tip_x, y: tip_y}")
    model = tmp_path / "free.yaml"
    model.write_text("\n".join([*lines[:first], *lines[last:]]).replace("[inverse_dynamics]", "[mass_matrix]"))
    assert main(["study", str(model), "--over", "m=1:2:3", "--show", "power", "--out", str(tmp_path), "--quiet"]) == 2
    assert "--show: `power` needs inputs, of which the model has none" in capsys.readouterr().err


FILES = {
    "over": ("  m: [3, 1, 4]", "3:3: the range of `m` from 3 to 1 is empty"),
    "name": ("  mm: [1, 3, 4]", "3:3: the model has no parameter, coordinate or task `mm`"),
    "kind": ("  m: 5", "3:6: `m` is a single value"),
    "number": ("  m: [1, x, 4]", "3:10: "),
    "values": ("  m: [1, 3, 2.5]", "3:13: the number of values of `m` is not a whole number"),
    "path": ("  m: [1, 3, 4]\nalong: swig", "4:8: the model has no path `swig`"),
    "sample": ("  m: [1, 3, 4]\nsample: gird", "4:9: `sample` is `gird`, which is not known"),
    "count": ("  m: [1, 3]\nsample: random\ncount: 0", "5:8: `count` is not a whole number from 1"),
    "seed": ("  m: [1, 3, 4]\nseed: -4", "4:7: `seed` is not a whole number from 0"),
    "key": ("  m: [1, 3, 4]\nalnog: swing", "4:1: `alnog` is no key of the study"),
    "level": ("  m: [1, 3, 4]\nquantiles: [0.5, 7]", "4:12: 7 is no level between 0 and 1"),
    "alias": ("  m: &m [1, 3, 4]", "3:6: YAML anchors are not read"),
}


@pytest.mark.parametrize("given", FILES.values(), ids=FILES)
def test_a_mistake_in_a_file_has_its_place(
    given: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines, expected = given
    (tmp_path / "arm.yaml").write_text(ARM)
    study = tmp_path / "study.yaml"
    study.write_text(f"model: arm.yaml\nover:\n{lines}\nshow: [inputs]\n")
    assert main(["study", str(study), "--out", str(tmp_path / "out"), "--quiet"]) == 1
    complaint = capsys.readouterr().err
    assert f"{study}:{expected}" in complaint
    assert "remedy: " in complaint


def test_mistakes_in_a_file_are_told_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "arm.yaml").write_text(ARM)
    study = tmp_path / "study.yaml"
    study.write_text("model: arm.yaml\nover:\n  mm: [3, 1, 4]\nalong: swig\nshow: [inputs]\n")
    assert main(["study", str(study), "--out", str(tmp_path / "out"), "--quiet"]) == 1
    complaint = capsys.readouterr().err
    assert all(f"{study}:{place}: " in complaint for place in ("3:3", "4:8"))
    assert "is empty" in complaint
    assert "no parameter, coordinate or task" in complaint


@pytest.mark.parametrize("name", ["/etc/passwd", "arm.txt", "nothing.yaml"])
def test_a_model_is_a_model_file_seen_from_the_study(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "arm.txt").write_text(ARM)
    study = tmp_path / "study.yaml"
    study.write_text(f"model: {name}\nover: {{m: [1, 3, 4]}}\nshow: [inputs]\n")
    assert main(["study", str(study), "--out", str(tmp_path / "out"), "--quiet"]) == 1
    assert f"{study}:1:8: there is no model file {name} seen from this one" in capsys.readouterr().err


def test_what_a_study_file_says_is_not_said_by_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = tmp_path / "study.yaml"
    study.write_text("model: arm.yaml\nover: {m: [1, 3, 4]}\nshow: [inputs]\n")
    assert main(["study", str(study), "--seed", "3", "--quiet"]) == 2
    assert f"--seed: {study} is a study file, which says that" in capsys.readouterr().err


def test_without_its_packages_a_study_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(studying, "find_spec", lambda name: None if name in ("dask", "zarr") else name)
    assert main(["study", str(arm_file()), "--over", "m=1:2:3", "--show", "inputs"]) == 2
    complaint = capsys.readouterr().err
    assert complaint == "symgen: a study needs dask and zarr, which are not installed: pip install 'symgen[study]'\n"


def test_help_names_all_that_can_be_shown(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["study", "--help"])
    assert ", ".join(SHOWN) in " ".join(capsys.readouterr().out.split())
