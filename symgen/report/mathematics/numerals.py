"""Exact rational numbers as they are set: integers, short decimals, or fractions."""

from __future__ import annotations

from fractions import Fraction as Rational

from symgen.report.mathematics.layout import Fraction, Layout, Numeral, Product, Scripts, minus

# With a larger denominator a number is set as a decimal, where that ends.
LARGEST_FRACTION_DENOMINATOR = 12
# Decimal places at most; what needs more is set otherwise.
DECIMAL_PLACES = 9


def decimal_text(value: Rational) -> str | None:
    """A terminating decimal of at most DECIMAL_PLACES places, or None."""
    scaled = value * 10**DECIMAL_PLACES
    if scaled.denominator != 1:
        return None
    sign = "-" if scaled < 0 else ""
    digits = str(abs(scaled.numerator)).rjust(DECIMAL_PLACES + 1, "0")
    whole, places = digits[:-DECIMAL_PLACES], digits[-DECIMAL_PLACES:].rstrip("0")
    return f"{sign}{whole}.{places}" if places else f"{sign}{whole}"


def rational_text(value: Rational) -> str:
    """A rational number on one line of plain text; decimals in scientific notation where that is exact and shorter."""
    scientific = f"{float(value):.15g}"
    return decimal_text(value) or (scientific if Rational(scientific) == value else str(value))


def rational_layout(value: Rational, prefer_decimal: bool = False) -> Layout:
    """A rational number; small denominators stay fractions unless the number was written as a decimal."""
    if value < 0:
        return minus(rational_layout(-value, prefer_decimal))
    if value.denominator == 1:
        return Numeral(str(value.numerator))
    text = decimal_text(value)
    if text is not None and (prefer_decimal or value.denominator > LARGEST_FRACTION_DENOMINATOR):
        return Numeral(text)
    mantissa, _, exponent = f"{float(value):.15g}".partition("e")
    if exponent and Rational(f"{mantissa}e{exponent}") == value:
        power = Scripts(Numeral("10"), None, minus(Numeral(str(-int(exponent)))))
        return power if mantissa == "1" else Product((Numeral(mantissa), power))
    return Fraction(Numeral(str(value.numerator)), Numeral(str(value.denominator)))
