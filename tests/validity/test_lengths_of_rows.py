"""A row is lost where it is next to nothing beside what it usually is: a zero there is none of a regular state."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.validity.search import ZeroSearch

# The row is about 1 in half of the range of x and 1e-9 in the other half: in one, two or three parts each.
TEXT = """
model: rail
coordinates: {{x: {{range: [-1, 1]}}, y: {{}}}}
kinetic_energy: x_dot**2/2 + y_dot**2/2
constraints: {{nonholonomic: {{row: y_dot*(1/(1 + exp(-60*({wave}))) + 1/1000000000)}}}}
inputs: {{u: {{acts_on: {{x: 1}}}}}}
"""


@pytest.mark.parametrize("parts", [1, 2, 3])
@pytest.mark.parametrize("function", ["sin", "cos"])
@pytest.mark.parametrize("sign", [1, -1])
def test_what_a_row_usually_is_is_known_where_it_vanishes_in_half_of_the_range(
    parts: int, function: str, sign: int
) -> None:
    mechanics = System(load_text(TEXT.format(wave=f"{sign}*{function}({parts}*pi*x)"), "rail.yaml"))
    search = ZeroSearch(mechanics, genericity(mechanics))

    def wave(thousandths: int) -> float:
        return sign * float(getattr(math, function)(parts * math.pi * thousandths / 1000))

    inside = range(-950, 951)
    for place, regular in ((max(inside, key=wave), True), (min(inside, key=wave), False)):
        assert abs(wave(place)) > 0.98  # off the middle of the half by a fortieth of the range at most
        zero = search.zero_of(mechanics.names["x"] - Fraction(place, 1000))
        assert (zero is not None) is regular
