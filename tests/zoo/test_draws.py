"""What is drawn: the same under any hash seed, assembled at its start, and able to move."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
import yaml

from symgen.diagnostics import ModelError
from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import MISTAKE, Description
from symgen.laboratory.zoo.draws.draw_energy import _surplus
from symgen.laboratory.zoo.draws.endings import MAIN, independent
from symgen.laboratory.zoo.draws.families import FAMILIES, draw
from symgen.laboratory.zoo.draws.sketch import Sketch
from symgen.laboratory.zoo.features import features
from symgen.laboratory.zoo.witness.numbers.fields import Floats
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded
from symgen.model.load import load_text

DRAWS = range(3)


def numbers(description: Description) -> tuple[SystemReader, list[float], np.ndarray, np.ndarray]:
    """Residuals, B and G at the start, read back from the text."""
    system = SystemReader(expanded(yaml.load(description.text, Loader=yaml.BaseLoader), description.files))
    derived = equations(system)
    values = {**description.start, **{name: 0.1 * k for k, name in enumerate(system.rate_names, 1)}}
    for name, node in system.parameters.items():
        values[name] = system.tape.evaluate([node], values, Floats())[0]

    def evaluated(nodes: tuple) -> list[float]:
        return system.tape.evaluate(nodes, values, Floats())

    rows = np.array([evaluated(row) for row in derived.rows]).reshape(-1, len(system.coordinates))
    mass = np.array([evaluated(row) for row in derived.mass])
    return system, evaluated(derived.residual), rows, mass


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("index", DRAWS)
def test_a_draw_is_assembled_at_its_start(family: str, index: int) -> None:
    description = draw(11, index, family)
    system, residual, rows, mass = numbers(description)
    assert set(system.coordinates) == set(description.start)
    scale = np.abs(rows).max(initial=1.0)
    assert np.abs(residual).max(initial=0.0) < 1e-13 * scale
    assert np.allclose(mass, mass.T, rtol=1e-12, atol=1e-13)
    assert np.linalg.eigvalsh(mass).min() > -1e-12 * np.abs(mass).max()


@pytest.mark.parametrize(
    ("family", "freedom"),
    [("bennett", 1), ("bricard", 1), ("sarrus", 1), ("parallelogram_energies", 1), ("common_pin", 1)],
)
def test_an_over_constrained_linkage_moves(family: str, freedom: int) -> None:
    for index in DRAWS:
        description = draw(12, index, family)
        system, _, rows, _ = numbers(description)
        values = np.linalg.svd(rows, compute_uv=False)
        rank = int((values > 1e-9 * values[0]).sum())
        assert len(system.coordinates) - rank == freedom


def test_a_seed_draws_the_same_under_any_hash_seed() -> None:
    code = "from symgen.laboratory.zoo.draws.families import draw\nfor k in range(8): print(draw(3, k).text)"
    texts = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    ]
    assert texts[0] == texts[1]
    assert texts[0].count("model: ") == 8


def test_seeds_and_numbers_draw_different_systems() -> None:
    texts = {draw(seed, index).text for seed in range(3) for index in range(6)}
    assert len(texts) == 18


def test_as_many_velocities_are_independent_as_there_are_degrees_of_freedom() -> None:
    """Also where rows all but depend on each other: a rod of 1e4 lengths of the other one."""
    for index in range(6):
        sketch = Sketch(Dice(f"independent {index}"), "disc")
        sketch.start = {"x": 0.3, "y": 0.4, "z": 0.2, "w": 0.1}
        sketch.blocks |= {
            "coordinates": {name: {} for name in sketch.start},
            "kinetic_energy": "x_dot**2 + y_dot**2 + z_dot**2 + w_dot**2",
            "constraints": {"geometric": {"one": "x + y - 0.7", "two": "x + y + 2e-4*(z - w - 0.1) - 0.7"}},
        }
        assert len(independent(sketch)) == 2


@pytest.mark.campaign
def test_parallelograms_are_driven_at_their_own_cranks() -> None:
    """Whatever the coordinates are called."""
    for index in range(40):
        description = draw(23, index, "parallelogram_bodies")
        driven = {entry["joint"] for entry in description.blocks["inputs"].values() if "joint" in entry}
        assert driven <= {*description.start, "nowhere"}


def test_outputs_that_are_named_hold_what_the_witness_compares() -> None:
    """In any order, beside others; a mistake on purpose apart."""
    firsts = set()
    for index in range(60):
        description = draw(31, index, "geared")
        outputs = description.blocks.get("outputs")
        if isinstance(outputs, list) and MISTAKE not in description.marks:
            names = [output for output in outputs if isinstance(output, str)]
            assert set(MAIN) <= set(names)
            assert len(set(names)) == len(names)
            firsts.add(outputs[0])
    assert firsts == set(MAIN)


@pytest.mark.campaign
def test_some_systems_want_outputs_in_one_call() -> None:
    """Of those that they name; the commands' own table says how many of them there are."""
    drawn = [draw(1600, index, "") for index in range(60)]
    groups = [
        (output["together"], description.blocks["outputs"])
        for description in drawn
        for output in description.blocks.get("outputs") or ()
        if isinstance(output, dict)
    ]
    assert len(groups) > 2
    for group, outputs in groups:
        assert 2 <= len(group) <= 4
        assert set(group) <= {name for name in outputs if isinstance(name, str)}
    assert sum("outputs in one call" in features(description) for description in drawn) == len(groups)


def test_a_link_with_a_reserved_name_is_a_mistake() -> None:
    """A robot description may call a link what model files must not: that is to be told."""
    drawn = draw(4002, 42, "")
    assert '<link name="delete">' in drawn.files["robot.urdf"]
    assert MISTAKE in drawn.marks


@pytest.mark.campaign
def test_a_mistake_on_purpose_is_in_the_file() -> None:
    """Whatever a family writes over the ends of files: a start at a singular pose keeps the name that is none, too."""
    mistaken = [drawn for index in range(50, 60) if MISTAKE in (drawn := draw(1360, index, "")).marks]
    mistaken += [drawn for index in range(120) if MISTAKE in (drawn := draw(5, index, "parallelogram_energies")).marks]
    assert any("start at a singular pose" in drawn.marks for drawn in mistaken)
    for drawn in mistaken:
        with pytest.raises(ModelError):
            load_text(drawn.text, "zoo.yaml")


def test_rows_in_other_units_are_not_added_up() -> None:
    """A row that says once more what two others say has a unit, as the file's own checks ask for."""
    units = {"gear": "rad", "other_gear": "rad", "close": "m", "rod": "m**2"}
    added = []
    for number in range(200):
        sketch = Sketch(Dice("surplus", number), "planar_energies")
        sketch.block("constraints")["geometric"] = {name: f"row_{name}" for name in units}
        _surplus(sketch, units)
        rows = sketch.blocks["constraints"]["geometric"].values()
        added += [{name for name in units if f"row_{name}" in row} for row in rows if " + " in row]
    assert added
    assert all(len({units[name] for name in names}) == 1 for names in added)
