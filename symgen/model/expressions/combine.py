"""Expressions from expressions, without the zeros and ones that a person would not write either."""

from __future__ import annotations

from symgen.model.expressions.expression import Binary, Expression, Negation
from symgen.model.expressions.walk import exact_value
from symgen.model.mechanism import ZERO


def plus(left: Expression, right: Expression) -> Expression:
    """left + right without zeros."""
    if exact_value(left) == 0:
        return right
    return left if exact_value(right) == 0 else Binary("+", left, right)


def minus(left: Expression, right: Expression) -> Expression:
    """left - right without zeros."""
    if exact_value(right) == 0:
        return left
    return Negation(right) if exact_value(left) == 0 else Binary("-", left, right)


def times(left: Expression, right: Expression) -> Expression:
    """left * right without factors 0 and 1."""
    for one, other in ((left, right), (right, left)):
        if exact_value(one) == 0:
            return ZERO
        if exact_value(one) == 1:
            return other
    return Binary("*", left, right)


def divided(left: Expression, right: Expression) -> Expression:
    """left / right without divisors 1."""
    return left if exact_value(left) == 0 or exact_value(right) == 1 else Binary("/", left, right)


def negated(operand: Expression) -> Expression:
    """-operand."""
    if isinstance(operand, Negation):
        return operand.operand
    return operand if exact_value(operand) == 0 else Negation(operand)
