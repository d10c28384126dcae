"""The arithmetics in which expressions are evaluated: floats for drawing, balls for the witness."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from typing import Any, ClassVar

# 50 digits and as many again for what cancels
BITS = 340


class Floats:
    """Double precision."""

    functions: ClassVar[dict[str, Callable[..., Any]]] = {
        name: getattr(math, name)
        for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "sinh", "cosh", "tanh")
    }

    def number(self, value: Fraction) -> float:
        """The nearest float."""
        return value.numerator / value.denominator

    def pi(self) -> float:
        """pi."""
        return math.pi

    def power(self, base: float, exponent: Fraction) -> float:
        """base to a rational power."""
        return float(base ** (exponent.numerator if exponent.denominator == 1 else float(exponent)))


class Balls:
    """Ball arithmetic of `BITS` bits."""

    def __init__(self) -> None:
        from flint import arb

        self._arb = arb
        self.functions: dict[str, Callable[..., Any]] = {
            name: getattr(arb, name)
            for name in ("sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "sinh", "cosh", "tanh")
        } | {"atan2": lambda y, x: arb.atan2(y, x)}
        self._numbers: dict[Fraction, Any] = {}

    def number(self, value: Fraction) -> Any:
        """The ball of a rational."""
        ball = self._numbers.get(value)
        if ball is None:
            ball = self._numbers[value] = self._arb(value.numerator) / self._arb(value.denominator)
        return ball

    def pi(self) -> Any:
        """pi."""
        return self._arb.pi()

    def power(self, base: Any, exponent: Fraction) -> Any:
        """base to a rational power."""
        if exponent.denominator <= 2:
            root = base if exponent.denominator == 1 else base.sqrt()
            # powers of balls about 0 by logarithms are no numbers
            product = math.prod([root] * abs(exponent.numerator), start=self._arb(1))
            return product if exponent > 0 else 1 / product
        return base ** (self._arb(exponent.numerator) / self._arb(exponent.denominator))


@contextmanager
def precision(bits: int = BITS) -> Iterator[None]:
    """Balls of so many bits inside."""
    from flint import ctx

    before = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = before


def settled(evaluate: Callable[[Mapping[str, Any], Any], list[Any]], values: Mapping[str, float]) -> list[Any]:
    """What is evaluated in balls at exactly these values, as floats: 0 where nothing but rounding is left."""
    from flint import arb

    with precision():
        balls = evaluate({name: arb(value) for name, value in values.items()}, Balls())
        return [0.0 if ball.is_finite() and ball.contains(0) else float(ball.mid()) for ball in balls]
