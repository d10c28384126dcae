"""The ring of sines and cosines: canonical forms, derivatives, common factors, what it cannot hold."""

from fractions import Fraction

import pytest
import sympy
from sympy import Symbol, cos, sin

from symgen.closedform.algebra.homogeneous import common_factor, factorise
from symgen.closedform.algebra.quotient import quotient
from symgen.closedform.algebra.translate import Translator
from symgen.closedform.spelling import Speller, spell_expression
from symgen.model.expressions.expression import (
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


def number(value: str) -> Number:
    return Number(Fraction(value))


def total(*terms: Expression) -> Expression:
    result = terms[0]
    for term in terms[1:]:
        result = Binary("+", result, term)
    return result


def product(*factors: Expression) -> Expression:
    result = factors[0]
    for factor in factors[1:]:
        result = Binary("*", result, factor)
    return result


def sine(argument: Expression) -> Expression:
    return Call("sin", (argument,))


def cosine(argument: Expression) -> Expression:
    return Call("cos", (argument,))


X, A, B = Name("x"), Name("a"), Name("b")


def translator(*expressions: Expression) -> Translator:
    return Translator(["x", "a", "b", "p"], ["x", "a", "b"], {}, expressions, [])


def test_equal_expressions_have_equal_normal_forms() -> None:
    left = sine(total(A, product(number("2"), B)))
    right = total(
        product(sine(A), cosine(B), cosine(B)),
        Negation(product(sine(A), sine(B), sine(B))),
        product(number("2"), cosine(A), sine(B), cosine(B)),
    )
    ring = translator(left, right)
    assert ring.value(left).equals(ring.value(right))
    assert not ring.value(left).equals(-ring.value(right))


def test_powers_of_a_sine_are_reduced() -> None:
    one = total(Power(sine(A), Fraction(4)), product(number("2"), Power(product(sine(A), cosine(A)), Fraction(2))))
    other = total(number("1"), Negation(Power(cosine(A), Fraction(4))))
    ring = translator(one, other)
    assert ring.value(one).equals(ring.value(other))


def test_half_angles_and_quarter_turns_are_exact() -> None:
    half = Binary("/", A, number("2"))
    doubled = product(number("2"), sine(half), cosine(half))
    turned = Negation(cosine(total(A, Binary("/", Pi(), number("2")))))
    ring = translator(doubled, turned)
    assert ring.value(doubled).equals(ring.value(turned))


def test_parameters_and_constants_inside_a_sine_are_angles_of_their_own() -> None:
    offset = sine(total(A, Name("p"), number("0.3")))
    ring = translator(offset)
    expected = spell_expression(offset).diff(Symbol("a"))
    derived = Speller(ring.ring).quotient(ring.derivative(ring.value(offset), "a"))
    values = {Symbol("a"): 0.7, Symbol("p"): -0.2}
    assert float(derived.subs(values)) == pytest.approx(float(expected.subs(values)))


@pytest.mark.parametrize("function", ["sqrt", "exp", "log", "asin", "acos", "atan", "sinh", "cosh", "tanh", "tan"])
def test_derivatives_of_what_the_ring_cannot_hold(function: FunctionName) -> None:
    expression = Call(function, (total(product(number("0.3"), X, X), product(number("0.2"), sine(A))),))
    ring = translator(expression)
    speller = Speller(ring.ring)
    values = {Symbol("a"): 0.4, Symbol("x"): 0.9}
    for name in ("x", "a"):
        derived = speller.quotient(ring.derivative(ring.value(expression), name))
        expected = spell_expression(expression).diff(Symbol(name))
        assert float(derived.subs(values)) == pytest.approx(float(expected.subs(values)), rel=1e-12)


def test_derivative_of_atan2_and_of_a_sine_of_a_root() -> None:
    expression = product(Call("atan2", (X, A)), sine(Power(X, Fraction(3, 2))))
    ring = translator(expression)
    derived = Speller(ring.ring).quotient(ring.derivative(ring.value(expression), "x"))
    expected = spell_expression(expression).diff(Symbol("x"))
    values = {Symbol("a"): 0.4, Symbol("x"): 0.9}
    assert float(derived.subs(values)) == pytest.approx(float(expected.subs(values)), rel=1e-12)


def test_factors_are_sines_of_differences() -> None:
    difference = total(A, Negation(B))
    expression = total(
        product(sine(difference), sine(A), X), product(number("2"), sine(difference), cosine(A), Name("p"))
    )
    ring = translator(sine(A), sine(B), expression)
    _, factors = factorise(ring.ring, ring.value(expression).numerator)
    assert len(factors) == 2
    shared = common_factor(ring.ring, [ring.value(expression).numerator, ring.value(sine(difference)).numerator])
    assert Speller(ring.ring).polynomial(ring.ring.normal(shared)) in (
        sin(Symbol("a") - Symbol("b")),
        sin(Symbol("b") - Symbol("a")),
    )


def test_a_fraction_is_cancelled_across_identities() -> None:
    top, bottom = total(number("1"), Negation(Power(cosine(A), Fraction(2)))), product(sine(A), cosine(A))
    ring = translator(top, bottom)
    value = ring.value(Binary("/", top, bottom))
    assert Speller(ring.ring).quotient(value) == sympy.tan(Symbol("a"))


def test_denominators_are_fourier_sums_and_numerators_pair() -> None:
    top = product(sine(A), cosine(A))
    bottom = total(Power(sine(A), Fraction(2)), product(X, X, Power(cosine(A), Fraction(2))))
    ring = translator(top, bottom)
    a, x = Symbol("a"), Symbol("x")
    value = quotient(ring.ring, ring.value(top).numerator, ring.value(bottom).numerator)
    assert Speller(ring.ring).quotient(value) == sin(2 * a) / (x**2 + (x**2 - 1) * cos(2 * a) + 1)
