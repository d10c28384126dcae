"""Angles whose sines and cosines everybody knows: multiples of 30 and 45 degrees, written with pi.

A turn by one is a direction, as an axis is: a kernel rounds its sine, as the reference does at the end, but no pi.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.model.expressions.expression import Binary, Expression, Negation, Number, Pi


def is_known(angle: Expression) -> bool:
    """Whether the angle is k pi/6 or k pi/4."""
    turns = _multiple_of_pi(angle)
    return turns is not None and 1 in ((6 * turns).denominator, (4 * turns).denominator)


def sine_and_cosine(angle: Expression) -> tuple[int, int] | None:
    """Those of whole quarter turns, which are exact; None for other angles."""
    turns = _multiple_of_pi(angle)
    if turns is None or (2 * turns).denominator != 1:
        return None
    return ((0, 1), (1, 0), (0, -1), (-1, 0))[int(2 * turns) % 4]


def _multiple_of_pi(angle: Expression) -> Fraction | None:
    """b of an angle that is written as b pi."""
    match angle:
        case Pi():
            return Fraction(1)
        case Negation(operand):
            inner = _multiple_of_pi(operand)
            return None if inner is None else -inner
        case Binary("*" | "/" as operator, left, right):
            factor, turned = _number(right), _multiple_of_pi(left)
            if factor is None and operator == "*":
                factor, turned = _number(left), _multiple_of_pi(right)
            if not factor or turned is None:
                return None
            return turned * factor if operator == "*" else turned / factor
        case _:
            return None


def _number(expression: Expression) -> Fraction | None:
    match expression:
        case Number(value):
            return value
        case Negation(operand):
            inner = _number(operand)
            return None if inner is None else -inner
        case _:
            return None
