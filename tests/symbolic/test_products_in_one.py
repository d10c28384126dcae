"""Sums multiplied out and factored: one product where it is one, whole differences, atoms and powers, all exactly."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from symgen.symbolic.differences import Differences
from symgen.symbolic.fingerprint import PRIME, residue
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.polynomials.monomials import Monomials, Terms
from symgen.symbolic.polynomials.polynomial import Multiplier, factored
from symgen.symbolic.scalar import Scalar

SEEDS = range(150)
Made = tuple[Graph, random.Random, Factoring, list[Scalar]]


def _made(seed: int) -> Made:
    """A graph with three parameters and three coordinates."""
    graph = Graph()
    parameters, coordinates = ([graph.symbol(name) for name in names] for names in ("klm", "pqr"))
    return graph, random.Random(seed), Factoring(graph, parameters, coordinates), [*parameters, *coordinates]


def _raw(graph: Graph, op: str, a: Scalar, b: Scalar) -> Scalar:
    return graph.raw(op, (a, b))


def _hidden_product(graph: Graph, draw: random.Random, symbols: list[Scalar]) -> Scalar:
    """k l sin(x - y), (x - y) m or a circle's 1, as the sum it is multiplied out, or one that is none by a little."""
    k, length, m, *coordinates = symbols
    x, y = draw.sample(coordinates, 2)
    s, c, t, d = (graph.trig(op, angle) for angle in (x, y) for op in ("sin", "cos"))
    first = draw.choice(((s, d), (s, t), (s, s), (k, length), (x, length)))
    second = draw.choice(((c, t), (c, d), (c, c), (m, length)))
    if draw.random() < 0.5:
        first, second = ((s, d), (c, t)) if draw.random() < 0.5 else ((s, s), (c, c))
    common = [draw.choice((k, length, k + m, s, x)) for _ in range(2)]
    terms = []
    for pair in (first, second):
        total = graph.const(draw.choice((1, 1, Fraction(1, 2))))
        for factor in draw.sample([*common, *pair], 4):
            total = _raw(graph, "mul", total, factor)
        if draw.random() < 0.3:
            total = _raw(graph, "div", total, draw.choice((k, k + m, x * x + 1)))
        terms.append(total)
    return _raw(graph, draw.choice(("add", "sub")), *terms)


def test_what_is_one_product_is_written_as_the_same() -> None:
    written = 0
    for seed in SEEDS:
        graph, draw, factoring, symbols = _made(seed)
        given = [_hidden_product(graph, draw, symbols) for _ in range(3)]
        with every_identity_evaluated():
            products = [factoring.as_one_product(scalar) for scalar in given]
            same_values("one product", given, products)
            same_values("cancelling", given, [factoring.cancelled(scalar) for scalar in given])
        for one, other in zip(given, products, strict=True):
            if one is not other:
                written += 1
                powers = graph.products.monomial(other)[1]
                assert not any(f.op in ("add", "sub") and not factoring.fixed(f) for f in powers)
    assert written > len(SEEDS) // 3


def _linear(graph: Graph, draw: random.Random, symbols: list[Scalar]) -> Scalar:
    """A sum of multiples of coordinates, parameters and numbers, nested and in any order."""
    total = draw.choice(symbols)
    for _ in range(draw.randrange(1, 4)):
        part = draw.choice([*symbols, symbols[0] * symbols[1], graph.const(Fraction(6, 5)), total])
        factor = graph.const(draw.choice((1, -1, 2, Fraction(-1, 3))))
        total = _raw(graph, draw.choice(("add", "sub")), total, _raw(graph, "mul", factor, part))
    return -total if draw.random() < 0.2 else total


def test_differences_are_multiples_of_their_atoms() -> None:
    shared = 0
    for seed in SEEDS:
        graph, draw, factoring, symbols = _made(seed)
        differences = Differences(graph, symbols[3:], factoring.fixed)
        nodes = [_linear(graph, draw, draw.sample(symbols, 3)) for _ in range(5)]
        nodes += [_raw(graph, "mul", graph.const(Fraction(-3, 4)), node) for node in nodes]
        atoms: set[Scalar] = set()
        for node in nodes:
            multiple = differences.read(node)
            if multiple is None:
                continue
            atom, factor = multiple
            with every_identity_evaluated():
                same_values("reading", [node], [graph.raw("mul", (graph.const(factor), atom))])
            shared += atom in atoms
            atoms.add(atom)
    assert shared > len(SEEDS)


