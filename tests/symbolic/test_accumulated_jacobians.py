"""Jacobians accumulated node by node: those of sweeps, shorter where outputs hang on few nodes, given up where not."""

from __future__ import annotations

import random

import pytest

from symgen.symbolic.accumulation import accumulated_jacobian, shortest_jacobian
from symgen.symbolic.calculus import jacobian
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, flatten
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

NO_LIMIT = 10**9


def weight(matrix: Matrix) -> int:
    return cost(flatten(matrix)).weight


def random_outputs(graph: Graph, symbols: list[Scalar], dice: random.Random) -> list[Scalar]:
    """Functions of functions, each of two that are there already; some are symbols or numbers."""
    nodes: list[Scalar] = [*symbols, graph.const(3)]
    for _ in range(25):
        a, b = dice.choice(nodes), dice.choice(nodes)
        nodes.append(
            dice.choice(
                [a + b, a - b, a * b, a / (2 + b * b), graph.trig("sin", a), graph.function("sqrt", (1 + a * a,))]
            )
        )
    return [*nodes[-3:], symbols[0], graph.const(2), dice.choice(nodes)]


@pytest.mark.parametrize("seed", range(12))
def test_they_are_those_of_sweeps(seed: int) -> None:
    graph, dice = Graph(), random.Random(seed)
    symbols = [graph.symbol(name) for name in "abcd"]
    outputs = random_outputs(graph, symbols, dice)
    swept = jacobian(graph, outputs, symbols[:3])
    made = accumulated_jacobian(graph, outputs, symbols[:3], NO_LIMIT)
    assert made is not None
    assert [x.value for x in flatten(made)] == [x.value for x in flatten(swept)]
    assert any(not x.is_zero for x in flatten(swept))


def narrow(graph: Graph) -> tuple[list[Scalar], list[Scalar]]:
    """Six outputs that hang on one node, at the end of a chain of ten symbols."""
    symbols = [graph.symbol(f"x{k}") for k in range(10)]
    middle = graph.const(1)
    for symbol in symbols:
        middle = middle * symbol + symbol * symbol
    return [graph.power(middle, k) for k in range(2, 8)], symbols


def test_few_nodes_in_the_middle_are_gone_through_once() -> None:
    graph = Graph()
    outputs, symbols = narrow(graph)
    swept, shortest = jacobian(graph, outputs, symbols), shortest_jacobian(graph, outputs, symbols)
    # six sweeps through a chain of ten take two products a link, or one does, and a product for each entry
    assert weight(shortest) < weight(swept) - (6 * 10 * 2 - 10 * 2 - 6 * 10) / 2


def test_what_takes_more_than_sweeps_is_given_up() -> None:
    graph = Graph()
    outputs, symbols = narrow(graph)
    assert accumulated_jacobian(graph, outputs, symbols, 50) is None
    assert accumulated_jacobian(graph, outputs, symbols, NO_LIMIT) is not None


def test_sweeps_are_taken_where_they_count_less() -> None:
    """Of random functions those are, for which the order from node to node is the longer one."""
    longer = 0
    for seed in range(20):
        graph, dice = Graph(), random.Random(seed)
        symbols = [graph.symbol(name) for name in "abcd"]
        outputs = random_outputs(graph, symbols, dice)
        swept, made = jacobian(graph, outputs, symbols), accumulated_jacobian(graph, outputs, symbols, NO_LIMIT)
        assert made is not None
        assert weight(shortest_jacobian(graph, outputs, symbols)) == min(weight(swept), weight(made))
        longer += weight(made) > weight(swept)
    assert longer > 0
