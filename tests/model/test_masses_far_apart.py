"""Whether masses determine the accelerations: masses 1e18 apart do, energies that cancel do not."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import cast

import mpmath
import pytest

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.model.configurations.many_digits import PRECISE_BITS, ManyDigits
from symgen.model.configurations.numbers import FLOATS, precise
from symgen.model.expressions.parser import parse_expression
from symgen.model.expressions.walk import FUNCTIONS
from symgen.model.file.source import ScalarNode
from symgen.model.load import load_text
from symgen.model.model import Model

# sliders on one another along one axis, the last of them carries an arm
SLIDERS = """model: sliders
parameters: {{heavy: 1e9, light: 1e-9, g: 9.81, l: 0.5}}
gravity: [0, -g, 0]
joints:
  p: {{type: prismatic, axis: x, coordinate: s_1}}
  q: {{type: prismatic, parent: p, axis: x, coordinate: s_2}}
  r: {{type: prismatic, parent: q, axis: x, coordinate: s_3}}
  h: {{type: revolute, parent: r, axis: z, coordinate: a}}
bodies:
  p: {{mass: {0}}}
  q: {{mass: {1}}}
  r: {{mass: {2}}}
  h: {{mass: {3}, com: [l, 0, 0]}}
inputs: {{push: {{joint: s_1}}}}
"""

# the same by energies, multiplied out, so that squares of sines and cosines have to cancel
ENERGIES = """model: sliders
coordinates: {{s_1: , s_2: , a: {{unit: rad}}}}
parameters: {{heavy: 1e9, light: 1e-9, l: 0.5}}
definitions: {{v: s_1_dot + s_2_dot}}
kinetic_energy: {0}/2*s_1_dot**2 + heavy/2*(v**2 - 2*l*sin(a)*v*a_dot + l**2*(sin(a)**2 + cos(a)**2)*a_dot**2){1}
inputs: {{push: {{acts_on: {{s_1: 1}}}}}}
"""

# a four-bar of light links with a heavy block that slides on its coupler
FOUR_BAR = """model: block
parameters: {{l_1: 0.3, l_2: 0.9, l_3: 0.7}}
gravity: [0, -9.81, 0]
joints:
  crank: {{type: revolute, axis: z, coordinate: a}}
  coupler: {{type: revolute, parent: crank, at: [l_1, 0, 0], axis: z, coordinate: b}}
  rocker: {{type: revolute, at: [1, 0, 0], axis: z, coordinate: c}}
  block: {{type: prismatic, parent: coupler, at: [0.2, 0, 0], axis: y, coordinate: s}}
  cap: {{type: prismatic, parent: block, axis: y, coordinate: p}}
bodies:
  crank: {{mass: {0}, com: [l_1/2, 0, 0]}}
  rocker: {{mass: {0}, com: [l_3/2, 0, 0]}}
  block: {{mass: {1}}}
  cap: {{mass: 1e6}}
points:
  tip: {{frame: coupler, at: [l_2, 0, 0]}}
  top: {{frame: rocker, at: [l_3, 0, 0]}}
loops: {{close: {{type: point, between: [tip, top]}}}}
inputs: {{drive: {{joint: a}}}}
configuration: {{a: 0.8, b: -0.3, c: 1.7, s: 0.1}}
"""


# a pin turns about its own axis, on which the rod that holds it begins; in floats the rod's row is not 0 for that turn
PIN = """model: pin
parameters: {m: 2.6, l: 0.39, reach: 0.78}
gravity: [0, -9.81, 0]
joints:
  post: {type: revolute, axis: y, coordinate: a}
  slide: {type: prismatic, parent: post, at: [1.1, 0, 0], axis: y, coordinate: s}
  pin: {type: revolute, parent: slide, at: [l, 0, 0], axis: x, coordinate: b}
bodies:
  post: {mass: 7, com: [0.5, 0, 0], inertia: {xx: 0.02, yy: 0.02, zz: 0.02}}
  slide: {mass: m, com: [l/2, 0, 0], inertia: {xx: 0.05, yy: 0.01, zz: 0.05}}
points:
  end: {frame: pin, at: [reach, 0, 0]}
  hook: {at: [0.3, 1.4, 0.7]}
