"""Constant expressions of the file as numbers: range ends, start values, tolerances, durations."""

from __future__ import annotations

from fractions import Fraction

from symgen.model.expressions.walk import evaluate, exact_value
from symgen.model.file.reading import items
from symgen.model.file.scope import CONSTANT, Scope
from symgen.model.file.source import Node, ScalarNode, SequenceNode
from symgen.model.model import Range


def constant(scope: Scope, node: Node | None, where: str) -> Fraction | None:
    """The value of a constant expression: exact where it is rational, else the double nearest to it."""
    expression = scope.expression(node, where, CONSTANT)
    if expression is None:
        return None
    exact = exact_value(expression)
    if exact is not None:
        return exact
    try:
        return Fraction(evaluate(expression, {}))
    except (ArithmeticError, ValueError):
        scope.wrong(f"{where} has no finite value", "write a number", node.span if node else None)
        return None


def range_of(scope: Scope, node: Node | None, where: str) -> Range | None:
    """The two ends of `[lower, upper]` as doubles, in fractions."""
    if not isinstance(node, SequenceNode) or len(node.items) != 2:
        return None
    lower, upper = (constant(scope, item, where) for item in items(node))
    if lower is None or upper is None:
        return None
    try:
        ends = Fraction(float(lower)), Fraction(float(upper))
    except OverflowError:
        scope.wrong(f"{where} is beyond the range of doubles", "choose other units", node.span)
        return None
    if ends[0] > ends[1]:
        scope.wrong(f"{where} has its lower end above its upper end", "write [lower, upper]", node.span)
        return None
    return ends


def whole_number(scope: Scope, node: Node | None, where: str, least: int, most: int) -> int | None:
    """A whole number between `least` and `most`."""
    value = constant(scope, node, where)
    if value is None or not isinstance(node, ScalarNode):
        return None
    if value.denominator != 1 or not least <= value <= most:
        scope.wrong(f"{where} is not a whole number from {least} to {most}", "write such a number", node.span)
        return None
    return int(value)
