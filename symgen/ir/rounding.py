"""Exact numbers rounded once to float32: what is printed of a literal is what the interpreter computes with."""

from __future__ import annotations

import math
from fractions import Fraction

# Binary digits of a float32.
_FLOAT32_DIGITS = 24
# The power of two of the smallest float32, a subnormal one.
_FLOAT32_LOWEST_EXPONENT = -149
# What no float32 reaches: what is rounded to this is infinite.
_FLOAT32_LIMIT = Fraction(2**128)


def round_to_float32(value: Fraction) -> float:
    """The binary32 number nearest to `value` (ties to even), exactly held in a Python float; no double rounding.

    Raises OverflowError where that is infinite.
    """
    if value == 0:
        return 0.0
    magnitude = abs(value)
    exponent = magnitude.numerator.bit_length() - magnitude.denominator.bit_length()
    if magnitude < Fraction(2) ** exponent:
        exponent -= 1
    unit = Fraction(2) ** max(exponent - (_FLOAT32_DIGITS - 1), _FLOAT32_LOWEST_EXPONENT)
    rounded = round(magnitude / unit) * unit  # Fraction rounds half to even
    if rounded >= _FLOAT32_LIMIT:
        raise OverflowError(f"{float(value):.6g} does not fit in float32")
    return math.copysign(float(rounded), value)
