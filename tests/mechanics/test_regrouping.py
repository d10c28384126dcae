"""Regrouped products: the same values, fewer operations, and only from what nothing else needs."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.passes.early_factors import early_factors, with_early_factor
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.passes.grouping import grouped
from symgen.symbolic.passes.late_factors import with_late_factors
from symgen.symbolic.passes.sum_factors import MOST_TERMS, with_common_factors
from symgen.symbolic.scalar import Graph, Scalar
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
    found = with_common_factors(graph, outputs)
    assert multiplications(found) == multiplications(outputs) - 1
    assert values(found) == pytest.approx(values(outputs))


def test_what_a_sum_adds_and_another_term_takes_off_is_gone(graph: Graph) -> None:
    a, b, c, f, g, *_ = symbols(graph)
    for outer in (a + b, a - b, (b - c) + a, (a + c) + b):
        rest = outer - a if outer.args[0] is a or outer.args[1] is a else None
        # the sum is needed by itself, too, so that it stays whole when terms are collected
        outputs = [(outer * f - g) - a * f, outer]
        (found, whole) = with_common_factors(graph, outputs)
        (inner,) = [node for node in topological([found]) if node.op == "mul" and f in node.args]
        assert a not in topological([inner])
        assert whole is outer
        assert rest is None or rest in inner.args
        assert values([found]) == pytest.approx(values(outputs[:1]))
    big = {**POINT, "a": 1e20}
    (found, _) = with_common_factors(graph, [((a + b) * f - g) - a * f, a + b])
    assert Evaluator([found])(big) == pytest.approx(values([b * f - g]))


def test_terms_without_a_partner_and_all_signs(graph: Graph) -> None:
    a, b, c, f, g, *_ = symbols(graph)
    for outputs in ([graph.neg(a * f) - b * f], [g - a * f - b * f - c], [a * f - (b * f - c * f)]):
        found = with_common_factors(graph, outputs)
        assert multiplications(found) < multiplications(outputs)
        assert values(found) == pytest.approx(values(outputs))


def test_a_factor_that_is_a_term_itself_leaves_a_one(graph: Graph) -> None:
    a, f, g, *_ = symbols(graph)
    outputs = [(f * a) * g + f * g]
    found = with_common_factors(graph, outputs)
    assert multiplications(found) < multiplications(outputs)
    assert values(found) == pytest.approx(values(outputs))


def test_products_that_are_needed_elsewhere_stay(graph: Graph) -> None:
    a, b, f, x, *_ = symbols(graph)
    product = a * f
    outputs = [product + b * f, product * x]
    assert with_common_factors(graph, outputs) == outputs


def test_sums_beyond_the_limit_stay(graph: Graph) -> None:
    f = graph.symbol("f")
    terms = [graph.symbol(f"s{k}") * f for k in range(MOST_TERMS + 1)]
    assert with_common_factors(graph, [graph.sum(terms)]) == [graph.sum(terms)]
    (shorter,) = with_common_factors(graph, [graph.sum(terms[:-1])])
    assert multiplications([shorter]) == 1


def test_a_factor_of_several_values_is_multiplied_in_once(graph: Graph) -> None:
    a, b, c, f, g, _, k, x, y, z = symbols(graph)
    first, second = f * (a + x), f * (b + y)
    outputs = [z - k * (x * first + y * second), c + k * (second / (x * x + g))]
    found = with_late_factors(graph, Factoring(graph, [f, k]), outputs)
    assert multiplications(found) == multiplications(outputs) - 1
    assert values(found) == pytest.approx(values(outputs))


def test_a_factor_stays_where_values_are_added_to_others(graph: Graph) -> None:
    a, b, _, f, *_ = symbols(graph)
    outputs = [f * a + b, f * b + a]
    assert with_late_factors(graph, Factoring(graph, [f]), outputs) == outputs


def test_results_and_divisors_get_their_factor_back(graph: Graph) -> None:
    a, b, c, f, g, _, k, x, y, _ = symbols(graph)
    first, second, third = f * (a + x), f * (b + y), f * (c + g)
    outputs = [k * (x * first), k * (y * second), k * third, first, graph.one / second]
    for regroup in (with_late_factors, grouped):
        found = regroup(graph, Factoring(graph, [f, k]), outputs)
        assert cost(found).weight <= cost(outputs).weight
        assert values(found) == pytest.approx(values(outputs))


def test_an_operation_made_twice_counts_once(graph: Graph) -> None:
    a, b, f, g, *_ = symbols(graph)
    twin = graph.raw("mul", (f, g))  # before the constructors know it
    outputs = [a * twin, b * (f * g)]
    assert multiplications(outputs) == 4
    assert multiplications(grouped(graph, Factoring(graph, [f, g]), outputs)) == 3


def test_a_parameter_is_multiplied_early_where_its_products_exist(graph: Graph) -> None:
    """p (x a + y b) beside p x and p y needs no product with p of its own; q p x beside p x needs no q p."""
    a, b, _, f, g, h, k, x, y, _ = symbols(graph)
    factoring = Factoring(graph, (f, g))
    outputs = [f * x + a, f * y + b, f * (x * h + y * k), (g * f) * x, (f / (h * k)) * (x - y)]
    assert early_factors(factoring, outputs) == [f]
    found = with_early_factor(graph, factoring, outputs, f)
    assert multiplications(found) == multiplications(outputs) - 2
    assert values(found) == pytest.approx(values(outputs))


def test_what_has_no_product_with_a_parameter_keeps_it(graph: Graph) -> None:
    a, b, _, f, _, h, k, x, y, _ = symbols(graph)
    factoring = Factoring(graph, (f,))
    outputs = [f * x + a, f * (x * h + y * k), f * b]
    assert with_early_factor(graph, factoring, outputs, f) == outputs