loops: {rod: {type: distance, between: [end, hook], length: 2.3}}
inputs: {drive: {joint: a}}
"""


def _load(text: str, *values: str) -> Model:
    return load_text(text.format(*values), "sliders.yaml")


@pytest.mark.parametrize("order", ["light heavy light heavy", "heavy light heavy light", "light light heavy heavy"])
def test_masses_1e18_apart_in_any_order_are_masses(order: str) -> None:
    assert _load(SLIDERS, *order.split()).assembly is not None


def test_a_slider_without_mass_among_them_is_told_by_name() -> None:
    with pytest.raises(ModelError, match="no mass moves where `s_2`, `s_3` move together"):
        _load(SLIDERS, "light", "0", "heavy", "heavy")


def test_an_energy_that_is_multiplied_out_is_judged_exactly() -> None:
    """G is singular where sin(a)^2 is 1: there are configurations at which it is not."""
    assert _load(ENERGIES, "light", "").assembly is not None


def test_an_energy_that_cancels_is_none_beside_large_ones() -> None:
    with pytest.raises(ModelError, match="no mass moves where `s_1`, `s_2` move together"):
        _load(ENERGIES, "0", "")
    with pytest.raises(ModelError, match="no mass moves where `s_1`, `s_2` move together"):
        _load(ENERGIES, "light", " + light/2*(v**2 - s_1_dot**2 - 2*s_1_dot*s_2_dot - s_2_dot**2) - light/2*s_1_dot**2")


def test_a_light_block_between_a_linkage_and_a_heavy_one_is_a_mass() -> None:
    assert _load(FOUR_BAR, "1e-3", "1e-9").assembly is not None


def test_a_linkage_whose_motion_moves_nothing_is_told_where_a_loop_closes_up_to_rounding() -> None:
    with pytest.raises(ModelError, match=r"no mass moves where `s`, `p` move together"):
        _load(FOUR_BAR, "1e-3", "0")


def test_a_pin_that_turns_about_its_own_axis_has_no_mass_for_rounding() -> None:
    with pytest.raises(ModelError, match=r"no mass moves where `b` does"):
        load_text(PIN, "pin.yaml")


@pytest.mark.parametrize(
    "text",
    ["sin(2/3) + cos(1/7)**2", "atan2(-1, 3) + asin(1/3) - acos(0.2)", "exp(-2)*log(5) + tanh(0.3)", "(7/3)**(1/2)*pi",
     "tan(0.7) + atan(9) + sinh(1)/cosh(2) - sqrt(2)"],
)  # fmt: skip
def test_many_digits_begin_with_those_of_floats(text: str) -> None:
    expression = parse_expression(ScalarNode(text, Span(1, 1, 2), text, quoted=False))
    assert not isinstance(expression, Mistake)
    few, many = FLOATS.evaluate(expression, {}), precise().evaluate(expression, {})
    assert float(many) == pytest.approx(few, rel=1e-14)
    assert precise().rational(Fraction(1, 3)) != 1 / 3


def test_many_digits_are_those_of_another_library() -> None:
    """mpmath's, with which numbers of other places have been evaluated: 118 of 120 digits."""
    context = mpmath.MPContext()
    context.prec = PRECISE_BITS
    numbers, generator = precise(), random.Random(7)
    for name in FUNCTIONS:
        arguments = [generator.uniform(0.1, 0.9) for _ in range(2 if name == "atan2" else 1)]
        ours = numbers.functions[name](*arguments)
        theirs = getattr(context, name)(*map(context.mpf, arguments))
        assert abs(_as_fraction(ours) - _exact(theirs)) < Fraction(1, 10**118)
    for exponent in (Fraction(3), Fraction(-2), Fraction(2, 7)):
        ours = numbers.power(0.3, exponent)
        theirs = context.mpf(0.3) ** (context.mpf(exponent.numerator) / exponent.denominator)
        assert abs(_as_fraction(ours) / _exact(theirs) - 1) < Fraction(1, 10**118)


def _exact(value: mpmath.mpf) -> Fraction:
    return Fraction(int(value.man)) * Fraction(2) ** int(value.exp) * (1 if value >= 0 else -1)


def _as_fraction(value: float) -> Fraction:
    mantissa, exponent = cast(ManyDigits, value).parts
    return Fraction(mantissa) * Fraction(2) ** exponent


def test_many_digits_calculate_as_numbers_do() -> None:
    third, numbers = precise().rational(Fraction(1, 3)), precise()
    assert abs(3 * third - 1) < 1e-119
    assert 2 - third > 1.6 > third
    assert third - 2 < -1.6 <= third
    assert float(1 / third) == pytest.approx(3)
    assert abs(-third) == third
    assert float(third**0.5 * third**0.5) == pytest.approx(1 / 3)
    assert not third - third
    assert float(sum([third, third, third])) == pytest.approx(1)
    # no format's exponents
    assert numbers.rational(10) ** 4000 > 1e308
    with pytest.raises(ZeroDivisionError):
        third / (third - third)
    for exponent in (Fraction(-1), Fraction(-1, 2)):
        with pytest.raises(ZeroDivisionError):
            numbers.power(0.0, exponent)
    assert numbers.power(0.0, Fraction(1, 2)) == 0
    with pytest.raises(ValueError, match="negative"):
        numbers.power(-1.0, Fraction(1, 2))


def test_many_digits_have_no_value_outside_a_domain() -> None:
    numbers = precise()
    for name, argument in (("sqrt", -1.0), ("asin", 2.0), ("log", 0.0)):
        with pytest.raises((ValueError, ArithmeticError)):
            numbers.functions[name](argument)
