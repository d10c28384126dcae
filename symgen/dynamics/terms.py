"""Sums as lists of signed terms and products as lists of factors: taken apart, and put together one by one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TypeAlias

from symgen.graph.scalar import Graph, Scalar

Term: TypeAlias = tuple[int, Scalar]


def terms_of(node: Scalar, inside: Collection[Scalar]) -> list[Term]:
    """The signed terms of a sum, or the factors of a product, in their order; operands `inside` are taken apart too."""
    found = []
    stack = [(1, node)]
    while stack:
        sign, part = stack.pop()
        if part is node or part in inside:
            left, right = part.args
            stack += [(-sign if part.op == "sub" else sign, right), (sign, left)]
        else:
            found.append((sign, part))
    return found


def sum_of(graph: Graph, terms: Sequence[Term]) -> Scalar:
    """The sum of signed scalars, a positive one first if there is one."""
    start = next((place for place, (sign, _) in enumerate(terms) if sign > 0), 0)
    sign, total = terms[start]
    total = total if sign > 0 else graph.raw("neg", (total,))
    for place, (sign, term) in enumerate(terms):
        if place != start:
            total = graph.raw("add" if sign > 0 else "sub", (total, term))
    return total


def product_of(graph: Graph, factors: Sequence[Scalar]) -> Scalar:
    """The product, multiplied from the first factor on."""
    first, *others = factors
    for factor in others:
        first = graph.raw("mul", (first, factor))
    return first
