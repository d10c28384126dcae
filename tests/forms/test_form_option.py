"""`--form`: a form by name, its singular set in derivation.json, and the answer to one that does not apply."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from symgen.cli import main

ROOT = Path(__file__).resolve().parents[2]
RAPKM = str(ROOT / "models" / "rapkm_2rrr_rr.yaml")
CAR = str(ROOT / "models" / "front_car.yaml")
PENDULUM = str(ROOT / "models" / "double_pendulum.yaml")
FEW = ("--outputs", "inverse_dynamics", "--only", "c", "--no-verify", "--scalar", "float64", "--quiet")


def generated(folder: Path, model: str, *options: str) -> dict[str, object]:
    assert main([model, *FEW, "--out", str(folder), *options]) == 0
    (path,) = folder.glob("*/derivation.json")
    form = json.loads(path.read_text())["form_of_inverse_dynamics"]
    assert isinstance(form, dict)
    return form


def test_auto_names_its_form_and_why_it_is_valid(tmp_path: Path) -> None:
    form = generated(tmp_path, RAPKM)
    assert form["name"] == "range"
    assert form["valid_at_every_regular_state"] is True
    assert form["because"] == "denominators and pivots: 3 proved to vanish only where a rank drops"


def test_a_singular_form_is_made_and_says_where_it_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    form = generated(tmp_path, RAPKM, "--form", "nullspace")
    assert form["valid_at_every_regular_state"] is False
    assert isinstance(form["singular"], list)
    (singular,) = form["singular"]
    assert singular["where_zero"] == "l_1*sin(b_2)*l_1*sin(b_3)"
    assert set(singular["for_example"]) >= {"a_1", "b_3"}
    assert main([RAPKM, *FEW[:-1], "--out", str(tmp_path), "--form", "nullspace"]) == 0
    assert "this form is singular where l_1*sin(b_2)*l_1*sin(b_3) = 0" in capsys.readouterr().out


def test_a_form_the_system_does_not_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([PENDULUM, *FEW, "--out", str(tmp_path), "--form", "householder"]) == 2
    told = capsys.readouterr().err
    assert "double_pendulum has no form 'householder' of inverse_dynamics: there are no constraints" in told
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("form", ["printed", "kkt"])
def test_the_kernel_is_that_of_the_form(form: str, tmp_path: Path) -> None:
    auto = generated(tmp_path / "auto", CAR)
    named = generated(tmp_path / "named", CAR, "--form", form)
    assert named["name"] == form
    sources = [(tmp_path / name / "front_car" / "c" / "front_car.c").read_text() for name in ("auto", "named")]
    assert sources[0] != sources[1]
    assert auto["name"] != form
