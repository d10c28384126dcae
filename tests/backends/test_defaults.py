"""Default parameter values."""

from __future__ import annotations

import math
from fractions import Fraction

import handmade
import pytest

from symgen.backends.defaults import default_values
from symgen.diagnostics import SymgenBug
from symgen.model.expressions.expression import Binary, Call, Name, Negation, Power


def test_rational_values_are_exact_and_functions_double() -> None:
    values = default_values(handmade.model())
    assert values["I"] == Fraction(26, 100)
    assert values["half_turn"] == Fraction(math.pi)
    assert values["root"] == Fraction(math.sqrt(2))


def test_every_kind_of_expression() -> None:
    two, half = handmade.number("2"), handmade.number("0.5")
    expressions = {
        "a": Power(two, Fraction(-3)),
        "b": Binary("/", Name("a"), handmade.number("3")),
        "c": Negation(Binary("-", two, half)),
        "d": Power(handmade.number("9"), Fraction(1, 2)),
        "e": Call("atan2", (two, half)),
    }
    values = default_values(handmade.model(parameters=tuple(handmade.parameter(n, v) for n, v in expressions.items())))
    assert values == {
        "a": Fraction(1, 8),
        "b": Fraction(1, 24),
        "c": Fraction(-3, 2),
        "d": Fraction(3),
        "e": Fraction(math.atan2(2, 0.5)),
    }


@pytest.mark.parametrize("operation", ["division", "root"])
def test_a_value_that_does_not_exist_is_named(operation: str) -> None:
    zero, minus = handmade.number("0"), handmade.number("-1")
    value = Binary("/", minus, zero) if operation == "division" else Call("sqrt", (minus,))
    with pytest.raises(SymgenBug, match="parameter broken"):
        default_values(handmade.model(parameters=(handmade.parameter("broken", value),)))
