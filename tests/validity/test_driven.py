"""The measure of actuation by minors of the columns that are not driven is the one by minors of the inputs."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
import shipped

from symgen.linear_algebra.null_space.null_spaces import MinorSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME, derive
from symgen.symbolic.evaluate import Evaluator
from symgen.validity.driven import driven_minors


def measures(model: Model, by_minors: bool) -> list[list[float]]:
    mechanics = System(model)
    generic = genericity(mechanics)
    rows = mechanics.constraint_jacobian
    space = (
        MinorSpace(mechanics.graph, rows, mechanics.n, generic.rank)
        if by_minors
        else reflected(mechanics.graph, rows, mechanics.n, generic.rank)
    )
    evaluate = Evaluator(derive(BY_NAME["singularity"], Derivation(mechanics, generic, space)).outputs)
    source = random.Random(model.name)
    values = []
    for _ in range(3):
        point = dict(parameter_values(mechanics))
        point |= {c.name: source.uniform(float(c.range[0]), float(c.range[1])) for c in model.coordinates}
        values.append(list(evaluate(point)))
    return values


def same(model: Model) -> None:
    for one, other in zip(measures(model, by_minors=True), measures(model, by_minors=False), strict=True):
        assert one == pytest.approx(other, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["delta", "five_bar", "three_rrr", "rapkm_2rrr_rr", "rear_car"])
def test_both_methods_agree(name: str) -> None:
    same(shipped.model(name))


def test_two_inputs_on_one_coordinate(tmp_path: Path) -> None:
    path = tmp_path / "twice.yaml"
    text = (shipped.ROOT / "models" / "three_rrr.yaml").read_text(encoding="utf-8")
    name = shipped.model("three_rrr").coordinates[0].name
    path.write_text(text.replace("inputs:\n", f"inputs:\n  again: {{unit: N*m, joint: {name}}}\n", 1), encoding="utf-8")
    same(load_model(path))


def test_inputs_on_several_coordinates_have_no_such_method() -> None:
    mechanics = System(shipped.model("front_car"))
    graph, rows = mechanics.graph, mechanics.constraint_jacobian
    assert driven_minors(graph, rows, mechanics.inputs, mechanics.n) is None
