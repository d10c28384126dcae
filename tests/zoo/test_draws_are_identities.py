"""Drawn systems are derived and written by identities, evaluated exactly, whatever fingerprints say."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.diagnostics import ModelError
from symgen.ir.given_trig import given_trig
from symgen.ir.prepare import prepare
from symgen.laboratory.zoo.draws.families import FAMILIES, draw
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.identity import every_identity_evaluated

SEED = 20
# By energies, by bodies, with a loop; the others are members of the campaign of tests.
FEW = ("disc", "tree_bodies", "sarrus")


def _first(family: str, folder: Path) -> Model:
    """The first draw that is not refused, as some are on purpose."""
    for index in range(12):
        try:
            description = draw(SEED, index, family)
            for name, text in {**description.files, "zoo.yaml": description.text}.items():
                (folder / name).write_text(text)
            return load_model(folder / "zoo.yaml")
        except ModelError:
            continue
    raise AssertionError(f"all draws of {family} are refused")


@pytest.mark.parametrize(
    "family",
    [
        family if family in FEW else pytest.param(family, marks=pytest.mark.campaign)
        for family in FAMILIES
    ],
)
def test_every_rewriting_of_a_draw_is_an_identity(family: str, tmp_path: Path) -> None:
    model = _first(family, tmp_path)
    with every_identity_evaluated():
        derivations = derive_quantities(model, model.outputs)
        program = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"]
        prepare(program, [kernel.name for kernel in program.kernels])
        for kernel in program.kernels:
            given_trig(kernel)
    assert program.kernels
