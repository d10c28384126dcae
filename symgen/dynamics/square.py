"""Square systems A x = b by reflections of the equations, column by column, the last rows by minors.

Reflections of the unknowns' space, which take the rows of A as vectors, touch all columns at each step.  Reflections of
the equations touch only those in which the column has entries: a force at the point that moments are taken about has
three.  The column with the fewest is next.  Orthogonal steps leave det(A)^2 the product of the squared pivots and of
the squared determinant of what is left: every denominator vanishes only where A is singular (Golub and Van Loan, Matrix
Computations, 5.2; a column y becomes -sign(y_1) |y| e_1 without ever storing a reflector).
"""

from __future__ import annotations

from symgen.dynamics.exterior import cross_product
from symgen.graph.matrix import Matrix, Vector, dot
from symgen.graph.scalar import Graph, Scalar
from symgen.records import dataclass

# What is left when this many rows are is solved by minors.
LAST = 4


@dataclass(frozen=True, slots=True)
class Solution:
    """x, and factors whose product is det(A)^2."""

    values: Vector
    squares: Vector


def by_columns(graph: Graph, matrix: Matrix, right: Vector) -> Solution:
    """The solution of a square system with more than `LAST` rows."""
    size = len(matrix)
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    columns, squares = list(range(size)), list[Scalar]()
    solved: list[tuple[int, list[Scalar], Scalar]] = []
    while len(rows) > LAST:
        column = min(columns, key=lambda j: sum(not row[j].is_zero for row in rows))
        columns.remove(column)
        held = [row for row in rows if not row[column].is_zero]
        rows = [row for row in rows if row[column].is_zero]
        pivot_row, inverse, square, turned = _reflected(graph, held, column, [*columns, size])
        rows += turned
        solved.append((column, pivot_row, inverse))
        squares.append(square)
    left = [[*(row[j] for j in columns), row[size]] for row in rows]
    *minors, determinant = cross_product(graph, tuple(map(tuple, left)), LAST + 1)
    inverse = 1 / determinant
    found = {j: -minor * inverse for j, minor in zip(columns, minors, strict=True)}
    for column, row, inverse in reversed(solved):
        taken = graph.sum(row[j] * x for j, x in found.items() if not row[j].is_zero)
        found[column] = (row[size] - taken) * inverse
    return Solution(tuple(found[j] for j in range(size)), (*squares, determinant * determinant))


def _reflected(
    graph: Graph, rows: list[list[Scalar]], column: int, others: list[int]
) -> tuple[list[Scalar], Scalar, Scalar, list[list[Scalar]]]:
    """The row that keeps the column, 1 over its pivot, the square of that, and the rows that lose it.

    With y the column, s the sign of its first entry and e = y/|y|, another column a becomes s e.a (the sign of the row
    is free) and a_i - y_i (a_1 + s e.a)/(y_1 + s |y|).
    """
    entries = [row[column] for row in rows]
    if len(rows) == 1:
        return rows[0], 1 / entries[0], entries[0] * entries[0], []
    square = graph.sum(y * y for y in entries)
    length = graph.function("sqrt", (square,))
    signed = graph.function("copysign", (length, entries[0]))
    inverse, slope = 1 / signed, 1 / (entries[0] + signed)
    along = [y * inverse for y in entries]
    across = [y * slope for y in entries[1:]]
    pivot_row, turned = list(rows[0]), [list(row) for row in rows[1:]]
    for j in others:
        given = [row[j] for row in rows]
        if all(a.is_zero for a in given):
            continue
        pivot_row[j] = dot(graph, along, given)
        share = given[0] + pivot_row[j]
        for row, y in zip(turned, across, strict=True):
            row[j] = row[j] - y * share
    # e.y = s |y|
    return pivot_row, inverse, square, turned
