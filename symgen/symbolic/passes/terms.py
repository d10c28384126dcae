"""Sums as lists of signed terms and products as lists of factors: taken apart, and put together one by one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from itertools import combinations
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

Term: TypeAlias = tuple[int, Scalar]
SUMS = frozenset({"add", "sub"})
# Terms of a sum up to which common factors are looked for in it.
MOST_FACTORED_TERMS = 64


def terms_of(node: Scalar, inside: Collection[Scalar]) -> list[Term]:
    """The signed terms of a sum, or the factors of a product, in their order; operands `inside` are taken apart too."""
    terms = []
    stack = [(1, node)]
    while stack:
        sign, part = stack.pop()
        if part is node or part in inside:
            left, right = part.args
            stack += [(-sign if part.op == "sub" else sign, right), (sign, left)]
        else:
            terms.append((sign, part))
    return terms


def without_opposites(terms: Sequence[Term], uses: Mapping[Scalar, int]) -> list[Term]:
    """The terms without what is added and taken off again, which takes digits of the rest with it: (a + b) - b is a.

    Two sums among them are taken apart for that where no additions come of it: `uses` tells what is needed elsewhere.
    """
    parts = [_added_up(node) or [(1, node)] for _, node in terms]
    signed = [[(sign * own, part) for own, part in inner] for (sign, _), inner in zip(terms, parts, strict=True)]
    sets = [frozenset(inner) for inner in signed]
    for first, second in combinations(range(len(terms)), 2):
        if all((-sign, part) not in sets[second] for sign, part in sets[first]):
            continue
        left = _less_opposites([*signed[first], *signed[second]])
        alone = sum(len(parts[k]) - 1 for k in (first, second) if uses.get(terms[k][1], 0) < 2)
        rest = [term for place, term in enumerate(terms) if place not in (first, second)]
        if (left or rest) and len(left) <= alone + 2:
            return without_opposites([*rest, *left], uses)
    return list(terms)


def _less_opposites(terms: Sequence[Term]) -> list[Term]:
    """The terms without pairs a, -a, in their order."""
    counts = Counter(terms)
    left = {term: max(0, count - counts[-term[0], term[1]]) for term, count in counts.items()}
    kept: list[Term] = []
    for term in terms:
        if left[term] > 0:
            left[term] -= 1
            kept.append(term)
    return kept


def _added_up(node: Scalar) -> list[Term]:
    """The terms of a sum and of the sums that it adds up; none for what is no sum."""
    terms: list[Term] = []
    stack = [(1, node)] if node.op in SUMS else []
    while stack and len(terms) + len(stack) <= MOST_FACTORED_TERMS:
        sign, part = stack.pop()
        if part.op in SUMS:
            left, right = part.args
            stack += [(-sign if part.op == "sub" else sign, right), (sign, left)]
        else:
            terms.append((sign, part))
    return [] if stack else terms


def sum_of(graph: Graph, terms: Sequence[Term]) -> Scalar:
    """The sum of signed scalars, a positive one first; where there is none, the opposite of the sum of all."""
    start = next((place for place, (sign, _) in enumerate(terms) if sign > 0), None)
    if start is None:
        return graph.raw("neg", (sum_of(graph, [(1, term) for _, term in terms]),))
    total = terms[start][1]
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
