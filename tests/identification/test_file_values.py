"""Estimates as values of a model file: bodies that can be, layout that stays, what cannot be written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import ARM_WITH_FRICTION, FOUR_BAR_WITH_NAMES, WHEEL

from symgen.identification.combinations import BodyCombinations, base_map, default_like, inertial_values
from symgen.identification.estimates.file_values import FileValues, body_margins, file_values
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.parameter_file import numbers_in_bodies, with_values
from symgen.model.combinations.base_parameters import base_parameters
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model, load_text


def nearest(text: str, names: tuple[str, ...], changes: dict[str, float], error: float) -> FileValues:
    """The values of a file for base parameters that are those of the file but for some, all equally well known."""
    model = load_text(text, "machine.yaml")
    base, numbers = base_parameters(model), default_values(model.parameters)
    target = base_map(base) @ inertial_values(model, numbers)
    for name, value in changes.items():
        target[[one.stays.name for one in base.base].index(name)] = value
    count = len(target)
    root, none = error * np.eye(count), np.empty((count, 0))
    estimate = LinearEstimate(target, root, (), none, np.ones(1), 1.0, np.zeros(count), 0.0)
    return file_values(model, BodyCombinations(base), EstimatedNames(names, (), ()), numbers, estimate)


def test_the_least_change_meets_the_estimates() -> None:
    """Izz + m c² of a wheel from 0.52 to 0.6 with m c as it is: what weighs most moves most, each by its own size."""
    made = nearest(WHEEL, ("m", "I_x", "I_y", "I_z", "c"), {"hub.Izz": 0.6}, 1e-6)
    values = dict(zip(made.names, made.values, strict=True))
    assert values["I_z"] + values["m"] * values["c"] ** 2 == pytest.approx(0.6, abs=1e-5)
    assert values["m"] * values["c"] == pytest.approx(0.2, abs=1e-5)
    assert values["I_x"] == pytest.approx(0.3)
    assert values["I_z"] > 0.57
    assert made.misfit < 1
    errors = dict(zip(made.names, made.errors, strict=True))
    # what no combination shows is as unsure as it was
    assert errors["I_x"] == pytest.approx(0.3, rel=1e-3)
    assert errors["I_z"] < 0.5


def test_what_the_data_do_not_say_stays() -> None:
    made = nearest(WHEEL, ("m", "I_x", "I_y", "I_z", "c"), {}, 1e-3)
    assert np.allclose(made.values, made.before)


@pytest.mark.parametrize("asked", [-0.2, 0.9])
def test_bodies_stay_such_as_can_be(asked: float) -> None:
    """Below 0 Izz becomes Iyy - Ixx, above Ixx + Iyy their sum: as near as a wheel can be, and it is said."""
    names = ("I_z",) if asked > 0 else ("m", "I_z", "c")
    made = nearest(WHEEL, names, {"hub.Izz": asked}, 1e-3)
    assert made.impossible == ("hub",)
    assert not made.kept
    model = load_text(WHEEL, "wheel.yaml")
    numbers = default_like(model, default_values(model.parameters), dict(zip(made.names, made.values, strict=True)))
    assert all(margin > 0 for _, margin in body_margins(model, numbers))
    assert numbers["I_z"] == pytest.approx(0.7 if asked > 0 else 0.1, rel=0.01)


@pytest.mark.parametrize("seed", [1, *(pytest.param(k, marks=pytest.mark.campaign) for k in (0, 2, 3, 4, 5, 6, 7))])
@pytest.mark.parametrize("text", [ARM_WITH_FRICTION, FOUR_BAR_WITH_NAMES])
def test_what_is_well_known_holds_where_the_rest_is_impossible(text: str, seed: int) -> None:
    """Light links, and errors of combinations between 1e-8 and 10: bodies that can be are no further off than the
    truth, though the file is wrong by half of itself."""
    model = load_text(text, "machine.yaml")
    base, numbers = base_parameters(model), default_values(model.parameters)
    generator = np.random.default_rng(seed)
    names = tuple(name for name in numbers if name[:2] in ("m_", "J_", "c_"))
    light = {name: value * (0.02 if name.startswith("J_") else 1.0) for name, value in numbers.items()}
    truth = base_map(base) @ inertial_values(model, light)
    count = len(truth)
    root = np.linalg.qr(generator.normal(size=(count, count)))[0] * np.logspace(-8, 1, count)
    target = truth + root @ generator.normal(size=count)
    estimate = LinearEstimate(target, root, (), np.empty((count, 0)), np.ones(1), 1.0, np.zeros(count), 0.0)
    known = default_like(model, numbers, {name: numbers[name] * generator.uniform(0.3, 1.7) for name in names})
    made = file_values(model, BodyCombinations(base), EstimatedNames(names, (), ()), known, estimate)
    assert made.misfit < 2
    after = default_like(model, known, dict(zip(names, made.values, strict=True)))
    assert all(margin > 0 for _, margin in body_margins(model, after))


def test_bodies_in_the_plane_need_no_other_moments() -> None:
    model = load_text(ARM_WITH_FRICTION, "arm.yaml")
    margins = body_margins(model, default_values(model.parameters))
    assert [name for name, _ in margins] == ["shoulder", "shoulder", "elbow", "elbow"]
    assert all(margin > 0 for _, margin in margins)


def test_layout_and_comments_stay(tmp_path: Path) -> None:
    path = tmp_path / "arm.yaml"
    path.write_text(ARM_WITH_FRICTION, encoding="utf-8")
    made = with_values(path, {"m_1": 2.6123456789, "f_2": 0.1, "J_1": 0.04})
    assert made.text is not None
    assert made.widened == ()
    changed = [(a, b) for a, b in zip(ARM_WITH_FRICTION.split("\n"), made.text.split("\n"), strict=True) if a != b]
    assert changed == [
        ("  m_1: {value: 2.0, unit: kg}      # upper arm", "  m_1: {value: 2.61235, unit: kg}      # upper arm"),
        (
            "  J_1: {value: 0.03, unit: kg*m**2, range: [0.001, 0.05]}",
            "  J_1: {value: 0.04, unit: kg*m**2, range: [0.001, 0.05]}",
        ),
        ("  f_2: {value: 0.2, unit: N*m}", "  f_2: {value: 0.1, unit: N*m}"),
    ]


@pytest.mark.parametrize(("value", "ends"), [(0.08, (0.001, 0.1195)), (0.0005, (0.00025, 0.05))])
def test_a_range_that_an_estimate_is_beyond_is_widened(
    tmp_path: Path, value: float, ends: tuple[float, float]
) -> None:
    path = tmp_path / "arm.yaml"
    path.write_text(ARM_WITH_FRICTION, encoding="utf-8")
    made = with_values(path, {"J_1": value})
    assert made.widened == ("J_1",)
    assert made.text is not None
    (tmp_path / "wider.yaml").write_text(made.text, encoding="utf-8")
    parameter = next(p for p in load_model(tmp_path / "wider.yaml").parameters if p.name == "J_1")
    assert parameter.range is not None
    assert tuple(map(float, parameter.range)) == pytest.approx(ends, rel=0.02)


def test_values_and_line_ends_of_other_kinds(tmp_path: Path) -> None:
    text = ARM_WITH_FRICTION.replace("m_2: {value: 1.0, unit: kg}", "m_2: 1.0").replace("\n", "\r\n")
    path = tmp_path / "arm.yaml"
    path.write_bytes(text.encode())
    made = with_values(path, {"m_2": 0.75})
    assert made.text == text.replace("m_2: 1.0", "m_2: 0.75")


def test_what_is_not_written() -> None:
    text = WHEEL.replace("mass: m,", "mass: 2,").replace("zz: I_z", "zz: 2*0.25")
    assert numbers_in_bodies(load_text(text, "wheel.yaml")) == ("mass of hub", "inertia of hub")
    assert numbers_in_bodies(load_text(WHEEL, "wheel.yaml")) == ()


def test_reasons_for_no_model_file(tmp_path: Path) -> None:
    path = tmp_path / "wheel.yaml"
    path.write_text(WHEEL, encoding="utf-8")
    assert "give masses, centres and inertias names" in with_values(path, {}).why
    path.write_text("model: other\nurdf: robot.urdf\n", encoding="utf-8")
    assert "`urdf` names, which is left as it is" in with_values(path, {"m": 1.0}).why
    path.write_text(WHEEL, encoding="utf-8")
    refused = with_values(path, {"m": 0.0, "I_x": 0.0, "I_y": 0.0, "I_z": 0.0})
    assert refused.text is None
    assert "would not be read with these values" in refused.why
