"""The search for vanishing pivots of G: it ends at the same place whatever a machine's last bits are."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from fractions import Fraction

import pytest
import shipped

from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.symbolic import evaluate
from symgen.validity.definiteness import indefinite, indefinite_model

# Steps by quarter turns gain nothing but rounding; G is singular where both angles are multiples of them.
COUPLED = """
model: coupled
coordinates: {x: {}, y: {}}
kinetic_energy: (x_dot**2 + 2*x_dot*y_dot*(cos(4*x) + cos(4*y))/2 + y_dot**2)/2
constraints: {nonholonomic: {row: x_dot - y_dot}}
"""


def noisy(function: Callable[[float], float], source: random.Random) -> Callable[[float], float]:
    """The function with its last bit at random, as libraries differ."""

    def call(x: float) -> float:
        return math.nextafter(function(x), source.choice((-math.inf, function(x), math.inf)))

    return call


def place(model: Model) -> tuple[tuple[str, float], ...] | None:
    indefinite_model.cache_clear()
    counterexample = indefinite(System(model))
    return None if counterexample is None else counterexample.state


@pytest.mark.parametrize("scale", [1, "9/10"])
def test_the_last_bits_of_sines_decide_nothing(scale: object, monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_text(COUPLED.replace(")/2 +", f")/2*{scale} +"), "coupled.yaml")
    expected = place(model)
    assert (expected is None) == (scale != 1)
    for seed in range(5):
        for name in ("sin", "cos"):
            monkeypatch.setitem(evaluate.FUNCTIONS, name, noisy(getattr(math, name), random.Random(seed)))
        assert place(model) == expected


def test_nor_do_they_for_shipped_models(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("sin", "cos"):
        monkeypatch.setitem(evaluate.FUNCTIONS, name, noisy(getattr(math, name), random.Random(7)))
    assert [name for name in shipped.NAMES if place(shipped.model(name)) is not None] == []


CORNERS = [(-0.6, -0.6), (-0.6, 0.6), (0.6, -0.6), (0.6, 0.6)]


def coupling(x: float, y: float, corner: tuple[float, float], most: float) -> float:
    """Of two slides: `most` in one corner of their ranges, less in the one across, next to nothing elsewhere."""
    near, across = ((x - s * corner[0]) ** 2 + (y - s * corner[1]) ** 2 for s in (1, -1))
    return most * math.exp(-near / 0.04) + 0.8 * math.exp(-across / 0.04)


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("most", [0.95, 1.05])
def test_a_corner_where_masses_are_indefinite_is_reached(corner: tuple[float, float], most: float) -> None:
    """A six hundredth of the ranges, which ways from most configurations pass by: they end in the corner across."""
    near, across = (f"(x - ({s * corner[0]}))**2 + (y - ({s * corner[1]}))**2" for s in (1, -1))
    text = f"""
model: slides
coordinates: {{x: {{range: [-1, 1]}}, y: {{range: [-1, 1]}}}}
kinetic_energy: (x_dot**2 + y_dot**2)/2 + x_dot*y_dot*({most}*exp(-({near})/0.04) + 0.8*exp(-({across})/0.04))
inputs: {{u: {{acts_on: {{x: 1}}}}}}
"""
    reached = place(load_text(text, "slides.yaml"))
    assert (reached is not None) is (most > 1)
    if reached is not None:
        state = dict(reached)
        assert coupling(state["x"], state["y"], corner, most) > 0.999


@pytest.mark.parametrize("tenths", range(-9, 10, 2))
@pytest.mark.parametrize("rest", [Fraction(1, 10**5), Fraction(1, 10)])
def test_an_inertia_is_measured_by_what_it_is_in_a_tenth_of_the_range(tenths: int, rest: Fraction) -> None:
    """Elsewhere it is the rest alone: next to nothing beside that, or enough."""
    text = f"""
model: slide
coordinates: {{x: {{range: [-1, 1]}}, y: {{range: [-1, 1]}}}}
kinetic_energy: x_dot**2*({rest} + exp(-(10*x - ({tenths}))**2))/2 + y_dot**2/2
constraints: {{nonholonomic: {{row: y_dot}}}}
inputs: {{u: {{acts_on: {{x: 1}}}}}}
"""
    reached = place(load_text(text, "slide.yaml"))
    assert (reached is not None) is (rest < Fraction(1, 10**4))
    if reached is not None:
        assert math.exp(-((10 * dict(reached)["x"] - tenths) ** 2)) < 1e-4


@pytest.mark.parametrize("thousandths", [-873, -411, -37, 298, 556, 939])
def test_a_single_place_where_masses_are_singular_is_met_to_a_thousandth_of_the_range(thousandths: int) -> None:
    """The smallest pivot is half of the square of the way there: a sixtieth of the range away it counts as some."""
    text = f"""
model: slides
coordinates: {{x: {{range: [-1, 1]}}, y: {{range: [-1, 1]}}}}
kinetic_energy: (x_dot**2 + y_dot**2)/2 + x_dot*y_dot*(1 - (x - ({thousandths})/1000)**2/4)
inputs: {{u: {{acts_on: {{x: 1}}}}}}
"""
    reached = place(load_text(text, "slides.yaml"))
    assert reached is not None
    assert abs(dict(reached)["x"] - thousandths / 1000) < 2e-3
