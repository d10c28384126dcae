"""Parts that several sums and products share, factors that parameters hide."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

import pytest
from shipped import model

from symgen.linear_algebra.guards import magnitude
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.shared_parts import with_shared_products, with_shared_sums
from symgen.symbolic.passes.sum_factors import with_common_factors
from symgen.symbolic.polynomials.content import divided
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, reached

VALUES = {name: 0.3 + 0.7 * k for k, name in enumerate("abcdefpq")}
Step = Callable[[Graph, Sequence[Scalar]], list[Scalar]]


def symbols(graph: Graph, names: str) -> list[Scalar]:
    return [graph.symbol(name) for name in names]


def sum_of(graph: Graph, signed: Sequence[tuple[int, Scalar]]) -> Scalar:
    (_, total), *rest = signed
    for sign, term in rest:
        total = graph.raw("add" if sign > 0 else "sub", (total, term))
    return total


def taken(step: Step, graph: Graph, outputs: Sequence[Scalar], operations: int) -> list[Scalar]:
    """The outputs after a step, checked to keep their values and to take so many operations."""
    rewritten = step(graph, outputs)
    assert list(Evaluator(rewritten)(VALUES)) == pytest.approx(list(Evaluator(outputs)(VALUES)), rel=1e-14)
    assert cost(rewritten).weight == operations
    return rewritten


def test_pairs_of_terms_are_added_once_whatever_their_sign() -> None:
    graph = Graph()
    a, b, c, d, e, f = symbols(graph, "abcdef")
    sums = [sum_of(graph, [(1, x), (s, a), (-s, b)]) for x, s in ((c, 1), (d, -1), (e, 1))]
    taken(with_shared_sums, graph, [*sums, graph.raw("mul", (f, sums[0]))], 5)


def test_pairs_of_factors_are_multiplied_once() -> None:
    graph = Graph()
    a, b, c, d, e, _ = symbols(graph, "abcdef")
    products = [graph.raw("mul", (a, graph.raw("mul", (x, b)))) for x in (c, d, e)]
    taken(with_shared_products, graph, products, 4)


def test_angles_stay_as_they_are() -> None:
    graph = Graph()
    a, b, c, d, _, _ = symbols(graph, "abcdef")
    angles = [sum_of(graph, [(1, x), (1, a), (-1, b)]) for x in (c, d)]
    sines = [graph.function("sin", (angle,)) for angle in angles]
    assert with_shared_sums(graph, sines) == sines


def test_parameters_are_taken_out_of_sums_that_share_them() -> None:
    graph = Graph()
    a, b, c, d, _, _, p, q = symbols(graph, "abcdefpq")
    product = graph.raw("mul", (p, q))
    sums = [sum_of(graph, [(1, x), (1, product), (-1, graph.raw("mul", (p, y)))]) for x, y in ((a, b), (c, d))]
    fixed = {p, q, product}

    def step(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
        return with_common_factors(graph, outputs, fixed.__contains__)

    assert cost(with_common_factors(graph, sums)).weight == 7
    taken(step, graph, sums, 6)


def test_a_number_is_divided_into_the_term_that_holds_it() -> None:
    graph = Graph()
    a, b, *_ = symbols(graph, "ab")
    assert divided(graph, 2 * a - b, Fraction(2)) is a - b * Fraction(1, 2)
    assert divided(graph, a - b, Fraction(2)) is (a - b) * Fraction(1, 2)


def test_the_bound_of_a_square_core_is_that_of_its_determinant() -> None:
    derivations = derive_quantities(model("delta"), ("inverse_dynamics",))
    (guard,) = derivations.quantities[0].guards
    assert guard.scale is not None
    graph = derivations.mechanics.graph
    assert cost([guard.scale]).weight <= 22
    (whole,) = magnitude(graph, [guard.denominator])
    names = [node.payload for node in reached([whole, guard.scale]) if node.op == "symbol"]
    values = {str(name): 0.2 + 0.3 * k for k, name in enumerate(sorted(map(str, names)))}
    bound, given = Evaluator([guard.scale, whole])(values)
    assert bound == pytest.approx(given, rel=1e-13)


@pytest.mark.parametrize(("terms", "operations"), [(8, 8), (20, 20), (40, 78)])
def test_sums_of_up_to_some_twenty_terms_share_what_they_have_in_common(terms: int, operations: int) -> None:
    """Two that differ in one term alone; of long ones the pairs of terms, which grow as squares, are left alone."""
    graph = Graph()
    common = [graph.symbol(f"c_{k}") for k in range(terms - 1)]
    sums = [sum_of(graph, [(1, x) for x in (graph.symbol(name), *common)]) for name in "pq"]
    assert cost(sums).weight == 2 * (terms - 1)
    assert cost(with_shared_sums(graph, sums)).weight == operations
