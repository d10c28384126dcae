"""What single precision can tell from rounding: denominators at ordinary states, beside their thresholds."""

from __future__ import annotations

import pytest

from symgen.ir.kernel import UNIT_ROUNDOFF, Status
from symgen.linear_algebra.guards import Guard
from symgen.symbolic.graph import Graph
from symgen.validity.resolution import distinguishable

N = 4
# Of one direction among N, in its length; 8 n eps.
THRESHOLD = 8 * N * float(UNIT_ROUNDOFF["float32"])


@pytest.mark.parametrize(
    ("degree", "times", "plain"), [(1, 9.9, False), (1, 10.1, True), (2, 99.0, False), (2, 101.0, True)]
)
def test_a_denominator_is_ten_thresholds_large_at_some_state(degree: int, times: float, plain: bool) -> None:
    graph = Graph()
    guard = Guard(Status.CONSTRAINT_RANK, graph.symbol("d"), degree, scale=graph.symbol("length"))
    at = {"d": 3 * times * THRESHOLD**degree, "length": 3.0}
    nowhere = {"d": 0.0, "length": 3.0}
    assert distinguishable([guard], N, [nowhere, at]) is plain
    assert not distinguishable([guard], N, [nowhere])


def test_every_denominator_is_and_terms_that_cancel_count() -> None:
    graph = Graph()
    d, far = graph.symbol("d"), graph.symbol("far")
    whole = Guard(Status.CONSTRAINT_RANK, d, 1)
    rest = Guard(Status.CONSTRAINT_RANK, graph.raw("sub", (graph.raw("add", (d, far)), far)), 1)
    points = [{"d": 1.0, "far": 1e3}, {"d": 1.0, "far": 1e7}]
    assert distinguishable([whole], N, points[1:])
    assert distinguishable([whole, rest], N, points)
    assert not distinguishable([whole, rest], N, points[1:])


def test_what_is_to_be_small_is_no_denominator() -> None:
    graph = Graph()
    guard = Guard(Status.CONSTRAINT_RANK, graph.symbol("d"), 1, scale=graph.one, small=True)
    assert distinguishable([guard], N, [{"d": 0.0}])
