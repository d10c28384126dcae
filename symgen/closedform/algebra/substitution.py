"""Names replaced by expressions in a syntax tree."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Power


def substitute(expression: Expression, values: Mapping[str, Expression]) -> Expression:
    """The tree with every name that has a value replaced by that value, which may use earlier ones of `values`."""
    if not values:
        return expression
    match expression:
        case Name(name) if name in values:
            earlier = dict(list(values.items())[: list(values).index(name)])
            return substitute(values[name], earlier)
        case Negation(operand):
            return Negation(substitute(operand, values), expression.span)
        case Binary(operator, left, right):
            return Binary(operator, substitute(left, values), substitute(right, values), expression.span)
        case Power(base, exponent):
            return Power(substitute(base, values), exponent, expression.span)
        case Call(function, arguments):
            return Call(function, tuple(substitute(a, values) for a in arguments), expression.span)
        case _:
            return expression
