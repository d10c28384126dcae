"""Lengths that have no sign: radii of wheels, rods, springs between points."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import evaluate
from symgen.model.file.scope import Scope
from symgen.model.file.source import Node


def check_length(
    scope: Scope,
    node: Node | None,
    length: Expression | None,
    defaults: Mapping[str, float],
    what: str,
    remedy: str,
    or_zero: bool = False,
) -> None:
    """A mistake where the default value of a length is negative; where it is 0, too, unless that is a length here."""
    if node is None or length is None:
        return
    try:
        value = evaluate(length, defaults)
    except (ArithmeticError, ValueError, KeyError):
        return  # which is told elsewhere
    if value < 0:
        scope.wrong(f"{what} is {value:.6g}: it has no sign", remedy, node.span)
    elif value == 0 and not or_zero:
        scope.wrong(f"{what} is 0", remedy, node.span)
