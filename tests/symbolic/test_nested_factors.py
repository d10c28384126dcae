"""Factors of determinants of blocks: where one of them is 0 the determinant is, and the other way round."""

from __future__ import annotations

import random

import pytest

from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.polynomials.nested_factors import nested_factors
from symgen.symbolic.scalar import Scalar

LETTERS = "abcdefgh"


def _fixed(scalar: Scalar) -> bool:
    return str(scalar.payload) in "ef"


def _values(outputs: list[Scalar]) -> list[float]:
    source = random.Random(5)
    return Evaluator(outputs)({name: source.uniform(0.5, 2) for name in LETTERS})


def test_blocks_in_a_row_are_told_apart() -> None:
    graph = Graph()
    a, b, c, d, e, f, g, h = map(graph.symbol, LETTERS)
    inner = a * b - c * d
    middle = g * (h * inner) - b * (c * inner)
    outer = (e * a) * (d * middle) - (e * f) * (middle * g)
    factors = nested_factors(outer, _fixed)
    # the fixed factor belongs to the first of the others
    assert factors == (e * inner, g * h - b * c, a * d - f * g)
    first, second, third, whole = _values([*factors, outer])
    assert abs(first * second * third / whole - 1) < 1e-13


def test_what_is_no_product_stays_whole() -> None:
    graph = Graph()
    a, b, c, d, e, *_ = map(graph.symbol, LETTERS)
    for scalar in (a * b - c * d, e * (a - b), (a * b) / (c - d), a):
        assert nested_factors(scalar, _fixed) == (scalar,)


@pytest.mark.campaign
def test_long_sums_are_no_deep_recursion() -> None:
    graph = Graph()
    a, b, *_ = map(graph.symbol, LETTERS)
    total = a * graph.symbol("x")
    for k in range(3000):
        total = graph.raw("add", (total, graph.raw("mul", (a, graph.symbol(f"x_{k}")))))
    assert nested_factors(b * total, _fixed)[:2] == (b, a)
