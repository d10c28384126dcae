"""Limits that keep derivations short: beyond each of them a scalar stays as it stands, up to it it does not."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import pytest

from symgen.linear_algebra.rows.constant_rows import MOST_PIVOTS_TRIED, ConstantRows
from symgen.linear_algebra.rows.sparser_rows import MOST_ROWS_COMBINED, SparserRows
from symgen.mechanics.genericity import genericity
from symgen.mechanics.structure import MOST_ENTRIES, analyse
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.runtime.effort import done
from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.shared_parts import MOST_SHARING_TERMS, with_shared_sums
from symgen.symbolic.polynomials import content, polynomial
from symgen.symbolic.polynomials.content import usual_number
from symgen.symbolic.polynomials.polynomial import MOST_EXPANDED_TERMS, Multiplier, refactored
from symgen.symbolic.products import MOST_FACTORS
from symgen.symbolic.scalar import Scalar
from symgen.validity.driven import MOST_LISTED_MINORS, driven_minors
from symgen.validity.search import MOST_DRIVEN_SQUARES, PreciseEvaluator, ZeroSearch


def symbols(graph: Graph, letter: str, count: int) -> list[Scalar]:
    return [graph.symbol(f"{letter}{k}") for k in range(count)]


def test_a_common_number_is_looked_for_down_to_a_depth() -> None:
    graph = Graph()
    value = 3 * graph.symbol("x")
    for k in range(content.DEEPEST - 1):
        value = value + 3 * graph.symbol(f"y{k}")
    assert usual_number([value]) == 3
    assert usual_number([value + 3 * graph.symbol("z")]) == Fraction(1)


@pytest.mark.parametrize("more", [0, 1])
def test_long_products_are_not_taken_apart(more: int) -> None:
    graph = Graph()
    factors = symbols(graph, "f", MOST_FACTORS + more)
    product = factors[0]
    for factor in factors[1:]:
        product = product * factor
    _, powers = graph.products.monomial(product)
    assert len(powers) == (1 if more else MOST_FACTORS)


def test_sums_of_many_terms_are_not_multiplied_out() -> None:
    graph = Graph()
    few, many = (graph.sum(symbols(graph, letter, count)) for letter, count in (("a", 10), ("b", 12)))
    multiplier = Multiplier(graph, lambda _: False)
    short, long = few * graph.sum(symbols(graph, "c", 12)), many * graph.sum(symbols(graph, "d", 11))
    assert len(multiplier.polynomial(short) or ()) == 120 == MOST_EXPANDED_TERMS
    assert multiplier.polynomial(long) is None


def test_outputs_of_many_operations_are_not_multiplied_out(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    a, b, c = symbols(graph, "x", 3)
    output = a * b + a * c
    multiplier = Multiplier(graph, lambda _: False)
    assert refactored(graph, [output], multiplier, lambda _: False) != [output]
    monkeypatch.setattr(polynomial, "MOST_EXPANDED_OPERATIONS", output.size - 1)
    assert refactored(graph, [output], multiplier, lambda _: False) == [output]


@pytest.mark.parametrize("more", [0, 1])
def test_long_sums_share_no_parts(more: int) -> None:
    graph = Graph()
    a, b = symbols(graph, "x", 2)
    outputs = []
    for letter in "pq":
        total = a
        for term in (*symbols(graph, letter, MOST_SHARING_TERMS - 2 + more), b):
            total = total + term
        outputs.append(total)
    assert (with_shared_sums(graph, outputs) == outputs) is bool(more)


def test_many_minors_are_not_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    n, r = 6, 3
    rows = tuple(tuple(symbols(graph, f"b{i}_", n)) for i in range(r))
    inputs = [tuple(graph.one if j == k else graph.zero for j in range(n)) for k in range(n)]
    assert MOST_LISTED_MINORS > 20
    assert driven_minors(graph, rows, inputs, n) is not None
    monkeypatch.setattr("symgen.validity.driven.MOST_LISTED_MINORS", 19)
    assert driven_minors(graph, rows, inputs, n) is None


@pytest.mark.parametrize("more", [0, 1])
def test_a_row_of_numbers_is_solved_for_one_of_its_first_unknowns(more: int) -> None:
    """The unknown that costs nothing is the last that is tried, or the next one."""
    graph = Graph()
    best = MOST_PIVOTS_TRIED - 1 + more
    unknowns = symbols(graph, "x", MOST_PIVOTS_TRIED + 2)
    other = tuple(graph.zero if k == best else y for k, y in enumerate(symbols(graph, "y", len(unknowns))))
    rows = ConstantRows((tuple(graph.one for _ in unknowns), other))
    assert (unknowns[best] in rows.kept(unknowns)) is bool(more)


@pytest.mark.parametrize("more", [0, 1])
def test_many_rows_are_not_combined(more: int) -> None:
    graph = Graph()
    size = MOST_ROWS_COMBINED + more
    diagonal = [[x if i == j else graph.zero for j in range(size)] for i, x in enumerate(symbols(graph, "x", size))]
    diagonal[1][0] = diagonal[0][0]
    matrix = tuple(map(tuple, diagonal))
    assert (SparserRows(matrix).matrix == matrix) is bool(more)


@pytest.mark.parametrize("n", [13, 14])
def test_a_long_mass_matrix_is_not_looked_through(n: int) -> None:
    coordinates = ", ".join(f"q{k}: {{}}" for k in range(n))
    energy = " + ".join(f"q{k}_dot**2" for k in range(n))
    text = f"model: masses\ncoordinates: {{{coordinates}}}\nkinetic_energy: {energy}\n"
    mechanics = System(load_text(f"{text}inputs: {{u: {{acts_on: {{q0: 1}}}}}}\n", "masses.yaml"))
    why = {decision.what: decision.why for decision in analyse(mechanics, genericity(mechanics)).decisions}
    short = n * (n + 1) // 2 <= MOST_ENTRIES
    assert short is (n == 13)
    assert (f"{n * (n - 1) // 2} of {n * (n - 1) // 2} couplings in G" in why) is short
    cause = "the mass matrix is constant, so C = 0" if short else "the quadratic velocity terms cancel, so C q_dot = 0"
    assert why["Coriolis forces"] == cause


@pytest.mark.parametrize("more", [0, 1])
def test_squares_are_driven_one_by_one_up_to_a_number(more: int, monkeypatch: pytest.MonkeyPatch) -> None:
    count = MOST_DRIVEN_SQUARES + more
    coordinates = ", ".join(f"q{k}: {{unit: rad}}" for k in range(count))
    energy = " + ".join(f"q{k}_dot**2" for k in range(count))
    text = f"model: turning\ncoordinates: {{{coordinates}}}\nkinetic_energy: {energy}\n"
    mechanics = System(load_text(f"{text}inputs: {{u: {{acts_on: {{q0: 1}}}}}}\n", "turning.yaml"))
    graph, driven = mechanics.graph, []

    def evaluator(scalars: Sequence[Scalar]) -> PreciseEvaluator:
        driven.append(len(scalars))
        return PreciseEvaluator(scalars)

    search = ZeroSearch(mechanics, genericity(mechanics))
    monkeypatch.setattr("symgen.validity.search.PreciseEvaluator", evaluator)
    sines = [graph.trig("sin", graph.symbol(f"q{k}")) for k in range(count)]
    assert search.zero_of(graph.sum(sine * sine for sine in sines)) is not None
    assert driven[-1] == (1 if more else count)


@pytest.mark.parametrize(("count", "most"), [(12, 30_000), (24, 100_000)])
def test_few_squares_are_driven_to_zero_one_by_one_and_many_together(count: int, most: int) -> None:
    """One by one they take few steps, each of which takes the third power of their number."""
    names = [f"q{k}" for k in range(8)]
    coordinates = ", ".join(f"{name}: {{unit: rad}}" for name in names)
    energy = " + ".join(f"{name}_dot**2" for name in names)
    text = f"model: turning\ncoordinates: {{{coordinates}}}\nkinetic_energy: {energy}\n"
    mechanics = System(load_text(f"{text}inputs: {{u: {{acts_on: {{q0: 1}}}}}}\n", "turning.yaml"))
    graph = mechanics.graph
    x = [graph.symbol(name) for name in names]
    terms = []
    for k in range(count):
        one, other, third = x[k % 8], x[(k + 1 + k // 8) % 8], graph.trig("cos", x[(3 * k + 1) % 8])
        terms.append(graph.trig("sin", one) * (2 + third) if count < 20 else graph.trig("sin", one - other) * third)
    search = ZeroSearch(mechanics, genericity(mechanics))
    before = done()
    assert search.zero_of(graph.sum(term * term for term in terms)) is not None
    assert done() - before < most
