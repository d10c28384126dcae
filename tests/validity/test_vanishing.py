"""What vanishes with others is found upwards from them: in products, sums, roots, quotients and sines of sums."""

from __future__ import annotations

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.validity.vanishing import Vanishing


def vanishes(zeros: list[Scalar], asked: Scalar) -> bool:
    known = Vanishing()
    known.add(asked)
    return known.any_where(zeros, [asked])


def test_products_sums_roots_and_quotients() -> None:
    graph = Graph()
    x, y, z = (graph.symbol(name) for name in "xyz")
    assert vanishes([x], x * y)
    assert vanishes([x], graph.function("sqrt", (x * y + x * z,)) / z)
    assert vanishes([x, y], x * z + y)
    assert not vanishes([x], x * z + y)
    assert not vanishes([x], z / x)
    assert not vanishes([x], graph.function("exp", (x,)))
    assert vanishes([x - y], (y - x) * z)
    assert vanishes([x], graph.raw("mul", (z, graph.raw("mul", (y, x)))))


def test_sines_of_sums_and_differences() -> None:
    graph = Graph()
    a, b, k = (graph.symbol(name) for name in "abk")
    first, second = graph.trig("sin", a), graph.trig("sin", b)
    for angle in (a + b, a - b, b - a):
        assert vanishes([first, second], k * graph.trig("sin", angle))
        assert not vanishes([first], k * graph.trig("sin", angle))
    assert not vanishes([first, second], graph.trig("sin", a + 2 * b))


def test_what_is_added_later_shares_what_is_known() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    known = Vanishing()
    known.add(x * y)
    later = x * y * x + y
    known.add(later)
    assert known.any_where([y], [later])
    assert not known.any_where([x], [later])
    assert known.any_where([x], [later, x * y])
