"""Families tell in no time which sums of two products cannot be combined: they rule out none that can."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import combinations

import pytest

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

FACTORS_OF_A_LONG_PRODUCT = 3000


def drawn_products(graph: Graph, source: random.Random, count: int) -> list[Scalar]:
    """Products of few factors, so that many are the same but for numbers, signs, sines and cosines."""
    a, b, m, k = (graph.symbol(name) for name in "abmk")
    turned = [graph.trig(name, angle) for name in ("sin", "cos") for angle in (a, b)]
    sums = [m + k * a, -(m + k * a), 1 + turned[0] * m, graph.function("sqrt", (1 + m * m,))]
    factors = [*turned, m, k, *sums]
    made = []
    for _ in range(count):
        one = graph.const(Fraction(source.choice((-3, -1, 1, 2)), source.choice((1, 2))))
        for _ in range(source.randint(1, 3)):
            factor = source.choice(factors)
            one = one / factor if source.random() < 0.2 else one * factor
        made.append(one)
    return made


@pytest.mark.parametrize("seed", range(8))
def test_products_of_other_families_do_not_combine(seed: int) -> None:
    """With the same family for all, which has everything taken apart, as much is combined as with their own."""
    graph, source = Graph(), random.Random(seed)
    products = list(dict.fromkeys(drawn_products(graph, source, 200)))
    combined = 0
    for a, b in combinations(products, 2):
        for sign in (1, -1):
            own = a.family, b.family
            a.family = b.family = 1
            made = graph.products.combined(a, b, sign)
            a.family, b.family = own
            if made is not None:
                combined += 1
                assert a.family == b.family
    assert combined > 20


def test_products_of_one_family_are_few() -> None:
    """Different factors make different families."""
    graph = Graph()
    symbols = [graph.symbol(f"x_{k}") for k in range(40)]
    assert len({(a * b).family for a, b in combinations(symbols, 2)}) == 40 * 39 // 2


def test_deep_products_are_taken_apart() -> None:
    """One factor after the other, deeper than Python calls functions."""
    graph = Graph()
    product = other = graph.one
    for k in range(FACTORS_OF_A_LONG_PRODUCT):
        factor = graph.symbol(f"x_{k}")
        product, other = product * factor, factor * other
    product, other = 2 * product, 3 * other
    assert (product - other).value == (graph.const(-1) * product / 2).value
    assert len(graph.products.monomial(product)[1]) >= 1
