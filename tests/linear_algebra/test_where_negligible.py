"""What tells causes apart, where the test that failed says that squares are 0: shorter, and equal there."""

from __future__ import annotations

from math import cos, pi, sin

import pytest

from symgen.linear_algebra.guards import where_negligible
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, reached


def sums(graph: Graph) -> tuple[Scalar, Scalar]:
    """The sum of the squares of two sines and a product, and a sum of squares with their factors."""
    a, b, length, x = (graph.symbol(name) for name in ("a", "b", "length", "x"))
    sines = [graph.function("sin", (angle,)) for angle in (a, b)]
    cosine = graph.function("cos", (a,))
    roots = [*sines, length * x]
    total = graph.zero
    for root in roots:
        total = total + root * root
    terms = [
        length * cosine * x * sines[1],
        length * cosine * graph.function("sin", (x,)),
        sines[0] * cosine - length * length * cosine,
    ]
    value = graph.zero
    for term in terms:
        value = value + term * term
    return total, value


@pytest.mark.parametrize("half_turns", [(0, 0), (1, 0), (1, 1)])
def test_values_are_equal_where_the_sum_of_squares_is_zero(half_turns: tuple[int, int]) -> None:
    graph = Graph()
    total, value = sums(graph)
    (short,) = where_negligible(graph, total, [value])
    assert cost([short]).weight < cost([value]).weight
    assert not {"cos"} & {node.op for node in reached([short])}
    point = {"a": half_turns[0] * pi, "b": half_turns[1] * pi, "length": 0.7, "x": 0.0}
    assert list(Evaluator([short])(point)) == pytest.approx(list(Evaluator([value])(point)), abs=1e-14)


def test_a_cosine_whose_sign_matters_stays() -> None:
    graph = Graph()
    a, x = graph.symbol("a"), graph.symbol("x")
    sine, cosine = graph.function("sin", (a,)), graph.function("cos", (a,))
    (reduced,) = where_negligible(graph, sine * sine, [(cosine + x) * (cosine + x) + sine * x])
    assert "cos" in {node.op for node in reached([reduced])}
    assert "sin" not in {node.op for node in reached([reduced])}
    for angle in (0.0, pi):
        (value,) = Evaluator([reduced])({"a": angle, "x": 0.4})
        assert value == pytest.approx((cos(angle) + 0.4) ** 2 + sin(angle) * 0.4)


def test_only_sums_of_squares_say_that_something_is_zero() -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    value = a * b + b
    assert where_negligible(graph, a * a + b, [value]) == [value]
    assert where_negligible(graph, a * a - b * b, [value]) == [value]
    assert where_negligible(graph, a * a, [value]) == [b]


def test_quotients_stay_since_their_divisor_might_vanish() -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    value = b / (a * a + b * a)
    assert where_negligible(graph, a * a, [value]) == [value]
