"""Ways towards zeros in double precision: 40 digits go on from where they end, if that is close, and only then."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.runtime.effort import done
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.validity.search import ZeroSearch

TEXT = """
model: turning
parameters: {far: {value: 1e8}}
coordinates: {a: {unit: rad}, b: {unit: rad}}
kinetic_energy: a_dot**2 + b_dot**2
inputs: {u: {acts_on: {a: 1}}}
"""


@pytest.fixture
def mechanics() -> System:
    return System(load_text(TEXT, "turning.yaml"))


def search(mechanics: System) -> ZeroSearch:
    return ZeroSearch(mechanics, genericity(mechanics))


def test_a_zero_is_reached_where_double_precision_loses_half_of_the_digits(mechanics: System) -> None:
    """Measured from a hundred million away there are multiples of 1.5e-8, none of them within 5e-9 of 0.6."""
    graph = mechanics.graph
    far, sine = graph.symbol("far"), graph.trig("sin", graph.symbol("b"))
    measured = graph.raw("sub", (graph.raw("add", (far, sine)), far))
    assert abs(round(0.6 / math.ulp(1e8)) * math.ulp(1e8) - 0.6) > 5e-9
    zero = search(mechanics).zero_of(measured - Fraction(3, 5))
    assert zero is not None
    assert math.sin(dict(zero.point)["b"]) == pytest.approx(0.6, abs=1e-11)


def test_forty_digits_do_not_go_on_from_where_seven_say_that_there_is_no_zero(mechanics: System) -> None:
    """Smallest values of a few hundred millionths take as little work as those of a thousandth."""

    def work(least: Fraction) -> int:
        before = done()
        assert search(mechanics).zero_of(above_zero(mechanics.graph, least)) is None
        return done() - before

    assert work(Fraction(3, 10**8)) < 2 * work(Fraction(1, 1000))


def above_zero(graph: Graph, least: Fraction) -> Scalar:
    """A scalar of which this is the smallest value."""
    a, b = (graph.trig("cos", graph.symbol(name)) for name in "ab")
    return 1 + least + a * b
