"""Sums of squared minors of a size: every minor where they are few, else of the matrix brought to two diagonals.

Of columns that are orthogonal they are sums of products of squared lengths, which is the most they can be.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from symgen.linear_algebra.blocks import components
from symgen.linear_algebra.exterior import small_family, square, unit, wedge_all
from symgen.linear_algebra.reflections import Reflections
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, transpose
from symgen.symbolic.scalar import Scalar


def squared_minors(graph: Graph, columns: Sequence[Vector], degree: int) -> Scalar:
    """The sum of the squared minors of that size: all of them where they are few, else by blocks of columns."""
    if small_family([[0]], columns, degree):
        return graph.sum(
            square(graph, wedge_all(unit(graph), [columns[k] for k in subset]))
            for subset in combinations(range(len(columns)), degree)
        )
    # those of columns that share no coordinate multiply
    sums = [graph.one, *(graph.zero for _ in range(degree))]
    for block in components(transpose(tuple(columns), len(columns[0]))):
        if not block.columns:
            continue  # a coordinate that no column has an entry for
        own = _of_block(graph, tuple(columns[k] for k in block.columns), degree)
        sums = [graph.sum(sums[k - i] * x for i, x in enumerate(own[: k + 1])) for k in range(degree + 1)]
    return sums[degree]


def _of_block(graph: Graph, columns: Matrix, degree: int) -> list[Scalar]:
    """The sums of each size up to `degree`, none of which subtracts.

    A minor of a matrix of two diagonals is one product of entries in different rows and columns, and entries that may
    stand together are those that are no neighbours on the way d_1, f_1, d_2, f_2, ...
    """
    rows = [row for row in transpose(tuple(columns), len(columns[0])) if not all(entry.is_zero for entry in row)]
    before, sums = [graph.one], [graph.one]
    for weight in _two_diagonals(graph, min(columns, tuple(rows), key=len)):
        taken = [graph.zero, *(weight * x for x in before)]
        kept = [*sums, *(graph.zero for _ in taken[len(sums) :])]
        before, sums = sums, [a + b for a, b in zip(kept, taken, strict=True)][: degree + 1]
    return sums


def _two_diagonals(graph: Graph, columns: Matrix) -> list[Scalar]:
    """d_1^2, f_1^2, d_2^2, ... of a matrix, by reflections from both sides (Golub and Van Loan, 5.4)."""
    squares: list[Scalar] = []
    left = list(columns)
    while left:
        turn = Reflections(graph, left[:1], len(left[0]), everywhere=True)
        squares += turn.pivots
        rows = transpose(tuple(map(turn.apply_transposed, left[1:])), len(left[0]))
        if not rows or not rows[0]:
            break
        turn = Reflections(graph, rows[:1], len(rows[0]), everywhere=True)
        squares += turn.pivots
        left = list(transpose(tuple(map(turn.apply_transposed, rows[1:])), len(rows[0])))
        left = [column for column in left if column]
    return squares


def elementary_symmetric(graph: Graph, values: Sequence[Scalar], degree: int) -> Scalar:
    """The sum of the products of `degree` of the values."""
    sums = [graph.one, *(graph.zero for _ in range(degree))]
    for value in values:
        sums = [sums[0], *(sums[k] + value * sums[k - 1] for k in range(1, degree + 1))]
    return sums[degree]
