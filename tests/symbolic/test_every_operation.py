"""Whatever a kernel may contain can be evaluated, bounded, rebuilt and differentiated."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import get_args

import pytest

from symgen.ir.kernel import OperationName
from symgen.ir.pairs.wide_functions import WIDE
from symgen.linear_algebra.guards import magnitude
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.evaluate import FUNCTIONS, Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import rebuild

POINT = {"x": 0.37, "y": 0.82}
TWO = {"add", "sub", "mul", "div", "copysign", "ratio_or_zero", "min", "max", "atan2"}
STEP = 1e-6


def operations() -> list[str]:
    """Those of kernels, and those of graphs that are no statements."""
    plain = set(get_args(OperationName)) - set(WIDE.values())
    kernels = {name for op in plain for name in (("sin", "cos") if op == "sincos" else (op,))}
    return sorted(kernels | set(FUNCTIONS))


def made(graph: Graph, op: str) -> Scalar:
    x, y = graph.symbol("x"), graph.symbol("y")
    if op == "pow":
        return graph.power(x, Fraction(2, 3))
    if op == "neg":
        return graph.neg(x)
    node = graph.raw(op, (x, y) if op in TWO else (x,))
    assert node.op == op
    return node


def value(node: Scalar, **moved: float) -> float:
    return Evaluator([node])({**POINT, **moved})[0]


@pytest.mark.parametrize("op", operations())
def test_its_derivatives_are_those_of_small_differences(op: str) -> None:
    graph = Graph()
    node = made(graph, op)
    for name in ("x", "y"):
        expected = value(node, **{name: POINT[name] + STEP}) - value(node, **{name: POINT[name] - STEP})
        (forward,) = derivative_along(graph, [node], {graph.symbol(name): graph.one})
        (backward,) = gradient(graph, node, [graph.symbol(name)])
        for derivative in (forward, backward):
            assert value(derivative) == pytest.approx(expected / (2 * STEP), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("op", operations())
def test_it_is_rebuilt_as_itself_and_bounded(op: str) -> None:
    graph = Graph()
    node = made(graph, op)
    again = rebuild(graph, node, node.args)
    assert value(again) == value(node)
    assert value(magnitude(graph, [node])[0]) >= abs(value(node))


def test_a_ratio_stands_still_where_it_is_set_to_zero() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    ratio = graph.function("ratio_or_zero", (x, y))
    slopes = Evaluator(gradient(graph, ratio * ratio, [x, y]))
    assert slopes({"x": 3.0, "y": 0.0}) == [0.0, 0.0]
    assert slopes({"x": 3.0, "y": 2.0}) == pytest.approx([1.5, -2.25])
    assert all(map(math.isfinite, slopes({"x": 0.0, "y": 0.0})))


@pytest.mark.parametrize("place", [-800.0, -30.0, -2.5, 0.0, 2.5, 18.0, 30.0, 800.0])
def test_the_slope_of_tanh_keeps_its_digits(place: float) -> None:
    graph = Graph()
    (slope,) = gradient(graph, made(graph, "tanh"), [graph.symbol("x")])
    (curve,) = gradient(graph, slope, [graph.symbol("x")])
    # in powers of e^(-2|x|), which do not overflow
    small = math.exp(-2 * abs(place))
    expected = 4 * small / (1 + small) ** 2
    assert value(slope, x=place) == pytest.approx(expected, rel=1e-13)
    assert value(curve, x=place) == pytest.approx(-2 * math.tanh(place) * expected, rel=1e-13)
