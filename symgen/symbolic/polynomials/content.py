"""The numbers that divide every term of a scalar, and the scalar without them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from fractions import Fraction

from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.scalar import Scalar

# Sums nested in each other up to which a common number is looked for; deeper ones are taken as they stand.
DEEPEST = 12


def usual_number(values: Iterable[Scalar]) -> Fraction:
    """The positive number that all terms of a value are multiplied by, for most of the values."""
    counts = Counter(_number(value, DEEPEST) for value in values)
    return min(counts, key=lambda number: (-counts[number], number), default=Fraction(1))


def divided(graph: Graph, value: Scalar, number: Fraction) -> Scalar:
    """value / number, taken out of the terms that hold it instead of divided by."""
    if number == 1:
        return value
    quotient = _divided(graph, value, number, DEEPEST)
    same_values("dividing by a number", [graph.raw("mul", (value, graph.const(1 / number)))], [quotient])
    return quotient


def _number(value: Scalar, depth: int) -> Fraction:
    if value.constant is not None:
        return abs(value.constant)
    if not depth:
        return Fraction(1)
    if value.op == "neg":
        return _number(value.args[0], depth)
    if value.op == "mul":
        return _number(value.args[0], depth - 1) * _number(value.args[1], depth - 1)
    if value.op in ("add", "sub"):
        left, right = (_number(part, depth - 1) for part in value.args)
        return left if left == right else Fraction(1)
    return Fraction(1)


def _divided(graph: Graph, value: Scalar, number: Fraction, depth: int) -> Scalar:
    if number == 1:
        return value
    if value.op == "neg":
        return -_divided(graph, value.args[0], number, depth)
    # where one term holds the number, the other takes what would stand before the sum
    if value.op in ("add", "sub") and depth and any(_number(part, depth - 1) == number for part in value.args):
        left, right = (_divided(graph, part, number, depth - 1) for part in value.args)
        return left + right if value.op == "add" else left - right
    if value.op == "mul" and depth:
        for part, other in (value.args, value.args[::-1]):
            if _number(part, depth - 1) == number:
                return _divided(graph, part, number, depth - 1) * other
    return value * (1 / number)
