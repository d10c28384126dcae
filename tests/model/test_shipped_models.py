"""The models in models/: complete, valid by the schema, assembled, with paths that start where they say."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import jsonschema
import pytest
import shipped
import yaml
from shipped import ALL, NAMES

from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.file.schema import json_schema
from symgen.model.model import Model
from symgen.model.published import PublishedEquations, PublishedMatrix

FOLDER = Path(__file__).parents[2] / "models"


@cache
def validator() -> jsonschema.Draft202012Validator:
    """By the schema, which is one itself."""
    jsonschema.Draft202012Validator.check_schema(json_schema())
    return jsonschema.Draft202012Validator(json_schema())


@pytest.fixture(params=NAMES)
def model(request: pytest.FixtureRequest) -> Model:
    """Each model in turn."""
    return shipped.model(request.param)


def test_complete(model: Model) -> None:
    assert model.outputs == ("all",)
    assert model.notices == ()
    assert model.description
    assert model.source
    assert model.independent_velocities
    assert model.configuration
    for items in (model.coordinates, model.parameters, model.inputs):
        assert all(item.unit and item.description for item in items)
    assert all(parameter.range is not None for parameter in model.parameters)


@pytest.mark.parametrize("name", ALL)
def test_named_and_described(name: str) -> None:
    model = shipped.model(name)
    assert model.name == name
    assert model.notices == ()
    assert model.source
    assert all(item.unit and item.description for item in (*model.coordinates, *model.parameters, *model.inputs))


@pytest.mark.parametrize("name", ALL)
def test_valid_by_the_schema(name: str) -> None:
    document = yaml.safe_load((FOLDER / f"{name}.yaml").read_text(encoding="utf-8"))
    assert list(validator().iter_errors(document)) == []


@pytest.mark.parametrize(
    "change",
    [
        {"descripton": "x"},
        {"coordinates": {}},
        {"coordinates": {"1x": {}}},
        {"outputs": ["mass_matrx"]},
        {"inputs": [1]},
    ],
    ids=str,
)
def test_the_schema_refuses(change: dict[str, object]) -> None:
    document = yaml.safe_load((FOLDER / "skate.yaml").read_text(encoding="utf-8"))
    with pytest.raises(jsonschema.ValidationError):
        validator().validate({**document, **change})


def test_configuration_is_assembled(model: Model) -> None:
    mechanics = NumericSystem(
        model.coordinates, model.parameters, model.definitions, model.constraints, model.kinetic_energy
    )
    start = dict(model.configuration)
    q = [float(start[c.name]) for c in model.coordinates]
    residual, _ = mechanics.residuals(q, range(len(mechanics.geometric)))
    assert all(abs(value) < 1e-3 for value in residual)


@pytest.mark.parametrize(
    ("name", "n", "r", "m"),
    [
        ("skate", 3, 1, 2),
        ("front_car", 4, 2, 2),
        ("front_car_wheelset", 4, 2, 2),
        ("rear_car", 4, 2, 2),
        ("rapkm_2rrr_rr", 6, 4, 3),
        ("rapkm_two_drives", 6, 4, 2),
        ("slider_crank", 3, 2, 1),
        ("double_pendulum", 2, 0, 2),
    ],
)
def test_sizes(name: str, n: int, r: int, m: int) -> None:
    model = shipped.model(name)
    assert (model.n, model.r, model.m) == (n, r, m)


def test_the_two_manipulators_differ_in_drives_only() -> None:
    full, two = shipped.model("rapkm_2rrr_rr"), shipped.model("rapkm_two_drives")
    assert full.inputs[:2] == two.inputs
    assert (full.kinetic_energy, full.constraints, full.definitions) == (
        two.kinetic_energy,
        two.constraints,
        two.definitions,
    )
    assert [(p.name, p.value) for p in full.parameters] == [(p.name, p.value) for p in two.parameters]


def test_shapes_of_published_matrices(model: Model) -> None:
    delta = len(model.independent_velocities)
    sizes = {
        "mass_matrix": (model.n, model.n),
        "coriolis_matrix": (model.n, model.n),
        "constraint_jacobian": (model.r, model.n),
        "control_matrix": (model.n, model.m),
        "nullspace_projector": (model.n, model.n),
        "projected_control_pseudoinverse": (model.m, model.n),
        "orthogonal_complement": (model.n, delta),
        "inverse_dynamics": (model.m, 1),
    }
    for formula in model.published:
        if isinstance(formula, PublishedMatrix):
            for matrix in (formula.value, formula.corrected or formula.value):
                assert (len(matrix), len(matrix[0])) == sizes[formula.quantity], formula.equation
        elif isinstance(formula, PublishedEquations):
            assert len(formula.corrected) in (0, len(formula.equations))


def test_every_printed_formula_of_the_examples_is_there() -> None:
    numbers: set[str] = set()
    for name in ("skate", "front_car", "front_car_wheelset", "rear_car"):
        numbers |= {formula.equation for formula in shipped.model(name).published}
    assert numbers == {f"({number})" for number in range(31, 48)}
