"""Numbers of 120 digits, with the exponents of no format: midpoints of Arb's balls, each operation rounded once.

They mix with whole numbers and floats; what has no value raises ZeroDivisionError or ValueError, as floats do.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Self, TypeAlias

from flint import arb, ctx, fmpq

# Binary digits where floats do not decide.
PRECISE_BITS = 400

Mixed: TypeAlias = "ManyDigits | float"


class ManyDigits:
    """One number."""

    __slots__ = ("_mid",)

    def __init__(self, value: Any) -> None:
        self._mid = value

    @classmethod
    def of(cls, value: Mixed) -> ManyDigits:
        """The same number as one of many digits."""
        return value if isinstance(value, ManyDigits) else cls(arb(value))

    @classmethod
    def rational(cls, value: Fraction | int) -> Self:
        """The nearest number."""
        with ctx.workprec(PRECISE_BITS):
            return cls(arb(fmpq(value.numerator, value.denominator)).mid())

    @classmethod
    def pi(cls) -> Self:
        """The constant."""
        with ctx.workprec(PRECISE_BITS):
            return cls(arb.pi().mid())

    @property
    def parts(self) -> tuple[int, int]:
        """The number as a whole one times a power of 2."""
        mantissa, exponent = self._mid.man_exp()
        return int(mantissa), int(exponent)

    def __add__(self, other: Mixed) -> ManyDigits:
        return _rounded(lambda: self._mid + _plain(other))

    def __sub__(self, other: Mixed) -> ManyDigits:
        return _rounded(lambda: self._mid - _plain(other))

    def __rsub__(self, other: Mixed) -> ManyDigits:
        return _rounded(lambda: _plain(other) - self._mid)

    def __mul__(self, other: Mixed) -> ManyDigits:
        return _rounded(lambda: self._mid * _plain(other))

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other: Mixed) -> ManyDigits:
        divisor = _plain(other)
        if divisor == 0:
            raise ZeroDivisionError
        return _rounded(lambda: self._mid / divisor)

    def __rtruediv__(self, other: Mixed) -> ManyDigits:
        return ManyDigits(_plain(other)) / self

    def __pow__(self, exponent: Fraction | float) -> ManyDigits:
        power = Fraction(exponent)
        if self._mid == 0 and power <= 0:
            if power < 0:
                raise ZeroDivisionError
            return ManyDigits(arb(1))
        if power.denominator == 1:
            return _rounded(lambda: self._mid ** int(power))
        if self._mid < 0:
            raise ValueError("a root of a negative number")
        if self._mid == 0:
            return self
        return _rounded(lambda: self._mid ** arb(fmpq(power.numerator, power.denominator)))

    def __neg__(self) -> ManyDigits:
        return _rounded(lambda: -self._mid)

    def __abs__(self) -> ManyDigits:
        return self if self._mid >= 0 else -self

    def __lt__(self, other: Mixed) -> bool:
        return bool(self._mid < _plain(other))

    def __le__(self, other: Mixed) -> bool:
        return bool(self._mid <= _plain(other))

    def __gt__(self, other: Mixed) -> bool:
        return bool(self._mid > _plain(other))

    def __ge__(self, other: Mixed) -> bool:
        return bool(self._mid >= _plain(other))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (ManyDigits, int, float)) and bool(self._mid == _plain(other))

    __hash__ = None  # type: ignore[assignment]

    def __bool__(self) -> bool:
        return bool(self._mid != 0)

    def __float__(self) -> float:
        return float(self._mid)


def _plain(value: Mixed) -> Any:
    """Of this number, or of one that it mixes with; these are exact."""
    return value._mid if isinstance(value, ManyDigits) else arb(value)


def _rounded(operation: Callable[[], Any]) -> ManyDigits:
    """The middle of the ball that an operation gives."""
    with ctx.workprec(PRECISE_BITS):
        ball = operation()
    if not ball.is_finite():
        raise ValueError("no finite number")
    return ManyDigits(ball.mid())


def function(name: str) -> Callable[..., ManyDigits]:
    """A function of the expression language; ValueError where it has no value."""

    def known(*arguments: Mixed) -> ManyDigits:
        return _rounded(lambda: getattr(arb, name)(*map(_plain, arguments)))

    return known
