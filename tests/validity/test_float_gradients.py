"""The slopes that searches follow in double precision, against those in 40 digits."""

from __future__ import annotations

import pytest

from symgen.symbolic.graph import Graph
from symgen.validity.floats import FloatGradients
from symgen.validity.precise import PreciseEvaluator, precise


def test_values_and_slopes_are_those_in_40_digits() -> None:
    graph = Graph()
    x, y, p = (graph.symbol(name) for name in ("x", "y", "p"))
    sine, cosine = graph.trig("sin", x), graph.trig("cos", x + y)
    root = graph.function("sqrt", (x * x + y * y,))
    other = graph.function("exp", (p * x,)) - graph.function("log", (y,)) + graph.function("tan", (y,))
    outputs = [
        sine * cosine / root,
        other * sine,
        graph.function("copysign", (root, x)) - graph.function("abs", (x * p,)),
        graph.function("ratio_or_zero", (y, x - p)),
        p * p,
    ]
    point = {"x": 0.7, "y": 0.4, "p": -1.3}
    values_and_rows = FloatGradients(outputs, ("x", "y"))(point)
    assert values_and_rows is not None
    values, rows = values_and_rows
    exact, slopes = PreciseEvaluator(outputs).gradients({k: precise(v) for k, v in point.items()}, ("x", "y"))
    assert values == pytest.approx([float(value) for value in exact], rel=1e-13)
    for row, wanted in zip(rows, slopes, strict=True):
        assert [row.get(j, 0.0) for j in range(2)] == pytest.approx([float(s) for s in wanted], rel=1e-12, abs=1e-15)
    assert rows[-1] == {}


def test_where_a_function_has_no_value_there_are_none() -> None:
    graph = Graph()
    x = graph.symbol("x")
    evaluate = FloatGradients([graph.function("log", (x,))], ("x",))
    assert evaluate({"x": -1.0}) is None
    assert evaluate({"x": 2.0}) is not None
