"""Numbers before terms of energies are masses and stiffnesses, even where they are 1 or 1/2."""

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
