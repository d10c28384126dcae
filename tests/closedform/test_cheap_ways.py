"""Shortcuts of the closed forms: they must say what the long way says."""

from fractions import Fraction

from symgen.closedform.algebra.fourier import fourier_series, least_length
from symgen.closedform.algebra.ring import LONG_PRODUCT
from symgen.closedform.algebra.translate import Translator
from symgen.closedform.spelling import Speller
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Number, Power

A, B, X, P = (Name(name) for name in "abxp")


def wave(position: int) -> Expression:
    """Sums of products with angles, their sums, a variable and a root."""
    angle = Binary("+", A, B) if position % 2 else A
    root = Power(P, Fraction(1, 2)) if position % 3 == 0 else X
    factor = Binary("*", Number(Fraction(position + 1)), Binary("*", root, Call("cos", (angle,))))
    return Binary("+", factor, Binary("*", Power(X, Fraction(position % 4)), Call("sin", (B,))))


def ring_and_polynomials() -> tuple[Translator, list[Expression]]:
    expressions: list[Expression] = [wave(0)]
    for position in range(1, 7):
        expressions.append(Binary("*" if position in (2, 5) else "+", expressions[-1], wave(position)))
    return Translator(["x", "a", "b", "p"], ["x", "a", "b"], {}, expressions, []), expressions


def test_long_products_by_way_of_flint_are_the_products_in_the_ring() -> None:
    translator, expressions = ring_and_polynomials()
    ring = translator.ring
    polynomials = [translator.value(expression).numerator for expression in expressions]
    long = 0
    for p in polynomials:
        for q in polynomials:
            long += len(p) * len(q) >= LONG_PRODUCT
            assert ring.product(p, q) == ring.normal(p * q)
    assert long > 10


def test_no_fourier_sum_is_shorter_than_its_bound() -> None:
    translator, expressions = ring_and_polynomials()
    speller, bounds = Speller(translator.ring), []
    for expression in expressions:
        p = translator.value(expression).numerator
        bounds.append(least_length(translator.ring, fourier_series(translator.ring, p)))
        assert bounds[-1] <= speller.fourier(p)[1].count_ops()
    assert max(bounds) > 20
