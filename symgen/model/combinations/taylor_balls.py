"""Truncated Taylor series in the time with coefficients in the ball arithmetic of Arb.

What is computed encloses what is meant (Johansson, IEEE Trans. Computers 66, 2017), so that a number whose ball leaves
0 out is not 0: ranks are decided without a tolerance.  TimeSeries hold one coefficient, two or three.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from functools import cache
from typing import Any, TypeAlias, cast

from flint import arb, ctx, fmpq

from symgen.model.configurations.numbers import Numbers

# Binary digits of balls at first: 192 decimal ones.
FIRST_BALL_BITS = 640
# The same at most: more are taken where balls are too wide to decide.
MOST_BALL_BITS = 2560

Ball: TypeAlias = Any
"""A number of Arb with its radius."""
Operand: TypeAlias = "TimeSeries | float"


class WideBallError(ArithmeticError):
    """A ball is too wide to decide whether a number vanishes: more digits are needed."""


@contextmanager
def ball_precision(bits: int) -> Iterator[None]:
    """The working precision, for a while."""
    with ctx.workprec(bits):
        yield


def rounding() -> float:
    """What is left of a number of size one when Newton's method has converged at the working precision."""
    return float(2.0 ** -(0.8 * ctx.prec))


def ball(value: Fraction | float) -> Ball:
    """A number as a ball."""
    return arb(fmpq(value.numerator, value.denominator)) if isinstance(value, Fraction) else arb(value)


def wide() -> float:
    """The radius of a ball beyond which that 0 lies in it says nothing."""
    return float(2.0 ** -(ctx.prec / 4))


def may_vanish(value: Ball) -> bool:
    """Whether 0 lies in a ball; WideBallError where that says nothing."""
    if not value.contains(0):
        return False
    if not value.rad() < wide():
        raise WideBallError
    return True


class TimeSeries:
    """c[0] + c[1] t + c[2] t^2; the shorter operand says how far the result goes, numbers go as far as needed."""

    __slots__ = ("c",)

    def __init__(self, coefficients: Sequence[Ball]) -> None:
        self.c = tuple(coefficients)

    def __add__(self, other: Operand) -> TimeSeries:
        if isinstance(other, TimeSeries):
            return TimeSeries([a + b for a, b in zip(self.c, other.c, strict=False)])
        return TimeSeries((self.c[0] + other, *self.c[1:]))

    __radd__ = __add__

    def __neg__(self) -> TimeSeries:
        return TimeSeries([-a for a in self.c])

    def __sub__(self, other: Operand) -> TimeSeries:
        return self + -other

    def __rsub__(self, other: Operand) -> TimeSeries:
        return -self + other

    def __mul__(self, other: Operand) -> TimeSeries:
        if not isinstance(other, TimeSeries):
            return TimeSeries([a * other for a in self.c])
        a, b = self.c, other.c
        terms = min(len(a), len(b))
        first = a[0] * b[0]
        if terms == 1:
            return TimeSeries((first,))
        second = a[0] * b[1] + a[1] * b[0]
        return TimeSeries((first, second) if terms == 2 else (first, second, a[0] * b[2] + a[1] * b[1] + a[2] * b[0]))

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> TimeSeries:
        if not isinstance(other, TimeSeries):
            return TimeSeries([a / other for a in self.c])
        return self * _composed(other, lambda x: 1 / x, lambda x: -1 / x**2, lambda x: 2 / x**3)

    def __rtruediv__(self, other: Operand) -> TimeSeries:
        return series_of(other) / self

    def __ne__(self, other: object) -> bool:
        """Whether it may be another number: what is told from 0 is left out of sums."""
        return not (isinstance(other, (int, float)) and self.c[0] == other and all(a == 0 for a in self.c[1:]))

    def __eq__(self, other: object) -> bool:
        return not self != other

    __hash__ = None  # type: ignore[assignment]

    def __abs__(self) -> float:
        return abs(float(self.c[0].mid()))

    def __float__(self) -> float:
        return float(self.c[0].mid())


# Terms of a number that stays as it is: as many as there can be.
_MOST_TERMS = 3


def constant(value: Fraction | float) -> TimeSeries:
    """A number that does not change with the time."""
    return TimeSeries((ball(value), *(arb(0) for _ in range(_MOST_TERMS - 1))))


def series_of(value: object) -> TimeSeries:
    """What an evaluation in these numbers gave: literals among gradients are plain ones."""
    return value if isinstance(value, TimeSeries) else constant(cast(float, value))


_Slope: TypeAlias = Callable[[Ball], Ball]


