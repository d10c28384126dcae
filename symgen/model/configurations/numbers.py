"""What expressions are evaluated in while a model is loaded: floats, or many digits where floats do not decide."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache
from typing import Any, cast

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import FUNCTIONS, power
from symgen.records import dataclass

# Binary digits where floats do not decide.
PRECISE_BITS = 400


@dataclass(frozen=True, slots=True)
class Numbers:
    """One kind of numbers: they are told to the type checker as floats, which all of them mix with."""

    pi: float
    functions: Mapping[str, Callable[..., float]]
    rational: Callable[[Fraction | int], float]
    power: Callable[[float, Fraction], float]

    def evaluate(self, expression: Expression, values: Mapping[str, float]) -> float:
        """The value of an expression without rates; ArithmeticError or ValueError outside the domain."""
        match expression:
            case Number(value=value):
                return self.rational(value)
            case Pi():
                return self.pi
            case Name(name=name):
                return values[name]
            case Negation(operand=operand):
                return -self.evaluate(operand, values)
            case Binary(operator=operator, left=left, right=right):
                a, b = self.evaluate(left, values), self.evaluate(right, values)
                return a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
            case Power(base=base, exponent=exponent):
                return self.power(self.evaluate(base, values), exponent)
            case Call(function=function, arguments=arguments):
                return self.functions[function](*(self.evaluate(argument, values) for argument in arguments))


def _rational(value: Fraction | int) -> float:
    return value.numerator / value.denominator  # as Fraction does it, many times


FLOATS = Numbers(math.pi, FUNCTIONS, _rational, power)


@cache
def precise() -> Numbers:
    """Numbers of 120 digits, with the exponents of no format; they are made when they are first needed."""
    import mpmath

    context = mpmath.MPContext()
    context.prec = PRECISE_BITS

    def function(name: str) -> Callable[..., float]:
        known = getattr(context, name)

        def real(*arguments: float) -> float:
            value: Any = known(*map(context.mpf, arguments))
            if not isinstance(value, context.mpf) or not context.isfinite(value):
                raise ValueError(name)
            return cast(float, value)

        return real

    def rational(value: Fraction | int) -> float:
        return cast(float, context.mpf(value.numerator) / value.denominator)

    def raised(base: float, exponent: Fraction) -> float:
        if exponent.denominator == 1:
            return cast(float, context.mpf(base) ** int(exponent))
        if base < 0:
            raise ValueError("a root of a negative number")
        return cast(float, context.mpf(base) ** rational(exponent))

    return Numbers(cast(float, +context.pi), {name: function(name) for name in FUNCTIONS}, rational, raised)
