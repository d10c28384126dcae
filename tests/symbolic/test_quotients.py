"""Quotients whose factors are left out instead of divided by are what is asked for, exactly, whatever the factors."""

from __future__ import annotations

import random
from collections.abc import Mapping
from fractions import Fraction

import pytest

from symgen.diagnostics import SymgenBug
from symgen.symbolic.fingerprint import PRIME, residue
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.products import MOST_FACTORS, Products
from symgen.symbolic.scalar import Scalar

DRAWS = 400
NUMBERS = (1, -1, 2, Fraction(-3, 2), Fraction(5, 7))


def _factors(graph: Graph, draw: random.Random) -> list[Scalar]:
    """Parameters, sums in either sign, sines of sums, a root, a magnitude and a quotient of sums."""
    k, m, p, q = (graph.symbol(name) for name in "kmpq")
    total, left = k + m * p, k - m
    trig = [graph.trig(op, angle) for op in ("sin", "cos") for angle in (p, q, p - q)]
    others = [
        graph.function("sqrt", (graph.const(3),)),
        graph.function("abs", (left,)),
        (q + 2) / (p + k),
        graph.raw("sub", (m, k)),
        graph.raw("sub", (-k, m * p)),
    ]
    return draw.sample([k, m, p, total, left, m - k, -k - m * p, *trig, *others], 8)


def _multiplied(graph: Graph, draw: random.Random, powers: Mapping[Scalar, int], raw: bool) -> Scalar:
    """A number times the powers, one factor after the other in any order."""
    whole = graph.const(draw.choice(NUMBERS))
    each = [(factor, count > 0) for factor, count in powers.items() for _ in range(abs(count))]
    for factor, up in draw.sample(each, len(each)):
        op = "mul" if up else "div"
        whole = graph.raw(op, (whole, factor)) if raw else graph.mul(whole, factor) if up else graph.div(whole, factor)
    return whole


def _is_quotient(graph: Graph, scalar: Scalar, a: Scalar, powers: Mapping[Scalar, int], number: int | Fraction) -> bool:
    """By fingerprints and by exact evaluation, which does not rely on the rules of the graph."""
    value, asked = a.value * pow(residue(Fraction(number)), -1, PRIME), graph.raw("div", (a, graph.const(number)))
    for factor, count in powers.items():
        value = value * pow(factor.value, -count, PRIME)
        for _ in range(abs(count)):
            asked = graph.raw("div" if count > 0 else "mul", (asked, factor))
    try:
        with every_identity_evaluated():
            same_values("the quotient", [asked], [scalar])
    except SymgenBug:
        return False
    return bool(scalar.value == value % PRIME)


def _drawn(seed: int) -> tuple[Graph, Scalar, dict[Scalar, int], int | Fraction]:
    draw = random.Random(seed)
    graph = Graph()
    factors = _factors(graph, draw)
    a = _multiplied(graph, draw, {f: draw.choice((0, 0, 1, 1, 2, -1, -2)) for f in factors}, raw=seed % 2 == 1)
    asked = {f: draw.choice((0, 0, 0, 1, 1, 2, -1)) for f in factors}
    if seed % 3 == 0:
        # as callers ask: with factors as they stand in another product
        asked = dict(graph.products.monomial(_multiplied(graph, draw, asked, raw=False))[1])
    return graph, a, asked, draw.choice(NUMBERS)


@pytest.mark.campaign
def test_a_quotient_is_what_is_asked_for() -> None:
    held = other = 0
    for seed in range(DRAWS):
        graph, a, powers, number = _drawn(seed)
        quotient = graph.products.quotient(a, powers, number)
        assert _is_quotient(graph, quotient, a, powers, number), f"draw {seed}"
        own = graph.products.monomial(a)[1]
        held += any(own.get(f, 0) >= count > 0 for f, count in powers.items())
        other += any(count > 0 and f not in own for f, count in powers.items())
    assert held > DRAWS // 4
    assert other > DRAWS // 4


def test_a_product_is_its_monomial() -> None:
    for seed in range(DRAWS):
        graph, a, _, _ = _drawn(seed)
        coefficient, powers = graph.products.monomial(a)
        # coefficient * powers over one is a over its own coefficient and powers
        value = residue(Fraction(coefficient))
        for factor, count in powers.items():
            value = value * pow(factor.value, count, PRIME) % PRIME
        assert value == a.value
        assert graph.products.quotient(a, powers, coefficient).is_one


@pytest.mark.campaign
def test_divisors_that_are_no_factors_are_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is dropped there is noticed at once, and by the draws above."""

    def lossy(self: Products, a: Scalar, powers: Mapping[Scalar, int], number: int | Fraction = 1) -> Scalar:
        own = self.monomial(a)[1]
        return whole(self, a, {f: count for f, count in powers.items() if f in own}, number)

    whole = Products.quotient
    monkeypatch.setattr(Products, "quotient", lossy)
    wrong = 0
    for seed in range(DRAWS):
        graph, a, powers, number = _drawn(seed)
        wrong += not _is_quotient(graph, graph.products.quotient(a, powers, number), a, powers, number)
    assert wrong > DRAWS // 4


def test_a_wrong_quotient_ends_generation(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    x, y, k = (graph.symbol(name) for name in "xyk")
    monkeypatch.setattr(Products, "_product", lambda *_: x)
    with pytest.raises(SymgenBug, match="leaving out factors: changes the value"):
        graph.products.quotient(x * y, {y: 1, k: 1})


def test_the_addition_theorem_is_evaluated_where_everything_is(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    s, c, t, d = (graph.trig(op, angle) for angle in (a, b) for op in ("sin", "cos"))
    monkeypatch.setattr(Products, "_addition_theorem", lambda *_: graph.trig("sin", a - b))
    with pytest.raises(SymgenBug, match="the addition theorem: changes the value"):
        s * d + c * t
    with every_identity_evaluated():
        assert s * d - c * t is graph.trig("sin", a - b)


def test_what_has_too_many_factors_is_one() -> None:
    graph = Graph()
    letters = [graph.symbol(f"x{i}") for i in range(MOST_FACTORS + 1)]
    whole = graph.product(letters)
    assert graph.products.quotient(whole * letters[0], {whole: 1}) is letters[0]
    assert _is_quotient(graph, graph.products.quotient(letters[0], {whole: 2}, 3), letters[0], {whole: 2}, 3)
