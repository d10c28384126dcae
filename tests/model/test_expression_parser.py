"""The parser against Python's own reading of the same text, exact numbers, places, limits."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.parser import parse_expression
from symgen.model.expressions.walk import evaluate, exact_value
from symgen.model.file.source import MappingNode, ScalarNode, read_tree

VALUES = {"x": 0.7, "y": -1.3, "x_dot": 2.1, "m_1": 3.5}


def node(text: str) -> ScalarNode:
    """The text as a scalar that begins in column 1 of line 1."""
    return ScalarNode(text, Span(1, 1, len(text) + 1), text, False)


def parsed(text: str) -> Expression:
    """The tree of a good expression."""
    tree = parse_expression(node(text))
    assert not isinstance(tree, Mistake), tree
    return tree


def expressions() -> st.SearchStrategy[str]:
    """Texts that mean the same to Python and to the model language."""
    leaf = st.sampled_from(["x", "y", "x_dot", "m_1", "2", "0.5", "1e-1", "3.", ".25", "pi"])
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from([" + ", "-", "*", " / "]), inner).map("".join),
            inner.map(lambda text: f"({text})"),
            inner.map(lambda text: f"-{text}"),
            inner.map(lambda text: f"({text})**2"),
            inner.map(lambda text: f"-({text})**-1"),
            inner.map(lambda text: f"sin({text})"),
            st.tuples(inner, inner).map(lambda pair: f"atan2({pair[0]}, {pair[1]})"),
        ),
        max_leaves=12,
    )


@settings(max_examples=300, deadline=None)
@given(expressions())
def test_means_what_python_means(text: str) -> None:
    names = {**VALUES, "pi": math.pi, "sin": math.sin, "atan2": math.atan2}
    try:
        expected = eval(text, {"__builtins__": {}}, names)
    except (ArithmeticError, ValueError):
        with pytest.raises((ArithmeticError, ValueError)):
            evaluate(parsed(text), VALUES)
        return
    if math.isfinite(expected):
        assert evaluate(parsed(text), VALUES) == pytest.approx(expected, rel=1e-12, abs=1e-300)


def test_precedence() -> None:
    x, two = Name("x"), Number(Fraction(2))
    assert parsed("-x**2") == Negation(Power(x, Fraction(2)))
    assert parsed("x - 2 - x") == Binary("-", Binary("-", x, two), x)
    assert parsed("x/2*x") == Binary("*", Binary("/", x, two), x)
    assert parsed("2*-x") == Binary("*", two, Negation(x))
    assert parsed("x**2**3") == Power(x, Fraction(8))
    assert parsed("x**-(1/2)") == Power(x, Fraction(-1, 2))
    assert parsed("x**0.25") == Power(x, Fraction(1, 4))
    assert parsed("x**1") == x
    assert parsed("+x") == x
    assert parsed("atan2(x, pi)") == Call("atan2", (x, Pi()))


@pytest.mark.parametrize(
    ("text", "value"),
    [("0.1", Fraction(1, 10)), ("1e-3", Fraction(1, 1000)), ("12.50E2", Fraction(1250)), (".5", Fraction(1, 2))],
)
def test_numbers_are_exact(text: str, value: Fraction) -> None:
    assert parsed(text) == Number(value)


def test_exact_value() -> None:
    assert exact_value(parsed("-(1/3 + 0.1)*2**-2")) == -Fraction(13, 120)
    assert exact_value(parsed("pi")) is None
    assert exact_value(parsed("1/0")) is None


def scalar(text: str) -> ScalarNode:
    """The value of the key `k` of a document."""
    tree, mistakes = read_tree(text)
    assert not mistakes
    assert isinstance(tree, MappingNode)
    value = tree.get("k")
    assert isinstance(value, ScalarNode)
    return value


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [
        ("k: a + wrong", 1, 8),
        ("k: 'a + wrong'", 1, 9),
        ('k: "a + wrong"', 1, 9),
        ("k: {}\n".replace("{}", "a\n   + wrong"), 2, 6),
        ("k: >-\n  a\n  + wrong\n", 3, 5),
        ("k: |\n    a\n\n    + wrong\n", 4, 7),
        ('k: "a\n  + wrong"', 2, 5),
    ],
)
def test_places_survive_quoting_and_folding(text: str, line: int, column: int) -> None:
    tree = parse_expression(scalar(text))
    assert isinstance(tree, Binary)
    assert tree.right.span == Span(line, column, column + 5)


@pytest.mark.parametrize("text", ["(" * 60 + "x" + ")" * 60, "+".join(["x"] * 200), "x**64", "1" * 40])
def test_within_the_limits(text: str) -> None:
    parsed(text)


@pytest.mark.parametrize("text", ["(" * 61 + "x" + ")" * 61, "+".join(["x"] * 202), "x**65", "1" * 41, "x**(1/13)"])
def test_beyond_the_limits(text: str) -> None:
    assert isinstance(parse_expression(node(text)), Mistake)


@settings(max_examples=300, deadline=None)
@given(st.text(max_size=40))
def test_no_text_breaks_the_parser(text: str) -> None:
    result = parse_expression(node(text))
    assert result is not None
