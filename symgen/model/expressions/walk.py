"""Reading a syntax tree without translating it: its names, and its value in plain floats or exact rationals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power

FUNCTIONS: dict[str, Callable[..., float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "atan2": math.atan2, "sqrt": math.sqrt, "exp": math.exp, "log": math.log, "sinh": math.sinh, "cosh": math.cosh,
    "tanh": math.tanh,
}  # fmt: skip


def parts(expression: Expression) -> Iterator[Expression]:
    """The expression and all its sub-expressions, from left to right."""
    yield expression
    match expression:
        case Negation(operand=inner) | Power(base=inner):
            yield from parts(inner)
        case Binary(left=left, right=right):
            yield from parts(left)
            yield from parts(right)
        case Call(arguments=arguments):
            for argument in arguments:
                yield from parts(argument)


def names_in(expression: Expression) -> Iterator[Name]:
    """Every occurrence of a name, from left to right."""
    return (part for part in parts(expression) if isinstance(part, Name))


def evaluate(expression: Expression, values: Mapping[str, float]) -> float:
    """The value in floats; ArithmeticError or ValueError outside the domain or beyond the range of floats."""
    match expression:
        case Number(value=value):
            result = float(value)
        case Pi():
            return math.pi
        case Name(name=name):
            return values[name]
        case Negation(operand=operand):
            return -evaluate(operand, values)
        case Binary(operator=operator, left=left, right=right):
            a, b = evaluate(left, values), evaluate(right, values)
            result = a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
        case Power(base=base, exponent=exponent):
            result = power(evaluate(base, values), exponent)
        case Call(function=function, arguments=arguments):
            result = FUNCTIONS[function](*(evaluate(argument, values) for argument in arguments))
    if not math.isfinite(result):
        raise OverflowError
    return result


def power(base: float, exponent: Fraction) -> float:
    """The real power; ValueError for a root of a negative number."""
    if exponent.denominator == 1:
        return base ** int(exponent)
    return math.pow(base, float(exponent))


def exact_value(expression: Expression) -> Fraction | None:
    """The value of an expression of literals and + - * / ** alone; None where it is not rational."""
    match expression:
        case Number(value=value):
            return value
        case Negation(operand=operand):
            inner = exact_value(operand)
            return None if inner is None else -inner
        case Binary(operator=operator, left=left, right=right):
            a = exact_value(left)
            b = None if a is None else exact_value(right)
            if a is None or b is None or (operator == "/" and b == 0):
                return None
            return a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
        case Power(base=base, exponent=exponent) if exponent.denominator == 1:
            a = exact_value(base)
            return None if a is None or (a == 0 and exponent < 0) else a ** int(exponent)
        case _:
            return None
