"""Numbers before terms are masses, stiffnesses, lengths and torques, even where they are 1 or 1/2."""

from __future__ import annotations

import pytest

from symgen.diagnostics import ModelError
from symgen.model.load import load_text

SWING = """\
model: swing
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}}}
parameters: {{k: {{value: 3, unit: N*m}}, J: {{value: 2, unit: kg*m**2}}}}
kinetic_energy: {kinetic}
potential_energy: {potential}
"""


@pytest.mark.parametrize(
    ("kinetic", "potential"),
    [
        ("2/2*a_dot**2 + 1/2*b_dot**2", "1*cos(a) + 2*cos(b)"),
        ("(a_dot**2 + b_dot**2)/2", "k*a**2/2"),
        ("J/2*a_dot**2 + 1/2*b_dot**2", "k*a**2/2 - 4*cos(b)"),
    ],
)
def test_numbers_have_the_unit_their_place_demands(kinetic: str, potential: str) -> None:
    assert load_text(SWING.format(kinetic=kinetic, potential=potential), "swing.yaml").n == 2


@pytest.mark.parametrize(
    ("kinetic", "potential"),
    [
        ("J/2*(a_dot**2 + b_dot**2)", "J*cos(a)"),  # what is made of parameters has their unit
        ("J/2*(a_dot**2 + b_dot**2)", "cos(a)"),  # where there is no number nothing stands for one
        ("J/2*(a_dot**2 + b_dot**2)", "1/2*(a - a_0*J)"),
    ],
)
def test_contradictions_are_told_as_before(kinetic: str, potential: str) -> None:
    with pytest.raises(ModelError):
        load_text(SWING.format(kinetic=kinetic, potential=potential.replace("a_0", "1")), "swing.yaml")


CRANK = """\
model: crank
coordinates: {{a: {{unit: rad}}, x: {{unit: m}}, b: {{}}}}
parameters: {{m: {{value: 3, unit: kg}}, l: {{value: 1, unit: m}}, off: {{value: 0.3}}}}
definitions:
  wrist: 2*cos(a)
  elbow: wrist + l*cos(b)
kinetic_energy: {kinetic}
constraints: {{geometric: {{slides: {row}}}}}
inputs: {{drive: {{unit: N*m, acts_on: {{a: 1}}}}}}
applied_forces: {{a: "{force}"}}
configuration: {{a: 1.2, b: 0.7, x: 0.5}}
"""
MASSES = "3/2*(l**2*a_dot**2 + x_dot**2) + m/2*l**2*b_dot**2 + 1e3/2*l**2*a_dot**2"


@pytest.mark.parametrize(
    ("kinetic", "row", "force"),
    [
        (MASSES, "x - wrist - off", "-2*tanh(a_dot/0.05)"),  # a torque, a radius, masses of 3 and 1000
        (MASSES, "(x - elbow) + 2*(a - 0.5*b - off)", "-4*a_dot"),  # rows that are added up
        ("m/2*(x_dot**2 + l**2*(a_dot**2 + b_dot**2))", "x - 1*cos(a) - 2*sin(b)", "-1*a_dot"),
    ],
)
def test_numbers_before_pure_numbers_and_coordinates_have_any_unit(kinetic: str, row: str, force: str) -> None:
    assert load_text(CRANK.format(kinetic=kinetic, row=row, force=force), "crank.yaml").n == 3


@pytest.mark.parametrize(
    ("row", "force"),
    [
        ("x - cos(a)", "-2*tanh(a_dot/0.05)"),  # no number that could be a radius
        ("x - elbow - b", "-m*a_dot"),  # a damping in kg
        ("x - 2*m*cos(a) - l*b", "0"),
    ],
)
def test_what_names_units_still_has_them(row: str, force: str) -> None:
    text = CRANK.format(kinetic="m/2*(x_dot**2 + l**2*(a_dot**2 + b_dot**2))", row=row, force=force)
    with pytest.raises(ModelError, match=" is in "):
        load_text(text, "crank.yaml")
