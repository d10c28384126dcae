"""The point nearest to 0 of what linear limits leave, in any number of directions: a quadratic program without a loop.

Limits are taken in one after the other (incremental insertion; Seidel, Small-dimensional linear programming and convex
hulls made easy, 1991, which holds for the nearest point of a convex set as it does for a linear program).  Where the
nearest point so far violates the next limit, the one that keeps this one too lies where it is reached: a plane, on
which the limits before make the same problem with one direction less.  Along one direction they leave an interval.  All
planes are worked out at every state and one is taken, so that the code has no branch and the same cost everywhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.linear_algebra.reflections import Reflections
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar

# Below this an input takes no part in the internal force; quotients by it are finite in float32, too.
NO_PART = Fraction(1, 10**30)
# Of what it changes by at most along internal forces of norm 1: an input that these change by less takes no part in
# them.  Rounding leaves 1e-7 of none in float32; to reach a limit so would take ten thousand times what is missing.
TAKES_PART = Fraction(1, 10_000)
# A share of the internal force that no limits reach; float32 takes it apart into two halves, too.
NO_LIMIT = Fraction(10**30)


@dataclass(frozen=True, slots=True)
class Slab:
    """lower <= start + slopes . c <= upper for a point c; slopes shorter than `least` are 0 but for rounding."""

    lower: Scalar
    upper: Scalar
    start: Scalar
    slopes: Vector
    least: Scalar


def nearest_within(graph: Graph, slabs: Sequence[Slab], directions: int) -> Vector:
    """The point (directions) nearest to 0 within all slabs; where there is none, one that violates some of them."""
    slabs = [slab for slab in slabs if any(not slope.is_zero for slope in slab.slopes)]
    if directions == 1:
        ends = [interval(graph, slab) for slab in slabs]
        return (nearest_of(graph, ends, graph.zero),)
    nearest: Vector = (graph.zero,) * directions
    for k, slab in enumerate(slabs):
        value = slab.start + dot(graph, slab.slopes, nearest)
        reached = larger(graph, slab.lower, smaller(graph, slab.upper, value))
        on_it = _on_plane(graph, slab, reached, slabs[:k], directions)
        length = dot(graph, slab.slopes, slab.slopes)
        taken = _exceeds(graph, length, slab.least * slab.least)
        if k > 0:  # before there is a limit the point is 0, and stays there where it is inside
            taken = taken * _exceeds(graph, graph.function("abs", (reached - value,)), graph.const(NO_PART))
        nearest = tuple(taken * a + (1 - taken) * b for a, b in zip(on_it, nearest, strict=True))
    return nearest


def _on_plane(graph: Graph, slab: Slab, value: Scalar, before: Sequence[Slab], directions: int) -> Vector:
    """The point nearest to 0 where a slab has a value and the slabs before are kept.

    In axes of which the first is along the slopes the plane is a value of the first coordinate.
    """
    turned = Reflections(graph, (slab.slopes,), directions, everywhere=True)
    (slope,) = (column[0] for column in turned.triangle)
    first = (value - slab.start) * _reciprocal(graph, slope, slab.least)[0]
    left: list[Slab] = []
    for other in before:
        along, *across = turned.apply_transposed(other.slopes)
        left.append(replace(other, start=other.start + along * first, slopes=tuple(across)))
    return turned.apply((first, *nearest_within(graph, left, directions - 1)))


def interval(graph: Graph, slab: Slab) -> tuple[Scalar, Scalar]:
    """The points c of a line within a slab: all of them for a slope that is 0."""
    reciprocal, apart = _reciprocal(graph, slab.slopes[0], slab.least)
    ends = [(limit - slab.start) * reciprocal for limit in (slab.lower, slab.upper)]
    beyond = apart * NO_LIMIT
    return smaller(graph, *ends) - beyond, larger(graph, *ends) + beyond


def nearest_of(graph: Graph, intervals: Iterable[tuple[Scalar, Scalar]], share: Scalar) -> Scalar:
    """The share nearest to a given one within all intervals; the given one where there are none.

    The middle one of it and the ends of what they have in common is the nearest point.  Where they contradict each
    other the ends have changed places, and between them no limit gains without another's loss.
    """
    given = list(intervals)
    if not given:
        return share
    bottom, top = given[0]
    for low, high in given[1:]:
        bottom, top = larger(graph, bottom, low), smaller(graph, top, high)
    above, below = larger(graph, bottom, top), smaller(graph, bottom, top)
    return larger(graph, below, smaller(graph, above, share))


def _reciprocal(graph: Graph, slope: Scalar, least: Scalar) -> tuple[Scalar, Scalar]:
    """1 / slope, or 0 for one that is below the least, and 1 for those that are."""
    size = graph.function("abs", (slope,))
    apart = _exceeds(graph, least, size)
    return (1 - apart) / graph.function("copysign", (larger(graph, size, least), slope)), apart


def _exceeds(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    """1 where a is not less than b, else 0."""
    return (1 + graph.function("copysign", (graph.one, a - b))) / 2


def smaller(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    """The smaller one."""
    return graph.function("min", (a, b))


def larger(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    """The larger one."""
    return graph.function("max", (a, b))
