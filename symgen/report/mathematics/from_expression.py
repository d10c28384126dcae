"""The model's syntax tree as layout, in the order the user wrote it."""

from __future__ import annotations

from fractions import Fraction

from symgen.model.expressions.expression import (
    Binary,
    Call,
    Expression,
    Name,
    Negation,
    Number,
    Pi,
    Power,
)
from symgen.report.mathematics.layout import (
    Layout,
    Letter,
    Numeral,
    Root,
    Sum,
    minus,
    signed,
    total,
)
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.numerals import rational_layout
from symgen.report.mathematics.setting import call, power, product, quotient


def expression_layout(expression: Expression) -> Layout:
    """An expression of a model file as it is set."""
    match expression:
        case Number(value=value):
            return rational_layout(value, prefer_decimal=True)
        case Pi():
            return Letter("π")
        case Name(name=name):
            return name_layout(name)
        case Negation(operand=operand):
            return minus(expression_layout(operand))
        case Power(base=base, exponent=exponent):
            inside = expression_layout(base)
            if exponent == Fraction(1, 2):
                return Root(inside)
            if exponent < 0:
                return quotient(Numeral("1"), inside if exponent == -1 else power(inside, Numeral(str(-exponent))))
            return power(inside, Numeral(str(exponent)))
        case Call(function=function, arguments=arguments):
            return call(function, tuple(expression_layout(argument) for argument in arguments))
        case Binary(operator="+"):
            left, right = _operands(expression)
            return total((left, right))
        case Binary(operator="-"):
            left, right = _operands(expression)
            return total((left, minus(right)))
        case Binary(operator="/"):
            sign, numerator = signed(expression_layout(expression.left))
            result = quotient(numerator, expression_layout(expression.right))
            return result if sign == "+" else Sum((("-", result),))
        case Binary():
            return _product(expression)


def _operands(expression: Binary) -> tuple[Layout, Layout]:
    """Both sides of a sum, turned into layout along the chain of left operands without deep recursion."""
    return expression_layout(expression.left), expression_layout(expression.right)


def _product(expression: Binary) -> Layout:
    """A chain of factors; the sign of the first one stays outside."""
    factors: list[Expression] = []
    node: Expression = expression
    while isinstance(node, Binary) and node.operator == "*":
        factors.append(node.right)
        node = node.left
    factors.append(node)
    sign, first = signed(expression_layout(factors.pop()))
    others = [expression_layout(factor) for factor in reversed(factors)]
    result = product(others if first == Numeral("1") else [first, *others])
    return result if sign == "+" else Sum((("-", result),))
