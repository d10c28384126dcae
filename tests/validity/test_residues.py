"""Quotients of scalars that depend on parameters only, as powers of these."""

from __future__ import annotations

import pytest

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.validity.residues import Residues


def _of_power(graph: Graph, power: int) -> tuple[Scalar, Scalar]:
    """l^power (x + sin y), and what it is a multiple of."""
    length, plain = graph.symbol("l"), graph.symbol("x") + graph.trig("sin", graph.symbol("y"))
    return graph.product([*[length] * power, plain]), 3 * plain


@pytest.mark.parametrize(("power", "known"), [(1, True), (16, True), (17, False)])
def test_powers_of_a_length_up_to_the_sixteenth_are_no_coordinates(power: int, known: bool) -> None:
    """As far as determinants of sixteen rows go, each times the length."""
    graph = Graph()
    scaled, plain = _of_power(graph, power)
    for pair in ((scaled, plain), (plain, scaled)):
        assert Residues(["l"]).proportional(*pair, (1, 1), {"l"}.__contains__) is known


def test_a_factor_that_may_vanish_is_none() -> None:
    graph = Graph()
    scaled, plain = _of_power(graph, 2)
    assert not Residues(["l"]).proportional(scaled, plain, (1, 1), set[str]().__contains__)
    assert not Residues(["l"]).proportional(plain * graph.symbol("x"), plain, (1, 1), {"l"}.__contains__)
    # a number is a factor, a sum of parameters is not
    assert Residues(["l"]).proportional(5 * plain, plain, (1, 1), set[str]().__contains__)
    assert not Residues(["l"]).proportional(plain * (graph.symbol("l") + 1), plain, (1, 1), {"l"}.__contains__)
    # powers of the two sides
    length = graph.symbol("l")
    assert Residues(["l"]).proportional(length * plain * plain, plain, (1, 2), {"l"}.__contains__)
