"""Sums of squared minors keep their digits, where many are summed and where columns nearly depend on each other."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import combinations

import pytest
from flint import fmpq, fmpq_mat

from symgen.linear_algebra.exterior import small_family
from symgen.linear_algebra.minor_sums import squared_minors
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph


def exactly(columns: list[list[float]], degree: int) -> Fraction:
    """The sum of the squares of all minors of that size."""
    total = fmpq(0)
    for chosen in combinations(columns, degree):
        for rows in combinations(range(len(columns[0])), degree):
            entries = [Fraction(column[i]) for column in chosen for i in rows]
            minor = fmpq_mat(degree, degree, [fmpq(x.numerator, x.denominator) for x in entries]).det()
            total += minor * minor
    return Fraction(int(total.p), int(total.q))


@pytest.mark.parametrize(("rows", "number", "degree", "near"), [(7, 9, 5, 1.0), (9, 10, 7, 1e-2), (8, 8, 6, 1e-3)])
def test_no_digit_is_lost_between_many_minors(rows: int, number: int, degree: int, near: float) -> None:
    source, graph = random.Random(rows), Graph()
    common = [source.uniform(-1, 1) for _ in range(rows)]
    columns = [[x + near * source.uniform(-1, 1) for x in common] for _ in range(number)]
    # a column of its own, and one that shares no coordinate with the others
    columns[-1] = [0.0] * (rows - 1) + [0.7]
    columns = [[*column[:-1], 0.0] if column is not columns[-1] else column for column in columns]
    symbols = [
        tuple(graph.symbol(f"x{i}_{k}") if column[i] else graph.zero for i in range(rows))
        for k, column in enumerate(columns)
    ]
    assert not small_family([[0]], symbols, degree)
    point = {f"x{i}_{k}": column[i] for k, column in enumerate(columns) for i in range(rows) if column[i]}
    (total,) = Evaluator([squared_minors(graph, symbols, degree)])(point)
    meant = exactly(columns, degree)
    # directions that are `near` apart are known to as many digits less
    assert abs(Fraction(total) - meant) <= Fraction(200 * 2**-53 / near) * meant


def test_coordinates_without_entries_change_nothing() -> None:
    graph = Graph()
    inner = [tuple(graph.symbol(f"x{i}_{k}") for i in range(6)) for k in range(8)]
    columns = [(graph.zero, *column, graph.zero) for column in inner]
    point = {f"x{i}_{k}": ((3 * i + 5 * k + i * k) % 11 - 5.5) / 7 for i in range(6) for k in range(8)}
    assert not small_family([[0]], columns, 4)
    (padded,) = Evaluator([squared_minors(graph, columns, 4)])(point)
    (alone,) = Evaluator([squared_minors(graph, inner, 4)])(point)
    assert padded == alone > 0


def test_columns_that_depend_on_each_other_have_no_minors() -> None:
    graph = Graph()
    column = tuple(graph.symbol(f"x{i}") for i in range(12))
    columns = [tuple(x * (k + 1) for x in column) for k in range(12)]
    point = {f"x{i}": 0.1 * i - 0.55 for i in range(12)}
    (total,) = Evaluator([squared_minors(graph, columns, 4)])(point)
    assert 0 <= total < 1e-30
