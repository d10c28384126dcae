"""Inertias that add up: sums of what no parameter within its range makes negative, of which nothing is ever a rest."""

from __future__ import annotations

import pytest

from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.model.load import load_text

ARM = """model: arm
parameters:
  m: {value: 1, unit: kg, range: [0.5, 2]}
  load: {value: 0, unit: kg, range: [0, 2]}
  J: {value: 0.1, unit: kg*m**2, range: [0.01, 1]}
  l: {value: 1, unit: m}
  lever: {value: 1, unit: m, range: [-1, 1]}
coordinates: {a: {unit: rad}}
kinetic_energy: {ENERGY}
inputs: {drive: {acts_on: {a: 1}}}
outputs: [forward_dynamics]
"""


@pytest.mark.parametrize(
    ("inertia", "adds_up"),
    [
        ("J + m*l**2/4 + load*l**2", True),
        ("J + m*lever**2", True),
        ("J + m*l*lever", False),
        ("m*l**2 - J", False),
        ("J + m*l**2*(1 + cos(a))", False),
    ],
)
def test_what_adds_up_has_no_term_below_0(inertia: str, adds_up: bool) -> None:
    system = System(load_text(ARM.replace("{ENERGY}", f"({inertia})*a_dot**2/2"), "arm.yaml"))
    assert Definite(system).adds_up(system.mass_matrix[0][0]) is adds_up
