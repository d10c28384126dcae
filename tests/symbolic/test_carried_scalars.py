"""Scalars on another graph are the same functions, of the same symbols or of what stands in their place."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.transplant import transplanted
from symgen.symbolic.traverse import substitute

NAMES = "abpq"
SEEDS = range(80)


def _grown(graph: Graph, draw: random.Random, leaves: list[Scalar]) -> list[Scalar]:
    """Sums, products, quotients, sines of sums, roots and signs; the same draws from other leaves are their images."""
    scalars = [*leaves, graph.const(Fraction(3, 2)), graph.const(PI / 6)]
    angles = [*leaves]
    for _ in range(14):
        x, y = draw.choice(scalars), draw.choice(scalars)
        angle = draw.choice(angles) + draw.choice((1, -1, 2)) * draw.choice(angles)
        match draw.randrange(8):
            case 0 | 1:
                scalars.append(x + y)
            case 2 | 3:
                scalars.append(x * y)
            case 4:
                scalars.append(x - 2 * y)
            case 5:
                scalars.append(graph.trig(draw.choice(("sin", "cos")), angle))
            case 6:
                scalars.append(x / (y * y + 1))
            case _:
                scalars.append(graph.function(draw.choice(("abs", "tanh")), (x,)))
    return scalars[-6:]


@pytest.mark.parametrize("seed", SEEDS)
def test_they_are_the_same_on_another_graph(seed: int) -> None:
    graph, other = Graph(), Graph()
    outputs = _grown(graph, random.Random(seed), [graph.symbol(name) for name in NAMES])
    # what is known there already, in another order
    _grown(other, random.Random(seed + 1), [other.symbol(name) for name in reversed(NAMES)])
    carried = transplanted(other, outputs)
    assert all(scalar.graph is other for scalar in carried)
    with every_identity_evaluated():
        same_values("carrying over", outputs, carried)


@pytest.mark.parametrize("seed", SEEDS)
def test_symbols_are_what_stands_in_their_place(seed: int) -> None:
    graph, other = Graph(), Graph()
    a, b, p, q = (other.symbol(name) for name in NAMES)
    images = [-b, a * b + 1, q - p + PI / 3, other.trig("sin", a) / 2]
    symbols = [graph.symbol(name) for name in NAMES]
    given = _grown(graph, random.Random(seed), symbols)
    meant = _grown(other, random.Random(seed), images)
    with every_identity_evaluated():
        same_values("carrying over", meant, transplanted(other, given, dict(zip(NAMES, images, strict=True))))
        on_one = dict(zip(symbols, transplanted(graph, images), strict=True))
        same_values("putting in", meant, substitute(graph, given, on_one))
