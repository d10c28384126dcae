"""Every node of the expression tree means in CasADi what it means in the math module."""

from __future__ import annotations

import math
from fractions import Fraction

import casadi
import pytest

from symgen.model.expressions.expression import (
    FUNCTION_ARITY,
    Binary,
    Call,
    Expression,
    FunctionName,
    Name,
    Negation,
    Number,
    Pi,
    Power,
)
from symgen.model.model import Definition
from symgen.witness.translate import translate, with_definitions

X, Y = 0.3, -0.7


def value(expression: Expression) -> float:
    return float(casadi.evalf(translate(expression, {"x": casadi.SX(X), "y": casadi.SX(Y)})))


@pytest.mark.parametrize("function", FUNCTION_ARITY)
def test_functions(function: FunctionName) -> None:
    names = ("x", "y")[: FUNCTION_ARITY[function]]
    call = Call(function, tuple(Name(name) for name in names))
    assert value(call) == pytest.approx(getattr(math, function)(*(X, Y)[: len(names)]), rel=1e-15)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (Number(Fraction(1, 3)), 1 / 3),
        (Pi(), math.pi),
        (Negation(Name("x")), -X),
        (Binary("+", Name("x"), Name("y")), X + Y),
        (Binary("-", Name("x"), Name("y")), X - Y),
        (Binary("*", Name("x"), Name("y")), X * Y),
        (Binary("/", Name("x"), Name("y")), X / Y),
        (Power(Name("y"), Fraction(3)), Y**3),
        (Power(Name("y"), Fraction(-2)), Y**-2),
        (Power(Name("x"), Fraction(1, 2)), math.sqrt(X)),
        (Power(Name("x"), Fraction(-3, 2)), X**-1.5),
        (Power(Name("x"), Fraction(1, 3)), X ** (1 / 3)),
    ],
)
def test_nodes(expression: Expression, expected: float) -> None:
    assert value(expression) == pytest.approx(expected, rel=1e-15)


def test_definitions_of_unknown_names_are_left_out() -> None:
    """A scope of positions takes the definitions of positions, and none that a left-out one enters."""
    definitions = (
        Definition("twice", Binary("+", Name("x"), Name("x"))),
        Definition("speed", Name("x_dot")),
        Definition("momentum", Binary("*", Name("twice"), Name("speed"))),
    )
    scope = with_definitions({"x": casadi.SX(X)}, definitions)
    assert set(scope) == {"x", "twice"}
    assert float(casadi.evalf(scope["twice"])) == 2 * X
