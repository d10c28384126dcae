"""The angle of half a turn's tangent by products, quotients and roots: the same bits on every machine, as sines have.

atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))): two of these steps leave |t| <= tan(pi/16) of one that is at most 1, where
TERMS terms of Gregory's series leave out less than 2^-60 of the sum.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

# Halvings of the angle before the series is summed.
HALVINGS = 2
# Terms of the series.
TERMS = 12


def turn_of(graph: Graph, tangent: Scalar) -> Scalar:
    """2 atan(t), the turn with the tangent t of its half, for -1 <= t <= 1: up to a quarter turn to either side."""
    for _ in range(HALVINGS):
        tangent = tangent / (1 + graph.function("sqrt", (1 + tangent * tangent,)))
    square = tangent * tangent
    total = graph.const(_coefficient(TERMS - 1))
    for k in reversed(range(TERMS - 1)):
        total = total * square + _coefficient(k)
    return tangent * total


def _coefficient(k: int) -> Fraction:
    """Of t^(2 k + 1), for twice the angle that is left after halving."""
    return Fraction((-1) ** k * 2 ** (HALVINGS + 1), 2 * k + 1)
