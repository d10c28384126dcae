"""Expressions bound to functions of one configuration: values alone, and values with gradients.

Searches evaluate the same rows thousands of times.  Operations and operands are those of `Gradients`, in the same
order, so that values and gradients are the same to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from typing import TypeAlias

from symgen.model.configurations.gradient import BINARY, Dual, Gradients, call_of, scaled
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power

BoundExpression: TypeAlias = Callable[[Gradients], float]
BoundDual: TypeAlias = Callable[[Gradients], Dual]


def bound(expression: Expression, given: Container[str]) -> BoundExpression:
    """The value of an expression at a configuration; ArithmeticError or ValueError outside the domain.

    Names of `given` are coordinates and parameters; others are definitions or components.
    """
    match expression:
        case Number(value=number):
            return lambda at: at.numbers.rational(number)
        case Pi():
            return lambda at: at.numbers.pi
        case Name(name=name):
            return (lambda at: at.values[name]) if name in given else (lambda at: at.name(expression)[0])
        case Negation(operand=operand):
            own = bound(operand, given)
            return lambda at: -own(at)
        case Binary(operator=operator, left=left, right=right):
            return _bound_operation(operator, bound(left, given), bound(right, given))
        case Power(base=base, exponent=exponent):
            own = bound(base, given)
            return lambda at: at.numbers.power(own(at), exponent)
        case Call(function=function, arguments=(argument,)):
            own = bound(argument, given)
            return lambda at: at.numbers.functions[function](own(at))
        case Call(function=function, arguments=arguments):
            several = [bound(argument, given) for argument in arguments]
            return lambda at: at.numbers.functions[function](*(one(at) for one in several))


def bound_dual(expression: Expression, index: Mapping[str, int], given: Container[str]) -> BoundDual:
    """The same with the gradient by the coordinates in the index."""
    match expression:
        case Number(value=number):
            return lambda at: (at.numbers.rational(number), {})
        case Name(name=name) if name in index:
            place = index[name]
            return lambda at: (at.values[name], {place: 1.0})
        case Name(name=name) if name in given:
            return lambda at: (at.values[name], {})
        case Negation(operand=operand):
            return _bound_negation(bound_dual(operand, index, given))
        case Binary(operator=operator, left=left, right=right):
            one, other = bound_dual(left, index, given), bound_dual(right, index, given)
            operation = BINARY[operator]
            return lambda at: operation(*one(at), *other(at))
        case Call(function=function, arguments=(argument,)):
            own = bound_dual(argument, index, given)
            return lambda at: call_of(at.numbers.functions, function, *own(at))
        case _:
            return lambda at: at.of(expression)


def _bound_negation(own: BoundDual) -> BoundDual:
    def negated(at: Gradients) -> Dual:
        value, gradient = own(at)
        return -value, scaled(gradient, -1.0)

    return negated


def _bound_operation(operator: str, left: BoundExpression, right: BoundExpression) -> BoundExpression:
    match operator:
        case "+":
            return lambda at: left(at) + right(at)
        case "-":
            return lambda at: left(at) - right(at)
        case "*":
            return lambda at: left(at) * right(at)
        case _:
            return lambda at: left(at) / right(at)