def _composed(of: TimeSeries, value: _Slope, slope: _Slope, bend: _Slope) -> TimeSeries:
    """A function of a series, by the function and its two derivatives; ValueError where one has no value."""
    x = of.c[0]
    made = [value(x)]
    if len(of.c) > 1:
        made.append(slope(x) * of.c[1])
    if len(of.c) > 2:
        made.append(slope(x) * of.c[2] + bend(x) * of.c[1] * of.c[1] / 2)
    if not all(one.is_finite() for one in made):
        raise ValueError
    return TimeSeries(made)


def _square(x: Ball) -> Ball:
    """Arb goes by logarithms for powers, which a ball around 0 has not."""
    return x * x


_RULES: Mapping[str, tuple[_Slope, _Slope, _Slope]] = {
    "sin": (arb.sin, arb.cos, lambda x: -x.sin()),
    "cos": (arb.cos, lambda x: -x.sin(), lambda x: -x.cos()),
    "tan": (arb.tan, lambda x: 1 + _square(x.tan()), lambda x: 2 * x.tan() * (1 + _square(x.tan()))),
    "asin": (arb.asin, lambda x: (1 - x * x).rsqrt(), lambda x: x * (1 - x * x).rsqrt() ** 3),
    "acos": (arb.acos, lambda x: -((1 - x * x).rsqrt()), lambda x: -x * (1 - x * x).rsqrt() ** 3),
    "atan": (arb.atan, lambda x: 1 / (1 + x * x), lambda x: -2 * x / (1 + x * x) ** 2),
    "sqrt": (arb.sqrt, lambda x: x.rsqrt() / 2, lambda x: -(x.rsqrt() ** 3) / 4),
    "exp": (arb.exp, arb.exp, arb.exp),
    "log": (arb.log, lambda x: 1 / x, lambda x: -1 / x**2),
    "sinh": (arb.sinh, arb.cosh, arb.sinh),
    "cosh": (arb.cosh, arb.sinh, arb.cosh),
    "tanh": (arb.tanh, lambda x: 1 - _square(x.tanh()), lambda x: -2 * x.tanh() * (1 - _square(x.tanh()))),
}


# The values of functions, by their names.
FUNCTIONS_OF_BALLS: Mapping[str, Callable[..., Ball]] = {
    **{name: rules[0] for name, rules in _RULES.items()},
    "atan2": arb.atan2,
}


def _function(name: str) -> Callable[..., float]:
    rules = _RULES[name]
    return lambda x: cast(float, _composed(x, *rules))


def _atan2(y: TimeSeries, x: TimeSeries) -> float:
    """The angle of a direction, and x y' - y x' over its square as the rate."""
    terms = min(len(x.c), len(y.c))
    made = [arb.atan2(y.c[0], x.c[0])]
    if terms > 1:
        rates = [TimeSeries([k * c for k, c in enumerate(one.c)][1:]) for one in (x, y)]
        turning = (x * rates[1] - y * rates[0]) / (x * x + y * y)
        made += [c / (k + 1) for k, c in enumerate(turning.c[: terms - 1])]
    return cast(float, TimeSeries(made))


def _whole_power(x: Ball, power: int) -> Ball:
    if power < 0:
        return 1 / _whole_power(x, -power)
    if power < 2:
        return x if power else arb(1)
    half = _square(_whole_power(x, power // 2))
    return half * x if power % 2 else half


@cache
def raising(power: Fraction) -> Callable[[Ball], Ball]:
    """The function that raises a ball to a power; ValueError where there is none."""
    if power.denominator == 1:
        return lambda x: _whole_power(x, int(power))

    def raised(x: Ball) -> Ball:
        if not x > 0:
            raise ValueError
        return x ** ball(power)

    return raised


def _power(base: float, exponent: Fraction) -> float:
    value, bend = ball(exponent), exponent * (exponent - 1)
    made = _composed(
        cast(TimeSeries, base),
        raising(exponent),
        lambda x: value * raising(exponent - 1)(x) if exponent else arb(0),
        lambda x: ball(bend) * raising(exponent - 2)(x) if bend else arb(0),
    )
    return cast(float, made)


def ball_numbers() -> Numbers:
    """What expressions are evaluated in: series of balls, told to the type checker as floats."""
    literals: dict[Fraction | int, TimeSeries] = {}

    def rational(value: Fraction | int) -> float:
        if value not in literals:
            literals[value] = constant(Fraction(value))
        return cast(float, literals[value])

    functions: dict[str, Callable[..., float]] = {name: _function(name) for name in _RULES}
    functions["atan2"] = cast(Callable[..., float], _atan2)
    return Numbers(
        cast(float, TimeSeries((arb.pi(), arb(0), arb(0)))),
        functions,
        rational,
        _power,
    )
