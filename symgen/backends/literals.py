"""Exact numbers as source text: rounded once, to nearest even, and printed with the fewest digits that read back."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from functools import cache

from symgen.ir.kernel import Literal, Program, Scalar
from symgen.ir.rounding import round_to_float32


def round_to(scalar: Scalar, value: Fraction) -> float:
    """`value` rounded once to the scalar type, as a Python float that holds it exactly."""
    return float(value) if scalar == "float64" else round_to_float32(value)


class LiteralRangeError(Exception):
    """A number of a kernel that is beyond the range of its scalar type."""

    def __init__(self, scalar: Scalar, value: Fraction) -> None:
        digits = len(str(abs(value.numerator) // value.denominator)) - 1
        super().__init__(f"the kernels hold a number of about 1e{digits}, which is beyond the range of {scalar}")
        self.scalar = scalar


def in_range(scalar: Scalar, value: Fraction) -> float:
    """`value` rounded to the scalar type; LiteralRangeError for one that this does not hold."""
    try:
        return round_to(scalar, value)
    except OverflowError as error:
        raise LiteralRangeError(scalar, value) from error


def check_literals(programs: Mapping[Scalar, Program]) -> None:
    """Raises LiteralRangeError as writing would."""
    for scalar, program in programs.items():
        for kernel in program.kernels:
            for statement in kernel.statements:
                for operand in statement.operands:
                    if isinstance(operand, Literal):
                        in_range(scalar, operand.value)


@cache
def decimal_text(scalar: Scalar, value: Fraction) -> str:
    """The shortest decimal that reads back as `value` rounded to the scalar type; always with a point or exponent."""
    rounded = in_range(scalar, value)
    if scalar == "float64":
        return repr(rounded)
    texts = (f"{rounded:.{digits}g}" for digits in range(1, 10))  # nine digits always read back
    return repr(float(next(text for text in texts if _reads_back(text, rounded))))


def _reads_back(text: str, rounded: float) -> bool:
    try:
        return round_to_float32(Fraction(Decimal(text))) == rounded
    except OverflowError:
        return False
