"""Monomials coded as numbers: what products and reductions say is what exponents in full say."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import pytest

from symgen.symbolic.graph import Graph
from symgen.symbolic.polynomials.monomials import LARGEST_POWER, Coefficient, Monomials, Terms
from symgen.symbolic.polynomials.polynomial import Multiplier
from symgen.symbolic.scalar import Scalar


class Drawn:
    """Atoms of a graph with values, and random sums of monomials over them."""

    def __init__(self, seed: int) -> None:
        self.source = random.Random(seed)
        graph = Graph()
        angles = [graph.symbol("a"), graph.symbol("b")]
        symbols = [graph.symbol("m"), graph.symbol("k")]
        atoms: list[Scalar] = [*symbols, *(graph.trig(name, angle) for angle in angles for name in ("sin", "cos"))]
        self.source.shuffle(atoms)
        self.monomials = Monomials(graph)
        self.atoms = {atom.serial: self.monomials.unit(atom.serial) for atom in atoms}
        place = {node.serial: self.source.uniform(0.3, 1.2) for node in (*angles, *symbols)}
        trig = {"sin": math.sin, "cos": math.cos}
        self.values = {
            atom.serial: trig[atom.op](place[atom.args[0].serial]) if atom.args else place[atom.serial]
            for atom in atoms
        }

    def terms(self, count: int, powers: tuple[int, int]) -> Terms:
        polynomial: Terms = {}
        for _ in range(count):
            key = sum(unit * self.source.randint(*powers) for unit in self.atoms.values())
            polynomial[key] = polynomial.get(key, 0) + self.source.choice([-2, -1, 1, 3, Fraction(1, 2)])
        return {key: value for key, value in polynomial.items() if value}

    def value(self, terms: Terms) -> float:
        def power(key: int) -> float:
            return math.prod(self.values[atom] ** exponent for atom, exponent in self.monomials.read(key))

        return sum(float(value) * power(key) for key, value in terms.items())


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("powers", [(0, 3), (-2, 2), (-1, 5)])
def test_products_and_reductions_keep_the_value(seed: int, powers: tuple[int, int]) -> None:
    drawn = Drawn(seed)
    a, b = drawn.terms(5, powers), drawn.terms(4, powers)
    product = drawn.monomials.product(a, b)
    assert drawn.value(product) == pytest.approx(drawn.value(a) * drawn.value(b), rel=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_equal_functions_reduce_to_nothing(seed: int) -> None:
    """(s^2 + c^2 - 1) T = 0 for whatever T is."""
    drawn = Drawn(seed)
    nodes = drawn.monomials._graph
    terms = drawn.terms(4, (0, 4))
    sine, cosine = next(
        (drawn.atoms[s], drawn.atoms[c])
        for s in drawn.atoms
        for c in drawn.atoms
        if nodes.at(s).op == "sin" and nodes.at(c).op == "cos" and nodes.at(s).args == nodes.at(c).args
    )
    circle: dict[int, Coefficient] = {2 * sine: 1, 2 * cosine: 1, 0: -1}
    assert drawn.monomials.product(circle, terms) == {}


def test_powers_up_to_the_limit_stay_apart() -> None:
    graph = Graph()
    monomials = Monomials(graph)
    x, y, z = (graph.symbol(name).serial for name in "xyz")
    for power in (1, 2, LARGEST_POWER):
        for sign in (1, -1):
            key = sign * power * monomials.unit(x) - power * monomials.unit(y) + monomials.unit(z)
            assert monomials.read(key) == tuple(sorted({x: sign * power, y: -power, z: 1}.items()))


def test_higher_powers_are_left_as_they_are() -> None:
    graph = Graph()
    x = graph.symbol("x")
    multiplier = Multiplier(graph, lambda _: False)
    assert multiplier.polynomial(graph.power(x, Fraction(LARGEST_POWER))) == {((x.serial, LARGEST_POWER),): 1}
    assert multiplier.polynomial(graph.power(x, Fraction(LARGEST_POWER + 1))) is None


def test_squares_become_sines_where_both_terms_stand() -> None:
    graph = Graph()
    a, m = graph.symbol("a"), graph.symbol("m")
    c = graph.trig("cos", a)
    multiplier = Multiplier(graph, lambda _: False)
    polynomial = multiplier.polynomial(graph.sub(m, graph.mul(m, graph.mul(c, c))))
    assert polynomial == {tuple(sorted(((m.serial, 1), (graph.trig("sin", a).serial, 2)))): 1}


def test_squared_roots_of_numbers_are_numbers() -> None:
    graph = Graph()
    x = graph.symbol("x")
    root = graph.function("sqrt", (graph.const(3),))
    multiplier = Multiplier(graph, lambda _: False)
    fifth = graph.mul(graph.power(root, Fraction(5)), x)
    assert multiplier.polynomial(fifth) == {tuple(sorted(((x.serial, 1), (root.serial, 1)))): 9}
    cancelled = graph.sub(graph.mul(root, graph.sub(graph.mul(root, x), x)), graph.mul(graph.const(3), x))
    assert multiplier.polynomial(cancelled) == {tuple(sorted(((x.serial, 1), (root.serial, 1)))): -1}
    letter = graph.function("sqrt", (x,))
    assert multiplier.polynomial(graph.add(graph.mul(letter, root), root)) is not None
