"""A model with its allocation set aside is the model without it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import allocation_models as models
import pytest

from symgen.cli.main import main
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.results import Options
from symgen.ir.bounded import bounds_of
from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_model, load_text


def test_nothing_of_the_block_is_left() -> None:
    block = "allocation: {weights: {p: 2}, preload: 1, limits: {s: [-1, 1]}}\n"
    made = without_allocation(load_text(models.PLATE + block, "m.yaml"))
    plain = load_text(models.PLATE, "m.yaml")
    assert replace(made, text_hash="") == replace(plain, text_hash="")
    assert without_allocation(plain) is plain


def test_preferred_values_too() -> None:
    made = without_allocation(load_text(models.SKID + "allocation: {preload: {p: 2, v: 1}}\n", "m.yaml"))
    assert replace(made, text_hash="") == replace(load_text(models.SKID, "m.yaml"), text_hash="")


@pytest.mark.campaign
def test_bounds_of_what_is_set_aside_are_set_aside(tmp_path: Path) -> None:
    """A verification may have bounded weights and limits, which other tools and methods know nothing of."""
    path = tmp_path / "plate.yaml"
    path.write_text(f"{models.PLATE}allocation: {{weights: {{p: 0.5}}}}\noutputs: [inverse_dynamics]\n")
    assert main([str(path), "--out", str(tmp_path), "--only", "c", "--states", "8", "--quiet"]) == 0
    record = tmp_path / "plate/derivation.json"
    content = json.loads(record.read_bytes())
    kernel = content["kernels"]["inverse_dynamics"]
    kernel["bounds"]["float64"] = {"weight_p": [0.1, 9], "mass": [0.1, 9]}
    record.write_text(json.dumps(content), encoding="utf-8")
    model = without_allocation(load_model(path))
    draft = as_recorded(model, ("inverse_dynamics",), Options(scalars=("float64",), measured=tmp_path))
    (written,) = draft.written["float64"].kernels
    assert [bound.parameter for bound, _ in bounds_of(written)] == ["mass"]
