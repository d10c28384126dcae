"""Zeros by Levenberg and Marquardt's method: simple and double ones, rows that depend on each other, and none."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from flint import arb, ctx

from symgen.validity.descent import Evaluated, zero_beside

Functions = Callable[[list[Any]], Evaluated]


def circle(x: list[Any]) -> Evaluated:
    """On the unit circle, where both coordinates are the same."""
    a, b = x
    return [a * a + b * b - 1, a - b], [[2 * a, 2 * b], [1, -1]]


def one_row_twice(x: list[Any]) -> Evaluated:
    """The same row in other units, off the circle a little apart from itself: dependent at the zero alone."""
    a, b = x
    row = a * a + b * b - 1
    return [row, 1000 * row + row * row], [[2 * a, 2 * b], [(1000 + 2 * row) * 2 * a, (1000 + 2 * row) * 2 * b]]


def double(x: list[Any]) -> Evaluated:
    """Of which the slope vanishes at the zero."""
    a, b = x
    return [a * a, a - b], [[2 * a, 0], [1, -1]]


def twelvefold(x: list[Any]) -> Evaluated:
    """Of which twelve zeros lie in one place: each step leaves a third of the values."""
    (a,) = x
    return [a**12], [[12 * a**11]]


def nowhere(x: list[Any]) -> Evaluated:
    """Which does not vanish."""
    a, b = x
    return [a * a + b * b + 1], [[2 * a, 2 * b]]


@pytest.mark.parametrize("functions", [circle, one_row_twice, double], ids=lambda one: one.__name__)
@pytest.mark.parametrize("bits", [136, 384])
def test_zeros_are_known_to_what_is_asked_for(functions: Functions, bits: int) -> None:
    with ctx.workprec(bits):
        vanished = 2.0 ** (-bits // 2)
        zero = zero_beside(functions, [arb("0.4"), arb("0.9")], vanished, 150, 1e-3)
        assert zero is not None
        assert max(abs(float(value)) for value in functions(zero)[0]) <= vanished


def test_there_may_be_none() -> None:
    calls: list[list[Any]] = []

    def evaluate(x: list[Any]) -> Evaluated:
        calls.append(x)
        return nowhere(x)

    with ctx.workprec(136):
        assert zero_beside(evaluate, [arb("0.4"), arb("0.9")], 1e-20, 1000, 1e-3) is None
    assert len(calls) < 40  # a way that comes no closer is given up


def test_steps_stay_inside() -> None:
    def inside(x: list[Any]) -> list[Any]:
        return [min(max(value, arb("0.75")), arb(1)) for value in x]

    with ctx.workprec(136):
        start = [arb("0.8"), arb("0.9")]
        assert zero_beside(circle, start, 1e-20, 60, 1e-3, [arb(1), arb(1)], inside) is None
        zero = zero_beside(circle, start, 1e-20, 60, 1e-3, [arb("0.1"), arb(10)])
        assert zero is not None
        assert abs(float(zero[0]) - 0.5**0.5) < 1e-12


def test_a_zero_that_each_step_brings_little_closer_is_reached() -> None:
    """Twelve zeros in one place; and a point on a circle that is to go three radians along it: no step leads there."""

    def along_a_circle(x: list[Any]) -> Evaluated:
        a, b, angle = x
        slopes = [[1, 0, angle.sin()], [0, 1, -angle.cos()], [0, 0, arb("0.1")]]
        return [a - angle.cos(), b - angle.sin(), (angle - 3) / 10], slopes

    with ctx.workprec(136):
        assert zero_beside(twelvefold, [arb("0.4")], 1e-20, 60, 1e-3) is not None
        zero = zero_beside(along_a_circle, [arb(1), arb(0), arb(0)], 1e-20, 60, 1e-3)
        assert zero is not None
        assert [float(value) for value in zero] == pytest.approx([math.cos(3), math.sin(3), 3])


def test_a_way_on_which_each_step_takes_a_few_percent_away_is_given_up() -> None:
    """1 / x^0.015 comes to nothing nowhere, and closer to it with each step: by six percent."""
    calls: list[list[Any]] = []

    def evaluate(x: list[Any]) -> Evaluated:
        calls.append(x)
        power = arb("-0.015")
        value = x[0] ** power
        return [value], [[power * value / x[0]]]

    with ctx.workprec(136):
        assert zero_beside(evaluate, [arb("0.4")], 1e-20, 1000, 1e-3) is None
    assert len(calls) <= 12
