"""Distances from places, which stay whole where they are multiplied with each other."""

from __future__ import annotations

from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.scalar import Scalar


def shortened(graph: Graph, output: Scalar) -> Scalar:
    coordinates = [graph.symbol(name) for name in "xyz"]
    (shorter,) = Factoring(graph, [graph.symbol("a")], coordinates).shorten([output])
    return shorter


def test_squares_stay_whole_and_signs_and_multiples_are_one_atom() -> None:
    graph = Graph()
    x, y, z, a = (graph.symbol(name) for name in "xyza")
    far = x - y
    total = far * far + (z - a) * (z - a)
    assert shortened(graph, total) is total
    twice = 2 * far * (x - y) + (a - z) * (2 * a - 2 * z)
    assert shortened(graph, twice) is 2 * (far * far) + 2 * ((z - a) * (z - a))
    assert shortened(graph, far * far + far * (y - x)).is_zero


def test_single_factors_are_multiplied_out() -> None:
    graph = Graph()
    x, z, a = (graph.symbol(name) for name in "xza")
    assert shortened(graph, z * (x - a) - z * x) is shortened(graph, -(z * a))


def test_what_cancels_between_differences_cancels() -> None:
    graph = Graph()
    x, y, a = (graph.symbol(name) for name in "xya")
    assert shortened(graph, (x - y) * (x + y) - x * x + y * y).is_zero
    assert shortened(graph, (x - a) * (x + a) - x * x) is shortened(graph, -(a * a))
