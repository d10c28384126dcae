"""The portable sine and cosine against 80-bit arithmetic and the quadrant it selects."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from symgen.ir.interpret import Interpreter, round_literal
from symgen.ir.kernel import Literal, Local, Operand, Scalar
from symgen.ir.sincos import WIDE_ANGLE_LIMIT, angle_limit, half_pi_parts, sincos
from symgen.symbolic.scalar import PI

HALF_PI = math.pi / 2


def portable(x: Any, scalar: Scalar, wide: bool = False) -> tuple[Any, Any]:
    """The straight-line pair on a NumPy array: the same IEEE operations as C."""
    kind = np.float64 if scalar == "float64" else np.float32
    function = sincos(scalar, wide)
    values: dict[str, Any] = {"x": np.asarray(x, kind)}

    def value(operand: Operand) -> Any:
        if isinstance(operand, Literal):
            return kind(round_literal(operand.value, scalar))
        assert isinstance(operand, Local)
        return values[operand.name]

    operations = {"add": np.add, "sub": np.subtract, "mul": np.multiply, "abs": np.abs}
    for statement in function.statements:
        values[statement.targets[0]] = operations[statement.operation](*map(value, statement.operands))
    sine, cosine = (values[name] for name in function.results)
    assert sine.dtype == kind
    return sine, cosine


def worst_ulp(x: Any, results: Any, name: str) -> float:
    """The largest error in units of the last place of the exact value (double precision)."""
    previous, ctx.prec = ctx.prec, 160
    try:
        worst = 0.0
        for angle, result in zip(x.tolist(), results.tolist(), strict=True):
            exact = getattr(arb(angle), name)()
            ulp = math.ulp(abs(float(exact)))
            worst = max(worst, abs(float((arb(result) - exact) / arb(ulp))))
        return worst
    finally:
        ctx.prec = previous


def worst_ulp_single(x: Any, results: Any, name: str) -> float:
    """The largest error of float32 results; double precision is exact enough as the measure."""
    exact = getattr(np, name)(x.astype(np.float64))
    ulp = np.spacing(np.abs(exact).astype(np.float32)).astype(np.float64)
    return float(np.max(np.abs(results.astype(np.float64) - exact) / ulp))


def test_double_precision_at_random_arguments() -> None:
    source = np.random.default_rng(20120731)
    x = np.concatenate(
        [
            source.uniform(-1e5, 1e5, 20_000),
            source.uniform(-7, 7, 20_000),
            source.uniform(-1, 1, 5_000) * 10.0 ** source.uniform(-12, 0, 5_000),
        ]
    )
    sine, cosine = portable(x, "float64")
    assert worst_ulp(x, sine, "sin") <= 1.6
    assert worst_ulp(x, cosine, "cos") <= 1.6


def test_double_precision_near_multiples_of_a_right_angle() -> None:
    source = np.random.default_rng(1)
    multiples = np.concatenate([np.arange(-200, 201), source.integers(-63661, 63662, 4000)])
    near = [np.nextafter(multiples * HALF_PI, side) for side in (-np.inf, np.inf)]
    x = np.concatenate([multiples * HALF_PI, *near, multiples * HALF_PI + 1e-9])
    sine, cosine = portable(x, "float64")
    assert worst_ulp(x, sine, "sin") <= 1.6
    assert worst_ulp(x, cosine, "cos") <= 1.6


def test_double_precision_where_the_quadrant_changes() -> None:
    multiples = np.concatenate([np.arange(-400, 400), np.arange(63000, 63600)]) + 0.5
    x = np.concatenate([np.nextafter(multiples * HALF_PI, side) for side in (-np.inf, np.inf)])
    sine, cosine = portable(x, "float64")
    assert worst_ulp(x, sine, "sin") <= 1.6
    assert worst_ulp(x, cosine, "cos") <= 1.6


def test_single_precision_over_two_turns() -> None:
    largest = int(np.float32(4 * math.pi).view(np.uint32))
    x = np.arange(1, largest, 1009, dtype=np.uint32).view(np.float32)
    x = np.concatenate([x, -x, (np.arange(-8, 9) * HALF_PI).astype(np.float32)])
    sine, cosine = portable(x, "float32")
    assert worst_ulp_single(x, sine, "sin") <= 1.6
    assert worst_ulp_single(x, cosine, "cos") <= 1.6


def test_single_precision_absolutely_up_to_its_limit() -> None:
    x = np.linspace(-100, 100, 400_001).astype(np.float32)
    sine, cosine = portable(x, "float32")
    assert np.max(np.abs(sine.astype(np.float64) - np.sin(x.astype(np.float64)))) <= 7e-8
    assert np.max(np.abs(cosine.astype(np.float64) - np.cos(x.astype(np.float64)))) <= 7e-8


def test_double_precision_over_the_wide_range() -> None:
    source = np.random.default_rng(5)
    most = int(WIDE_ANGLE_LIMIT["float64"] / Fraction(HALF_PI))
    multiples = np.concatenate([np.arange(-100, 101), source.integers(-most, most + 1, 8000)])
    x = np.concatenate(
        [
            source.uniform(-1e7, 1e7, 10_000),
            source.uniform(-7, 7, 5_000),
            *(np.nextafter(multiples * HALF_PI, side) for side in (-np.inf, np.inf)),
            np.nextafter((multiples + 0.5) * HALF_PI, np.inf),
            np.array([float(f"{sign}{hard}") for sign in "+-" for hard in hardest(most)]),
        ]
    )
    sine, cosine = portable(x, "float64", wide=True)
    assert worst_ulp(x, sine, "sin") <= 1.6
    assert worst_ulp(x, cosine, "cos") <= 1.6


def hardest(most: int) -> list[float]:
    """Floats closest to multiples of a right angle: multiples of 2**e near numerators of its continued fraction."""
    angles = []
    for exponent in range(-52, 1):
        rest, before, now = PI / 2 / Fraction(2) ** exponent, (0, 1), (1, 0)
        while now[1] <= most:
            whole = rest.numerator // rest.denominator
            before, now = now, (whole * now[0] + before[0], whole * now[1] + before[1])
            if 0 < now[0] < 2**53 and 0 < now[1] <= most:
                angles.append(float(now[0] * Fraction(2) ** exponent))
            rest = 1 / (rest - whole)
    return angles


@pytest.mark.parametrize("wide", [False, True])
def test_double_precision_at_the_hardest_arguments(wide: bool) -> None:
    most = int(angle_limit("float64", wide) / Fraction(HALF_PI))
    x = np.array(hardest(most))
    assert np.min(np.minimum(np.abs(np.sin(x)), np.abs(np.cos(x)))) < 1e-18
    sine, cosine = portable(x, "float64", wide)
    assert worst_ulp(x, sine, "sin") <= 1.6
    assert worst_ulp(x, cosine, "cos") <= 1.6


def test_single_precision_over_the_wide_range() -> None:
    largest = int(np.float32(4 * math.pi).view(np.uint32))
    x = np.arange(1, largest, 1013, dtype=np.uint32).view(np.float32)
    x = np.concatenate([x, (np.arange(-8, 9) * HALF_PI).astype(np.float32)])
    sine, cosine = portable(x, "float32", wide=True)
    assert worst_ulp_single(x, sine, "sin") <= 1.6
    assert worst_ulp_single(x, cosine, "cos") <= 1.6
    for limit, bound in ((100, 7e-8), (40_000, 9e-8)):
        x = np.linspace(-limit, limit, 1_000_001).astype(np.float32)
        sine, cosine = portable(x, "float32", wide=True)
        assert np.max(np.abs(sine.astype(np.float64) - np.sin(x.astype(np.float64)))) <= bound
        assert np.max(np.abs(cosine.astype(np.float64) - np.cos(x.astype(np.float64)))) <= bound


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_quadrants_are_exact(scalar: Scalar, wide: bool) -> None:
    function = sincos(scalar, wide)
    interpreter = Interpreter(function, scalar)
    wanted = {"turn": {0: 0.0, 1: 1.0, 2: 0.0, 3: -1.0}, "keep": {0: 1.0, 1: 0.0, 2: -1.0, 3: 0.0}}
    most = int(angle_limit(scalar, wide) / Fraction(HALF_PI))
    for k in [*range(-40, 41), *range(-most, most, max(1, most // 500)), most]:
        values = {"x": interpreter._round(k * HALF_PI)}
        for statement in function.statements:
            interpreter._statement(statement, values)
        assert values["k"] == k
        for name, signs in wanted.items():
            assert abs(values[name]) == abs(signs[k % 4])
            assert values[name] == signs[k % 4]


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_leading_parts_of_a_right_angle_multiply_exactly(scalar: Scalar, wide: bool) -> None:
    digits = 53 if scalar == "float64" else 24
    *leading, tail = half_pi_parts(scalar, wide)
    most = round(angle_limit(scalar, wide) / Fraction(HALF_PI))
    # an odd multiple of a part, an odd number times a power of two, is longest for the largest odd multiple
    for multiple in (most, most - 1):
        odd = multiple // (multiple & -multiple)
        assert all((odd * part).numerator.bit_length() <= digits for part in leading)
    pi = Fraction(314159265358979323846264338327950288419716939937510, 10**50)
    assert abs(sum(leading) + tail - pi / 2) < Fraction(1, 10**48)
    assert abs(tail) < leading[-1] / 2**8


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_symmetries(scalar: Scalar) -> None:
    x = np.linspace(0.001, 90, 5001)
    sine, cosine = portable(x, scalar)
    minus_sine, minus_cosine = portable(-x, scalar)
    assert np.array_equal(minus_sine, -sine)
    assert np.array_equal(minus_cosine, cosine)
    assert tuple(float(v) for v in portable(0.0, scalar)) == (0.0, 1.0)
    for bad in (math.nan, math.inf):
        with np.errstate(invalid="ignore"):
            assert all(math.isnan(float(v)) for v in portable(bad, scalar))
