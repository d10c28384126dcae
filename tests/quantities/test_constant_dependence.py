"""The numbers with which rows are sums of each other everywhere, as fractions."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest

from symgen.quantities.constant_dependence import numbers_of_dependent_rows, projector
from symgen.symbolic.graph import Graph

ONE = Fraction(1)


def test_as_many_points_are_taken_as_rows_need() -> None:
    """Of one column three points leave two numbers of five undetermined: one of them is none."""
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    rows = tuple((entry,) for entry in (x, y, x * y, x * x, 3 * x))
    (numbers,) = numbers_of_dependent_rows(rows, [ONE] * 5)
    assert [number / numbers[4] for number in numbers] == [-3, 0, 0, 0, 1]
    assert numbers_of_dependent_rows(rows[:4], [ONE] * 4) == ()


def test_rows_stand_times_their_factors() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.trig("sin", graph.symbol("y"))
    rows = (8 * x, 8 * y), (y / 2, x / 2), (x + Fraction(2, 7) * y, y + Fraction(2, 7) * x)
    (numbers,) = numbers_of_dependent_rows(rows, [Fraction(8), Fraction(1, 2), ONE])
    assert [number / numbers[2] for number in numbers] == [-1, Fraction(-2, 7), 1]


@pytest.mark.parametrize(("digits", "known"), [(20, True), (21, False)])
def test_numbers_are_short_fractions(digits: int, known: bool) -> None:
    """A residue at random is one of numerator and denominator twice as long as these."""
    graph = Graph()
    x = graph.symbol("x")
    basis = numbers_of_dependent_rows(((x,), ((10**digits - 1) * x,)), [ONE, ONE])
    assert [[a / b for a, b in pairwise(one)] for one in basis] == [[1 - 10**digits]] * known


def test_what_is_at_right_angles_to_the_numbers_stays() -> None:
    basis = (Fraction(1), Fraction(2), Fraction(2)), (Fraction(0), Fraction(1), Fraction(1))
    made = projector(basis)
    assert made == ((0, 0, 0), (0, Fraction(1, 2), Fraction(-1, 2)), (0, Fraction(-1, 2), Fraction(1, 2)))
