"""A group of outputs has a function where all of them are made, and a notice where one is not."""

from __future__ import annotations

from pathlib import Path

from symgen.generation.results import Options
from symgen.pipeline import generate

MODEL = """\
model: sled
coordinates: {x: {unit: m}, y: {unit: m}}
kinetic_energy: x_dot**2 + y_dot**2
potential_energy: 9.81*y
inputs: {push: {acts_on: {x: 1}}}
outputs: [{together: [energy, mass_matrix]}, {together: [mass_matrix, multipliers, energy]}]
"""


def test_a_group_that_is_not_complete_has_no_function(tmp_path: Path) -> None:
    path = tmp_path / "sled.yaml"
    path.write_text(MODEL, encoding="utf-8")
    result = generate(path, Options(parts=("c",), verify=False), lambda _: None)
    header = str(result.files["c/sled_together.h"])
    assert "sled_energy_mass_matrix_together(" in header
    assert "multipliers" not in header
    said = [notice.message for notice in result.notices if "no function has" in notice.message]
    group = "mass_matrix and multipliers and energy"
    types = ("float64", "float32")
    assert said == [f"no function has {group} in {scalar}: multipliers is not generated" for scalar in types]
