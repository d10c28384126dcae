"""Truncated Taylor polynomials: derivatives of every function against difference quotients in 512 bits."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb

from symgen.verify.reference.arithmetic.tape import Tape, ball, precision, replay_of
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor

FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "sinh", "cosh", "tanh")
POINT = 0.4


def value_and_derivatives(build: str, point: float, orders: int = 3) -> list[arb]:
    """Taylor coefficients about `point` of sin(x) by name, of the power -3/2 and of others, times k!."""
    tape = Tape()
    algebra = Taylor(tape, orders, 0)
    x: Polynomial = {CONSTANT: tape.input(0), ((0,), ()): tape.one}
    if build == "power":
        result = algebra.power(x, Fraction(-3, 2))
    elif build == "quotient":
        result = algebra.divide(x, algebra.add(algebra.multiply(x, x), {CONSTANT: tape.one}))
    elif build == "angle":
        result = algebra.angle(algebra.multiply(x, x), algebra.subtract(x, {CONSTANT: tape.one}))
    else:
        result = algebra.function(build, x)
    registers = [result.get(((0,) * k, ()), tape.zero) for k in range(orders + 1)]
    factorials = [1, 1, 2, 6]
    return [c * f for c, f in zip(replay_of(tape, registers).run([ball(point)]), factorials, strict=True)]


def plain(build: str, x: arb) -> arb:
    if build == "power":
        return 1 / (x * x.sqrt())
    if build == "quotient":
        return x / (x * x + 1)
    if build == "angle":
        return arb.atan2(x * x, x - 1)
    return getattr(x, build)()


@pytest.mark.parametrize("build", [*FUNCTIONS, "power", "quotient", "angle"])
def test_three_derivatives(build: str) -> None:
    with precision(512):
        h = arb(2) ** -60
        y = {k: plain(build, arb(POINT) + k * h) for k in (-2, -1, 0, 1, 2)}
        expected = [
            y[0],
            (y[1] - y[-1]) / (2 * h),
            (y[1] - 2 * y[0] + y[-1]) / h**2,
            (y[2] - 2 * y[1] + 2 * y[-1] - y[-2]) / (2 * h**3),
        ]
        for value, wanted in zip(value_and_derivatives(build, POINT), expected, strict=True):
            assert abs(float(value - wanted)) < 1e-30


def test_coefficients_of_products_count_each_monomial_once() -> None:
    """(x y + x**2)**2 about (2, 3): its mixed derivatives."""
    tape = Tape()
    algebra = Taylor(tape, 2, 0)
    x: Polynomial = {CONSTANT: tape.input(0), ((0,), ()): tape.one}
    y: Polynomial = {CONSTANT: tape.input(1), ((1,), ()): tape.one}
    square = algebra.power(algebra.add(algebra.multiply(x, y), algebra.power(x, Fraction(2))), Fraction(2))
    keys = [CONSTANT, ((0,), ()), ((1,), ()), ((0, 1), ()), ((0, 0), ()), ((1, 1), ())]
    values = [int(float(v)) for v in replay_of(tape, [square[k] for k in keys]).run([arb(2), arb(3)])]
    # f = x^2 (x + y)^2: f_x = 2x(x+y)(2x+y), f_y = 2x^2(x+y), f_xy = 4x(x+y)+2x^2, f_xx = 12x^2+12xy+2y^2, f_yy = 2x^2
    assert values == [100, 140, 40, 48, (48 + 72 + 18) // 2, 4]
