"""Exact numbers are rounded once and printed so that they read back."""

from __future__ import annotations

import struct
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symgen.backends.c.statements import c_literal
from symgen.backends.literals import LiteralRangeError, decimal_text
from symgen.backends.python.statements import numpy_literal
from symgen.ir.kernel import Scalar
from symgen.ir.rounding import round_to_float32

FRACTIONS = st.fractions(min_value=-(10**12), max_value=10**12, max_denominator=10**12)


def neighbours(value: float) -> tuple[Fraction, Fraction, int]:
    """The float32 numbers next to a positive float32, exactly, and the last bit of its own pattern."""
    bits = struct.unpack("<I", struct.pack("<f", value))[0]
    below, above = (Fraction(struct.unpack("<f", struct.pack("<I", bits + k))[0]) for k in (-1, 1))
    return below, above, bits & 1


@given(FRACTIONS.filter(lambda value: value != 0))
def test_float32_is_nearest_with_ties_to_even(value: Fraction) -> None:
    rounded = abs(round_to_float32(value))
    below, above, odd = neighbours(rounded)
    distance = abs(Fraction(rounded) - abs(value))
    others = min(abs(below - abs(value)), abs(above - abs(value)))
    assert distance < others or (distance == others and not odd)


def test_float32_is_not_rounded_through_float64() -> None:
    # just above the middle of two float32 numbers, but exactly the middle once rounded to float64
    value = 1 + Fraction(1, 2**24) + Fraction(1, 2**60)
    assert float(value) == 1 + 2**-24
    assert round_to_float32(value) == 1 + 2**-23
    assert decimal_text("float32", value) == "1.0000001"


@pytest.mark.parametrize(("value", "expected"), [(2**-149, 2**-149), (2**-151, 0.0), (3 * 2**-150, 2**-148)])
def test_float32_subnormals(value: float, expected: float) -> None:
    assert round_to_float32(Fraction(value)) == expected


@given(FRACTIONS)
def test_text_reads_back(value: Fraction) -> None:
    assert float(decimal_text("float64", value)) == float(value)
    assert round_to_float32(Fraction(decimal_text("float32", value))) == round_to_float32(value)


@pytest.mark.parametrize(
    ("scalar", "value", "text"),
    [
        ("float64", Fraction(2), "2.0"),
        ("float64", Fraction(1, 10), "0.1"),
        ("float64", Fraction(-1, 3), "(-0.3333333333333333)"),
        ("float64", Fraction(10) ** 22, "1e+22"),
        ("float32", Fraction(100), "100.0f"),
        ("float32", Fraction(1, 10), "0.1f"),
        ("float32", Fraction(1, 10**9), "1e-09f"),
        ("float32", Fraction(16777217), "16777216.0f"),
    ],
)
def test_c_literals(scalar: Scalar, value: Fraction, text: str) -> None:
    assert c_literal(scalar, value) == text


def test_numpy_literal() -> None:
    assert numpy_literal(Fraction(-5, 2)) == "(-2.5)"


@pytest.mark.parametrize(("scalar", "power"), [("float32", 128), ("float64", 1024)])
def test_numbers_beyond_the_range_are_refused(scalar: Scalar, power: int) -> None:
    size = power * 30103 // 100000
    with pytest.raises(LiteralRangeError, match=f"about 1e{size}, which is beyond the range of {scalar}"):
        c_literal(scalar, Fraction(2) ** power)