def test_products_of_differences_keep_their_values() -> None:
    changed = 0
    for seed in SEEDS:
        graph, draw, factoring, symbols = _made(seed)
        pool = [_linear(graph, draw, symbols) for _ in range(3)]
        pool += [*symbols[3:], graph.trig("sin", symbols[3]), graph.trig("cos", symbols[3])]
        outputs = []
        for _ in range(3):
            terms = [_raw(graph, "mul", *draw.choices(pool, k=2)) for _ in range(4)]
            total = _raw(graph, "mul", *draw.choices(pool, k=2))
            for term in terms:
                total = _raw(graph, draw.choice(("add", "sub")), total, term)
            outputs.append(_raw(graph, "div", total, draw.choice(pool)) if draw.random() < 0.3 else total)
        kept = frozenset(draw.sample(pool, 1)) if draw.random() < 0.5 else frozenset[Scalar]()
        with every_identity_evaluated():
            shortened = factoring.shorten(outputs, kept)
            same_values("shortening", outputs, shortened)
        changed += any(one is not other for one, other in zip(outputs, shortened, strict=True))
    assert changed > len(SEEDS) // 2


def _terms(draw: random.Random, units: list[int], powers: tuple[int, int], count: int) -> Terms:
    polynomial: Terms = {}
    for _ in range(count):
        key = sum(unit * draw.randint(*powers) for unit in units)
        polynomial[key] = polynomial.get(key, 0) + draw.choice((-2, -1, 1, 3, Fraction(1, 2)))
    return {key: value for key, value in polynomial.items() if value}


def _value(graph: Graph, monomials: Monomials, terms: Terms) -> int:
    """Of a sum of monomials, in the field."""
    total = 0
    for key, coefficient in terms.items():
        value = residue(Fraction(coefficient))
        for atom, power in monomials.read(key):
            value = value * pow(graph.at(atom).value, power, PRIME) % PRIME
        total += value
    return total % PRIME


@pytest.mark.parametrize("powers", [(0, 3), (-2, 2), (-1, 5)])
def test_products_of_sums_of_monomials_are_exact(powers: tuple[int, int]) -> None:
    """Sines and cosines of one angle among them, reduced by s^2 + c^2 = 1."""
    for seed in SEEDS:
        graph, draw, _, symbols = _made(seed)
        monomials = Monomials(graph)
        atoms = [*symbols[:2], *(graph.trig(op, angle) for angle in symbols[3:5] for op in ("sin", "cos"))]
        units = [monomials.unit(atom.serial) for atom in draw.sample(atoms, len(atoms))]
        a, b = (_terms(draw, units, powers, count) for count in (5, 4))
        product = monomials.product(a, b)
        assert _value(graph, monomials, product) == _value(graph, monomials, a) * _value(graph, monomials, b) % PRIME


def test_what_is_multiplied_out_is_factored_to_the_same() -> None:
    """Powers of both signs in each term, factors before and behind."""
    for seed in SEEDS:
        graph, draw, factoring, symbols = _made(seed)
        atoms = [*symbols, graph.trig("sin", symbols[3]), graph.function("sqrt", (graph.const(3),))]
        total = graph.zero
        for _ in range(5):
            term = graph.const(draw.choice((1, -1, Fraction(2, 3))))
            for factor in draw.choices(atoms, k=4):
                term = _raw(graph, draw.choice(("mul", "mul", "div")), term, factor)
            total = _raw(graph, "add", total, term)
        terms = Multiplier(graph, factoring.fixed).polynomial(total)
        assert terms is not None
        with every_identity_evaluated():
            same_values("factoring", [total], [factored(graph, terms, factoring.fixed)])
