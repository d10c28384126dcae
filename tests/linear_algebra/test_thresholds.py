"""What is taken for a lost direction: numbers of docs/theory.md, beside which kernels decide on a status."""

from __future__ import annotations

import pytest

from symgen.ir.kernel import UNIT_ROUNDOFF, Status
from symgen.linear_algebra.constrained_inverse import diagonal_sizes
from symgen.linear_algebra.guards import Guard, multiplied
from symgen.linear_algebra.null_space.null_spaces import MinorSpace
from symgen.linear_algebra.orthogonal import WeightedGramSchmidt
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph

EPS = UNIT_ROUNDOFF["float32"]


@pytest.mark.parametrize(
    ("directions", "n", "lost"),
    [(1, 7, 56), (1, 20, 160), (2, 12, 16), (3, 20, 20), (6, 20, 20), (3, 7, 8), (2, 3, 8)],
)
def test_one_direction_is_lost_below_8_n_eps_and_a_determinant_of_several_below_less(
    directions: int, n: int, lost: int
) -> None:
    """Down to n eps, and to what rounding leaves of one that is 0: 8 eps."""
    graph = Graph()
    guards = [Guard(Status.CONSTRAINT_RANK, graph.symbol("d"), degree, directions=directions) for degree in (1, 2)]
    assert [guard.threshold(n, EPS) for guard in guards] == [lost * EPS, (lost * EPS) ** 2]


def test_of_several_steps_what_one_loses_ordinarily_hardly_counts() -> None:
    """Of shares of 1/10 and 1/2 0.4 and 6/7 are kept: the product says what is lost only where one share is small."""
    graph = Graph()
    pivots = [graph.symbol(name) for name in "ab"]
    (guard,) = multiplied(Status.CONSTRAINT_RANK, pivots, [graph.const(2), graph.const(4)])
    (ordinary, lost) = (Evaluator([guard.denominator])(at)[0] for at in ({"a": 0.2, "b": 2.0}, {"a": 2e-9, "b": 2.0}))
    assert ordinary == pytest.approx(0.4 * 6 / 7)
    assert lost == pytest.approx(6e-9 * 6 / 7)


def left_of_three(x: float, y: float, faint: float = 1.0, few: bool = False) -> float:
    """What is compared for the columns (1, 0, x), (0, 1, y) and (1, 1, 1), beside its scale; all weights are 1.

    The first one is `faint` times that; `few` rows are those that something else tells the ranks of.
    """
    graph = Graph()
    one, zero, t = graph.one, graph.zero, graph.symbol("t")
    columns = (t, zero, t * graph.symbol("x")), (zero, one, graph.symbol("y")), (one, one, one)
    causes = (Guard(Status.CONSTRAINT_RANK, t, 2),) if few else ()
    *before, guard = WeightedGramSchmidt(graph, columns, (one, one, one)).regularity(causes)
    assert [one.scale for one in before] == [one.denominator for one in before]
    assert guard.scale is not None
    left, scale = Evaluator([guard.denominator, guard.scale])({"t": faint, "x": x, "y": y})
    return left / scale


def test_orthogonal_columns_are_tested_by_what_is_left_of_each_beside_its_length() -> None:
    x, y = 0.5, 0.25
    second = 1 + y * y - (x * y) ** 2 / (1 + x * x)
    third = (1 - x - y) ** 2 / ((1 + x * x) * second)  # by the determinant
    shares = [left / length for left, length in ((second, 1 + y * y), (third, 3))]
    kept = [6 * share / (1 + 5 * share) for share in shares]
    assert left_of_three(x, y) == pytest.approx(kept[0] * kept[1], rel=1e-12)


def test_a_row_of_few_that_is_lost_counts_for_its_share_of_all_that_it_is_made_of() -> None:
    """Of three rows for a third of s in place of 6 s."""
    assert left_of_three(0.5, 0.25, few=True) == pytest.approx(left_of_three(0.5, 0.25) / 18, rel=1e-12)


def test_columns_that_all_but_depend_on_each_other_are_beneath_any_threshold_of_float32() -> None:
    assert left_of_three(0.5, 0.5 - 1e-8) < (8 * 3 * EPS) ** 2 < left_of_three(0.5, 0.499)


@pytest.mark.parametrize("few", [False, True])
@pytest.mark.parametrize("faint", [1e-16, 1e-6, 1e6, 1e16])
def test_a_row_counts_the_same_however_short_it_is_beside_the_others(faint: float, few: bool) -> None:
    """One that all but vanishes leaves others what they have, and is missed where another follows from it."""
    assert left_of_three(0.5, 0.25, faint, few) == pytest.approx(left_of_three(0.5, 0.25, few=few), rel=1e-9)
    assert left_of_three(0.5, 0.5 - 1e-8, faint, few) < (8 * 3 * EPS) ** 2


def test_a_row_that_vanishes_is_taken_for_a_millionth_of_the_others() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    rows = (x, graph.zero, graph.one), (2 * x, graph.zero, graph.const(2)), (y, y, graph.zero)
    space = MinorSpace(graph, rows, 3, 2)
    lengths = Evaluator(space.lengths)({"x": 1.0, "y": 0.0})
    assert lengths == pytest.approx([2 + 10 * 2**-40, 8 + 10 * 2**-40, 10 * 2**-40], rel=1e-14)


def test_an_inertia_that_is_a_rest_of_its_terms_is_measured_by_a_share_of_these() -> None:
    """(1 - cos x)^2 at 0, of terms that are 4 there."""
    graph = Graph()
    rest = 1 - graph.trig("cos", graph.symbol("x"))
    (size,) = diagonal_sizes(graph, ((rest * rest,),))
    (at_0, elsewhere) = (Evaluator([size])({"x": x})[0] for x in (0.0, 1.5))
    assert at_0 == pytest.approx(4 * 2**-28)
    assert elsewhere == pytest.approx((1 - 0.0707372016677029) ** 2, rel=1e-7)


def test_an_inertia_that_adds_up_is_measured_by_itself() -> None:
    graph = Graph()
    entry = graph.symbol("J") + graph.symbol("m") * graph.symbol("l") * graph.symbol("l")
    assert diagonal_sizes(graph, ((entry,),), lambda _: True) == [entry]
    assert diagonal_sizes(graph, ((entry,),)) != [entry]
