"""A symbol that is replaced later never comes into what was made without it."""

from __future__ import annotations

from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.transplant import transplanted
from symgen.symbolic.traverse import reached, substitute


def square(graph: Graph, angle: Scalar) -> Scalar:
    """p**2, with an angle that cancels."""
    p, sine = graph.symbol("p"), graph.trig("sin", angle)
    return (p + sine) * (p - sine) + sine * sine


def symbols(node: Scalar) -> set[str]:
    return {str(n.payload) for n in reached([node]) if n.op == "symbol"}


def test_a_stand_in_that_cancels_does_not_outlast_its_replacement() -> None:
    graph = Graph()
    held = graph.stand_in("held")
    before = square(graph, held)
    assert "held" in symbols(before)
    (after,) = substitute(graph, [before], {held: graph.symbol("a")})
    assert "held" not in symbols(after)


def test_stand_ins_do_not_come_in_for_each_other() -> None:
    graph = Graph()
    made = {name: square(graph, graph.stand_in(name)) for name in ("one", "two")}
    made["plain"] = square(graph, graph.symbol("plain"))
    for name, node in made.items():
        assert symbols(node) <= {name, "p"}


def test_a_shorter_equal_function_is_still_taken() -> None:
    graph = Graph()
    p = graph.symbol("p")
    short = p * p
    assert square(graph, graph.stand_in("held")) is short


def test_a_stand_in_stays_one_on_another_graph() -> None:
    graph, other = Graph(), Graph()
    transplanted(other, [graph.stand_in("held") + graph.symbol("p")])
    assert other.symbol("held").stands != 0
