"""Derivatives of expressions, as expressions: for what places frames and points, which is short."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from symgen.model.expressions.combine import divided, minus, negated, plus, times
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.mechanism import ZERO

ONE = Number(Fraction(1))


def derivative(expression: Expression, slope: Callable[[str], Expression]) -> Expression:
    """The derivative of an expression from those of the names in it."""

    def of(part: Expression) -> Expression:
        return derivative(part, slope)

    match expression:
        case Number() | Pi():
            return ZERO
        case Name(name=name):
            return slope(name)
        case Negation(operand=operand):
            return negated(of(operand))
        case Binary(operator="+", left=left, right=right):
            return plus(of(left), of(right))
        case Binary(operator="-", left=left, right=right):
            return minus(of(left), of(right))
        case Binary(operator="*", left=left, right=right):
            return plus(times(of(left), right), times(left, of(right)))
        case Binary(left=left, right=right):
            return divided(minus(of(left), times(divided(left, right), of(right))), right)
        case Power(base=base, exponent=exponent):
            lowered = base if exponent == 2 else Power(base, exponent - 1)
            return times(times(Number(exponent), lowered), of(base))
        case Call(function="atan2", arguments=(y, x)):
            square = plus(Power(y, Fraction(2)), Power(x, Fraction(2)))
            return divided(minus(times(x, of(y)), times(y, of(x))), square)
        case Call(arguments=(argument,)):
            return times(_outer(expression), of(argument))
        case _:
            raise TypeError(expression)


def _outer(call: Call) -> Expression:
    """The derivative of a function of one argument by it."""
    (x,) = call.arguments
    square = Power(x, Fraction(2))
    match call.function:
        case "sin":
            return Call("cos", (x,))
        case "cos":
            return Negation(Call("sin", (x,)))
        case "tan":
            return plus(ONE, Power(call, Fraction(2)))
        case "asin":
            return Power(minus(ONE, square), Fraction(-1, 2))
        case "acos":
            return Negation(Power(minus(ONE, square), Fraction(-1, 2)))
        case "atan":
            return divided(ONE, plus(ONE, square))
        case "sqrt":
            return divided(Number(Fraction(1, 2)), call)
        case "exp":
            return call
        case "log":
            return divided(ONE, x)
        case "sinh":
            return Call("cosh", (x,))
        case "cosh":
            return Call("sinh", (x,))
        case _:
            return minus(ONE, Power(call, Fraction(2)))
