"""Sines and cosines that are the same on every machine: accuracy, and no library behind them."""

from __future__ import annotations

import math
import random

import pytest
from flint import arb, ctx

from symgen.symbolic.angles.sines import PARTS, cosine, sine
from symgen.symbolic.evaluate import FUNCTIONS, Evaluator
from symgen.symbolic.graph import Graph


@pytest.mark.parametrize("largest", [1e-3, 7.0, 1e5])
def test_they_are_accurate(largest: float) -> None:
    source = random.Random(1)
    worst = 0.0
    with ctx.workprec(200):
        for _ in range(3000):
            angle = source.uniform(-largest, largest)
            for value, exact in ((sine(angle), arb(angle).sin()), (cosine(angle), arb(angle).cos())):
                worst = max(worst, abs(float(arb(value) - exact)) / math.ulp(float(exact)))
    assert 0.3 < worst < 2.5


def test_products_of_the_parts_of_half_a_turn_are_exact() -> None:
    for part in PARTS[:2]:
        assert (part.as_integer_ratio()[0]).bit_length() <= 33
    with ctx.workprec(200):
        assert abs(float(sum(map(arb, PARTS), arb(0)) - arb.pi() / 2)) < 1e-36


def test_whole_quarters_and_signs() -> None:
    assert (sine(0.0), cosine(0.0)) == (0.0, 1.0)
    for angle in (0.3, 1.2, 2.0, 4.0, 100.0):
        assert (sine(-angle), cosine(-angle)) == (-sine(angle), cosine(angle))


def test_numbers_at_generation_time_come_from_them() -> None:
    assert (FUNCTIONS["sin"], FUNCTIONS["cos"]) == (sine, cosine)
    graph = Graph()
    angle = graph.symbol("a")
    outputs = [graph.function("sin", (angle,)), graph.function("cos", (angle,))]
    assert Evaluator(outputs)({"a": 0.5}) == [sine(0.5), cosine(0.5)]
    assert all(math.isnan(value) for value in Evaluator(outputs)({"a": math.inf}))
