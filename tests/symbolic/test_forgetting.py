"""What passes leave behind is let go; what is needed stays, and goes on being one node for each operation."""

from __future__ import annotations

import pytest

from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.passes import forgetting as forgets
from symgen.symbolic.passes.forgetting import forgetting
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached


def left_behind(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """A scalar that is made among others that nobody needs, by the constructors and past them."""
    for power in range(2, 40):
        graph.raw("add", (x, graph.raw("mul", (y, graph.const(power)))))
        graph.function("exp", (x * power,))
    return graph.raw("mul", (x, graph.raw("add", (x, y))))


def test_what_is_needed_stays_and_the_rest_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(forgets, "FEWEST_FORGOTTEN", 10)
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    before = x + y
    mark = graph.mark()
    needed = left_behind(graph, x, y)
    most = len(graph)
    gone = forgetting(graph, mark, [needed])
    assert gone is not None
    assert len(graph) < most / 4
    assert all(node not in gone and graph.at(node.serial) is node for node in reached([needed, before]))
    # met again, what stayed is the same node, and what went is one node again
    assert graph.raw("mul", (x, graph.raw("add", (x, y)))) is needed
    assert x + y is before
    again = graph.function("exp", (x * 7,))
    assert graph.function("exp", (x * 7,)) is again
    same_values("forgetting", [again, before * x], [graph.function("exp", (7 * x,)), x * x + x * y])


def test_little_is_kept_as_it_is() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    mark = graph.mark()
    needed = left_behind(graph, x, y)
    most = len(graph)
    assert forgetting(graph, mark, [needed]) is None
    assert len(graph) == most


def test_products_of_what_went_are_taken_apart_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(forgets, "FEWEST_FORGOTTEN", 1)
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    s, c = graph.trig("sin", x), graph.trig("cos", x)
    mark = graph.mark()
    passing = (s * y) * (c * y)
    graph.products.monomial(passing)
    forgetting(graph, mark, [y])
    with pytest.raises(AssertionError, match="forgotten"):
        graph.at(passing.serial)
    assert (y * s) * (s * y) + (y * c) * (c * y) is y * y
