"""A symbol that is replaced later never comes into what was made without it."""

from __future__ import annotations

import pytest

from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
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


CART = """
model: cart
coordinates: {x: {unit: m}, y: {unit: m}}
parameters: {m: {value: 2}}
kinetic_energy: 1/2*m*(x_dot**2 + y_dot**2)
constraints:
  geometric:
    row: x - y
inputs:
  F: {acts_on: {x: 1}}
outputs: [actuator_bias]
"""


@pytest.mark.parametrize("given", ["qd", "qdd", "u"])
def test_what_only_some_kernels_are_given_does_not_come_into_those_of_others(given: str) -> None:
    system = System(load_text(CART, "cart.yaml"))
    argument = getattr(system, given)[0]
    written = square(system.graph, argument)
    assert str(argument.payload) in symbols(written)
    # the same function, as long
    assert symbols(square(system.graph, system.q[0])) <= {"p", "x"}
