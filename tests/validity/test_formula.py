"""Scalars as text: read back they are the same functions."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.source import ScalarNode
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.validity.formula import formula, quoted


def _tree(text: str) -> Expression:
    tree = parse_expression(ScalarNode(text, Span(1, 1, 1), text, quoted=False))
    assert not isinstance(tree, Mistake)
    return tree


def _scalar(graph: Graph, text: str) -> Scalar:
    return translate(graph, _tree(text), {name: graph.symbol(name) for name in ("x", "y", "z")})


@pytest.mark.parametrize(
    "text",
    ["x - (y - z)", "x/(y/z)*(1/3)", "(x - y)**2*sin(x + 2*pi/3)", "-(x + y)*z", "(x*y)/(z - 3/7)", "0.1*x - pi"],
)
def test_what_is_written_is_the_same_function(text: str) -> None:
    graph = Graph()
    once = _scalar(graph, text)
    again = _scalar(Graph(), formula(once))
    assert ExactValues()([once]) == ExactValues()([again])


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("x*y - 4*pi/3", "x*y - 4*pi/3"),
        ("x*pi", "pi*x"),
        ("x*(-pi/2)", "-(pi/2)*x"),
        ("x/3", "(1/3)*x"),
        ("y/(x - 1/3)", "y/(x - 1/3)"),
    ],
)
def test_numbers_are_as_people_write_them(text: str, written: str) -> None:
    assert formula(_scalar(Graph(), text)) == written


def test_a_number_of_many_digits_is_a_decimal() -> None:
    graph = Graph()
    x = graph.symbol("x")
    assert formula(x * graph.const(Fraction("0.12345678901234567890"))) == "0.123456789*x"


def test_words_are_not_quoted_as_formulas_are() -> None:
    graph = Graph()
    long = graph.symbol("x")
    for k in range(40):
        long = long * (long + graph.const(k + 1))
    assert quoted(formula(long)) == formula(long)
    assert quoted(formula(graph.symbol("x") + graph.symbol("y"))) == "`x + y`"
