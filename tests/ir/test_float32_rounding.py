"""Rounding of the interpreter to single precision against NumPy, and arithmetic at the edges."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np

from symgen.ir.interpret import OPERATIONS, round_float32, round_literal


def test_rounding_is_that_of_ieee_single_precision() -> None:
    source = random.Random(3)
    for _ in range(3000):
        value = source.uniform(-2, 2) * 2.0 ** source.randint(-160, 130)
        with np.errstate(over="ignore"):
            assert round_float32(value) == float(np.float32(value))
    assert round_float32(3.5e38) == math.inf
    assert round_float32(-1e300) == -math.inf
    assert math.isnan(round_float32(math.nan))


def test_literals_are_rounded_once() -> None:
    # halfway in double precision, just above it exactly: rounding twice would go to even
    tie = Fraction(1) + Fraction(1, 2**24) + Fraction(1, 2**70)
    assert round_literal(tie, "float32") == 1 + 2.0**-23
    assert float(np.float32(float(tie))) == 1.0
    source = random.Random(4)
    for _ in range(500):
        value = Fraction(source.randint(-(10**30), 10**30), source.randint(1, 10**25)) / 2 ** source.randint(0, 200)
        rounded = Fraction(round_literal(value, "float32"))
        neighbours = [Fraction(float(np.nextafter(np.float32(rounded), np.float32(s)))) for s in (-np.inf, np.inf)]
        assert all(abs(value - rounded) <= abs(value - n) for n in neighbours)
        assert round_literal(value, "float64") == float(value)


def test_division_by_zero_follows_ieee() -> None:
    divide, ratio = OPERATIONS["div"], OPERATIONS["ratio_or_zero"]
    assert divide(1.0, 0.0) == math.inf
    assert divide(1.0, -0.0) == -math.inf
    assert math.isnan(divide(0.0, 0.0))
    assert ratio(1.0, 0.0) == 0.0
    assert ratio(0.0, 0.0) == 0.0
    assert math.isnan(ratio(math.nan, 1.0))
    assert math.isnan(OPERATIONS["sqrt"](-1.0))
