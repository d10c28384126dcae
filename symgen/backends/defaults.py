"""Default parameter values: exact where rational, otherwise through the double precision functions of `math`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import FUNCTIONS
from symgen.model.model import Model


def default_values(model: Model) -> dict[str, Fraction]:
    """The default of every parameter, in the order of the file.

    Sums, products, quotients and integer powers are exact; functions, `pi` and roots are taken in double precision
    (error of a few 1e-16 relative), which is the precision the values are used with.
    """
    values: dict[str, Fraction] = {}
    for parameter in model.parameters:
        try:
            values[parameter.name] = _value(parameter.value, values)
        except (ArithmeticError, ValueError, KeyError) as error:
            raise SymgenBug(f"emit: the default of parameter {parameter.name} has no finite value") from error
    return values


def _value(expression: Expression, known: Mapping[str, Fraction]) -> Fraction:
    match expression:
        case Number(value):
            return value
        case Pi():
            return Fraction(math.pi)
        case Name(name):
            return known[name]
        case Negation(operand):
            return -_value(operand, known)
        case Binary(operator, left, right):
            return _binary(operator, _value(left, known), _value(right, known))
        case Power(base, exponent):
            return _power(_value(base, known), exponent)
        case Call(function, arguments):
            return Fraction(FUNCTIONS[function](*(float(_value(argument, known)) for argument in arguments)))


def _binary(operator: str, left: Fraction, right: Fraction) -> Fraction:
    match operator:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case _:
            return left / right


def _power(base: Fraction, exponent: Fraction) -> Fraction:
    if exponent.denominator == 1:
        return Fraction(base**exponent.numerator)
    return Fraction(math.pow(float(base), float(exponent)))
