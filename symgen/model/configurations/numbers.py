"""What expressions are evaluated in while a model is loaded: floats, or many digits where floats do not decide."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache
from typing import cast

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import FUNCTIONS, power
from symgen.records import dataclass


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
    from symgen.model.configurations.many_digits import ManyDigits, function

    def raised(base: float, exponent: Fraction) -> float:
        return cast(float, ManyDigits.of(base) ** exponent)

    def rational(value: Fraction | int) -> float:
        return cast(float, ManyDigits.rational(value))

    functions = {name: cast(Callable[..., float], function(name)) for name in FUNCTIONS}
    return Numbers(cast(float, ManyDigits.pi()), functions, rational, raised)
