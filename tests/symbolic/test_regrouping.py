"""Regrouped products: the same values, fewer operations, and only from what nothing else needs."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.passes.grouping import grouped
from symgen.symbolic.passes.quotients import with_quotients
from symgen.symbolic.passes.rebuilt import rebuilt
from symgen.symbolic.passes.sum_factors import with_common_factors
from symgen.symbolic.passes.terms import MOST_FACTORED_TERMS, sum_of
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological

NAMES = "a b c f g h k x y z"
POINT = {name: 0.7 + 0.31 * place for place, name in enumerate(NAMES.split())}


@pytest.fixture
def graph() -> Graph:
    return Graph()


def symbols(graph: Graph, names: str = NAMES) -> list[Scalar]:
    return [graph.symbol(name) for name in names.split()]


def values(outputs: Sequence[Scalar]) -> list[float]:
    return list(Evaluator(outputs)(POINT))


def multiplications(outputs: Sequence[Scalar]) -> int:
    return cost(outputs).multiplications


def test_a_factor_leaves_terms_that_are_no_neighbours(graph: Graph) -> None:
    a, b, c, f, g, h, *_ = symbols(graph)
    outputs = [((a * f) * b + g * h) - c * f]
    regrouped = with_common_factors(graph, outputs)
    assert multiplications(regrouped) == multiplications(outputs) - 1
    assert values(regrouped) == pytest.approx(values(outputs))


def test_what_a_sum_adds_and_another_term_takes_off_is_gone(graph: Graph) -> None:
    a, b, c, f, g, *_ = symbols(graph)
    for outer in (a + b, a - b, (b - c) + a, (a + c) + b):
        rest = outer - a if outer.args[0] is a or outer.args[1] is a else None
        # the sum is needed by itself, too, so that it stays whole when terms are collected
        outputs = [(outer * f - g) - a * f, outer]
        (regrouped, whole) = with_common_factors(graph, outputs)
        (inner,) = [node for node in topological([regrouped]) if node.op == "mul" and f in node.args]
        assert a not in topological([inner])
        assert whole is outer
        assert rest is None or rest in inner.args
        assert values([regrouped]) == pytest.approx(values(outputs[:1]))
    big = {**POINT, "a": 1e20}
    (regrouped, _) = with_common_factors(graph, [((a + b) * f - g) - a * f, a + b])
    assert Evaluator([regrouped])(big) == pytest.approx(values([b * f - g]))


def test_what_is_taken_off_by_a_sign_within_a_product_is_gone(graph: Graph) -> None:
    # a difference and the opposite one become one, with a sign before it inside of a product
    a, b, c, f, g, h, _, x, y, _ = symbols(graph)
    inner, opposite = f * (x * c - y * h), f * (y * h - x * c)
    outputs = [((a + b) * inner - g) + a * opposite, inner]
    regrouped = grouped(graph, Factoring(graph, ()), outputs)
    assert Evaluator(regrouped)({**POINT, "a": 1e20}) == pytest.approx(values([b * inner - g, inner]))


def test_a_sum_of_terms_taken_off_is_taken_off_whole(graph: Graph) -> None:
    """A change of sign is an instruction: -x - y under a factor is -(x + y), whose sign goes to where that is used."""
    a, b, c, _, _, _, _, x, y, z = symbols(graph)
    total = sum_of(graph, [(-1, x), (-1, y), (-1, z)])
    assert (total.op, total.args[0].op) == ("neg", "add")
    assert values([total]) == pytest.approx(values([-(x + y + z)]))
    product = graph.raw("mul", (a, c))
    used = rebuilt(graph, graph.raw("sub", (b, product)), (b, graph.raw("neg", (product,))))
    assert used.op == "add"
    assert rebuilt(graph, graph.raw("sub", (b, x)), (graph.raw("neg", (a,)), x)).op == "neg"


@pytest.mark.parametrize("sign", range(8))
def test_signs_of_operands_are_taken_out(graph: Graph, sign: int) -> None:
    a, b, c, *_ = symbols(graph)
    left, right = (-x if sign >> k & 1 else x for k, x in enumerate((a, b)))
    node = graph.raw(["add", "sub", "mul"][sign % 3], (c, a))
    result = rebuilt(graph, node, (left, right))
    assert values([result]) == values([graph.raw(node.op, (left, right))])
    assert cost([result]).signs <= cost([left, right]).signs


def test_terms_without_a_partner_and_all_signs(graph: Graph) -> None:
    a, b, c, f, g, *_ = symbols(graph)
    for outputs in ([graph.neg(a * f) - b * f], [g - a * f - b * f - c], [a * f - (b * f - c * f)]):
        regrouped = with_common_factors(graph, outputs)
        assert multiplications(regrouped) < multiplications(outputs)
        assert values(regrouped) == pytest.approx(values(outputs))


def test_a_factor_that_is_a_term_itself_leaves_a_one(graph: Graph) -> None:
    a, f, g, *_ = symbols(graph)
    outputs = [(f * a) * g + f * g]
    regrouped = with_common_factors(graph, outputs)
    assert multiplications(regrouped) < multiplications(outputs)
    assert values(regrouped) == pytest.approx(values(outputs))


def test_products_that_are_needed_elsewhere_stay(graph: Graph) -> None:
    a, b, f, x, *_ = symbols(graph)
    product = a * f
    outputs = [product + b * f, product * x]
    assert with_common_factors(graph, outputs) == outputs


def test_sums_beyond_the_limit_stay(graph: Graph) -> None:
    f = graph.symbol("f")
    terms = [graph.symbol(f"s{k}") * f for k in range(MOST_FACTORED_TERMS + 1)]
    assert with_common_factors(graph, [graph.sum(terms)]) == [graph.sum(terms)]
    (shorter,) = with_common_factors(graph, [graph.sum(terms[:-1])])
    assert multiplications([shorter]) == 1


def test_results_and_divisors_get_their_factor_back(graph: Graph) -> None:
    a, b, c, f, g, _, k, x, y, _ = symbols(graph)
    first, second, third = f * (a + x), f * (b + y), f * (c + g)
    outputs = [k * (x * first), k * (y * second), k * third, first, graph.one / second]
    regrouped = grouped(graph, Factoring(graph, [f, k]), outputs)
    assert cost(regrouped).weight <= cost(outputs).weight
    assert values(regrouped) == pytest.approx(values(outputs))


def test_an_operation_made_twice_counts_once(graph: Graph) -> None:
    a, b, f, g, *_ = symbols(graph)
    twin = graph.raw("mul", (f, g))  # before the constructors know it
    outputs = [a * twin, b * (f * g)]
    assert multiplications(outputs) == 4
    assert multiplications(grouped(graph, Factoring(graph, [f, g]), outputs)) == 3


def test_a_reciprocal_that_serves_one_product_is_a_quotient(graph: Graph) -> None:
    a, b, c, *_ = symbols(graph)
    once, twice = graph.raw("div", (graph.one, b)), graph.raw("div", (graph.one, c))
    outputs = [graph.raw("mul", (a, once)), graph.raw("mul", (a, twice)), graph.raw("mul", (b, twice))]
    quotients = with_quotients(graph, outputs)
    assert [node.op for node in quotients] == ["div", "mul", "mul"]
    assert values(quotients) == pytest.approx(values(outputs))
