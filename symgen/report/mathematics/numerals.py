"""Rational numbers as they are set: integers, short decimals and fractions as they are, long ones rounded."""

from __future__ import annotations

from decimal import Context, Decimal
from fractions import Fraction as Rational

from symgen.report.mathematics.layout import Fraction, Layout, Numeral, Product, Scripts, minus

# With a larger denominator a number is set as a decimal, where that ends.
LARGEST_FRACTION_DENOMINATOR = 12
# Decimal places at most; what needs more is set otherwise.
DECIMAL_PLACES = 9
# Digits up to which a decimal, or either side of a fraction, is set as it is.
MOST_DIGITS = 9
# Digits that are set of a number that is too long for that.
ROUNDED_DIGITS = 6
# Powers of ten of the first digit of rounded numbers that are written without one.
_PLAIN_EXPONENTS = range(-4, MOST_DIGITS)


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


def decimal_coefficient(value: Rational) -> bool:
    """Whether a number before a product is set as a decimal where that ends soon."""
    return value.denominator > LARGEST_FRACTION_DENOMINATOR or long_number(value)


def long_number(value: Rational) -> bool:
    """Whether a fraction of whole numbers is more than one wants to read."""
    return len(str(abs(value.numerator))) + len(str(value.denominator)) > MOST_DIGITS


def rational_layout(value: Rational, prefer_decimal: bool = False) -> Layout:
    """A rational number; small denominators stay fractions unless the number was written as a decimal.

    What has more than MOST_DIGITS is set with ROUNDED_DIGITS, and marked as rounded.
    """
    if value < 0:
        return minus(rational_layout(-value, prefer_decimal))
    if value.denominator == 1 and value < 10**MOST_DIGITS:
        return Numeral(str(value.numerator))
    text = decimal_text(value)
    wanted = prefer_decimal or decimal_coefficient(value)
    if text is not None and wanted and _digits(text) <= MOST_DIGITS and value < 10**MOST_DIGITS:
        return Numeral(text)
    near = _near(value, MOST_DIGITS)
    if wanted and Rational(near) == value:
        return _scientific(near, rounded=False)
    if not long_number(value):
        return Fraction(Numeral(str(value.numerator)), Numeral(str(value.denominator)))
    near = _near(value, ROUNDED_DIGITS)
    plain = near.adjusted() in _PLAIN_EXPONENTS
    return Numeral(f"{near:f}", rounded=True) if plain else _scientific(near, rounded=True)


def _digits(text: str) -> int:
    """Digits of a decimal from the first that is not zero."""
    return len(text.replace(".", "").lstrip("0"))


def _near(value: Rational, digits: int) -> Decimal:
    """The number in so many digits, without zeros at the end; of any size."""
    return Context(prec=digits).divide(value.numerator, value.denominator).normalize()


def _scientific(number: Decimal, rounded: bool) -> Layout:
    exponent = number.adjusted()
    power = Numeral(str(exponent)) if exponent > 0 else minus(Numeral(str(-exponent)))
    mantissa, ten = f"{number.scaleb(-exponent):f}", Scripts(Numeral("10"), None, power)
    return ten if mantissa == "1" and not rounded else Product((Numeral(mantissa, rounded), ten))
