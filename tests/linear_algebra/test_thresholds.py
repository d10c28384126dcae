"""What is taken for a lost direction: numbers of docs/theory.md, beside which kernels decide on a status."""

from __future__ import annotations

import pytest

from symgen.ir.kernel import UNIT_ROUNDOFF, Status
from symgen.linear_algebra.constrained_inverse import diagonal_sizes
from symgen.linear_algebra.guards import Guard, multiplied
from symgen.linear_algebra.null_space.null_spaces import MinorSpace
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
