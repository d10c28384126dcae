"""Functions of scalars that are simpler, exactly: powers, roots of squares, magnitudes, quotients by numbers."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from symgen.symbolic.graph import Graph
    from symgen.symbolic.scalar import Scalar


def simplified(graph: Graph, name: str, args: tuple[Scalar, ...]) -> Scalar | None:
    """What a function of these scalars is in fewer operations; None where it is what it is."""
    first = args[0]
    if name == "sqrt":
        if (value := first.constant) is not None and value >= 0:
            top, bottom = isqrt(value.numerator), isqrt(value.denominator)
            if top * top == value.numerator and bottom * bottom == value.denominator:
                return graph.const(Fraction(top, bottom))
        if first.op == "mul" and first.args[0] is first.args[1]:
            return graph.function("abs", (first.args[0],))
    if name == "abs":
        if first.op in ("neg", "abs"):
            return graph.function("abs", first.args)
        if first.op == "sqrt" or (first.op == "mul" and first.args[0] is first.args[1]):
            return first
        if (value := first.constant) is not None:
            return graph.const(abs(value))
    if name == "ratio_or_zero":
        if first.is_zero or args[1].is_zero:
            return graph.zero
        if args[1].constant is not None:
            return graph.div(first, args[1])
    return None


def expanded(graph: Graph, base: Scalar, exponent: Fraction) -> Scalar | None:
    """A power by products, a quotient and a square root; None where these do not make it."""
    if exponent < 0:
        return graph.div(graph.one, graph.power(base, -exponent))
    if exponent.denominator == 1:
        result, square, count = graph.one, base, exponent.numerator
        while count:
            if count & 1:
                result = graph.mul(result, square)
            count >>= 1
            if count:
                square = graph.mul(square, square)
        return result
    if exponent.denominator == 2:
        whole = exponent.numerator // 2
        return graph.mul(graph.power(base, Fraction(whole)), graph.function("sqrt", (base,)))
    return None
