"""Batches with fused multiply-adds have other bits, which are held against the same expectations."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from shipped import ROOT

from symgen.cli import main as cli
from symgen.verify import run
from symgen.verify.running import contracted
from symgen.verify.running.compile import Outcome, find_compiler

pytestmark = pytest.mark.toolchain
CAR = ROOT / "models/rear_car.yaml"
QUICKLY = ["--outputs", "inverse_dynamics", "--only", "c", "--states", "8"]


def certificate(folder: Path, *further: str) -> dict[str, Any]:
    assert cli.main([str(CAR), *QUICKLY, "--out", str(folder), *further]) == 0
    made: dict[str, Any] = json.loads((folder / "rear_car/certificate.json").read_bytes())
    return made


def need_fused(tool: Callable[[str], str]) -> None:
    tool("cc")
    compiler = find_compiler()
    assert compiler is not None
    if not contracted.is_fused(compiler):
        pytest.skip("this machine has no fused multiply-add")


def test_contracted_batches_are_verified(tool: Callable[[str], str], tmp_path: Path) -> None:
    need_fused(tool)
    errors = {(one["target"], one["quantity"]): one for one in certificate(tmp_path, "--contract")["errors"]}
    for scalar in ("float64", "float32"):
        plain = errors[f"C {scalar} batch", "inverse_dynamics"]
        fast = errors[f"C {scalar} batch fused", "inverse_dynamics"]
        assert fast["largest"] <= 16
        assert fast["median"] != plain["median"], "nothing was contracted"


def test_without_the_option_they_are_not_made(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    assert not [one for one in certificate(tmp_path)["errors"] if "fused" in one["target"]]


@pytest.mark.campaign
def test_what_they_lose_counts(
    tool: Callable[[str], str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    need_fused(tool)
    made = run.run_contracted

    def losing(*given: Any) -> dict[str, list[Outcome]]:
        return {
            name: [Outcome(one.status, tuple(1.001 * x for x in one.entries)) for one in outcomes]
            for name, outcomes in made(*given).items()
        }

    monkeypatch.setattr(run, "run_contracted", losing)
    assert cli.main([str(CAR), *QUICKLY, "--out", str(tmp_path), "--contract"]) == 1
    said = capsys.readouterr().err
    assert "C float64 batch fused, inverse_dynamics: error" in said
    assert "C float64 batch, inverse_dynamics" not in said


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"FLAGS": (*contracted.FLAGS, "-include", "missing.h")}, "missing.h"),
        ({"LONGEST_COMPILATION": 0.001, "LONGEST_FOR_A_MEGABYTE": 0.0}, "name a working C compiler of this machine"),
    ],
    ids=["refuses", "hangs"],
)
def test_a_compiler_that_makes_none_is_a_fault(
    tool: Callable[[str], str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    changed: dict[str, Any],
    complaint: str,
) -> None:
    need_fused(tool)
    for name, value in changed.items():
        monkeypatch.setattr(contracted, name, value)
    assert cli.main([str(CAR), *QUICKLY, "--out", str(tmp_path), "--contract"]) == 1
    said = capsys.readouterr().err
    assert "C float64 batch fused does not compile" in said
    assert complaint in said


def test_machines_that_contract_nothing_say_so(
    tool: Callable[[str], str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    tool("cc")
    monkeypatch.setattr(contracted, "FUSED", ())
    made = certificate(tmp_path, "--contract")
    assert not [one for one in made["errors"] if "fused" in one["target"]]
    assert run.NOT_FUSED in made["notes"]
    assert "nothing is contracted: " in capsys.readouterr().err
