"""Square systems A x = b by reflections of the unknowns, sparse rows first, the last rows by minors.

A reflection that brings a row to one entry mixes only the unknowns that the row holds: a platform's balance of moments
about the head of a leg does not hold that leg.  det(A)^2 is the product of the squared pivots and of the squared
determinant of what is left, so that every denominator vanishes only where A is singular.  Rows keep to themselves, and
minors have one factor of each: small rows keep their digits beside large ones, as they would not if the equations were
reflected (Golub and Van Loan, Matrix Computations, 5.2; Higham, Accuracy and Stability of Numerical Algorithms, 19.4).
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.linear_algebra.exterior import cross_product
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.scalar import Scalar

# Rows up to which a square system is solved by minors.
LARGEST_SQUARE_BY_MINORS = 3


@dataclass(frozen=True, slots=True)
class Solution:
    """x, factors whose product is det(A)^2, and the squared lengths of the rows, whose product bounds it."""

    values: Vector
    squares: Vector
    lengths: Vector


@dataclass(frozen=True, slots=True)
class _Reflection:
    """Turns a row y into s |y| in one of its columns, the first; s is the sign of the entry there.

    With e = y / (s |y|) another row a gets e.a there and a_i - f_i (a_1 + e.a) elsewhere, f_i = y_i / (y_1 + s |y|).
    """

    columns: tuple[int, ...]
    along: Vector
    across: Vector
    inverse: Scalar
    square: Scalar

    @classmethod
    def of(cls, graph: Graph, row: Sequence[Scalar], columns: Sequence[int], everywhere: bool) -> _Reflection:
        """The one for the entries of a row in these columns, which are not all that may be 0.

        With `everywhere` a row of zeros divides nothing by 0.
        """
        held = tuple(j for j in columns if not row[j].is_zero)
        first, *others = (row[j] for j in held)
        square = graph.sum(row[j] * row[j] for j in held)
        # a column alone stays as it is
        signed = graph.function("copysign", (graph.function("sqrt", (square,)), first)) if others else first

        def inverted(x: Scalar) -> Scalar:
            return graph.function("ratio_or_zero", (graph.one, x)) if everywhere else 1 / x

        inverse = inverted(signed)
        if not others:
            return cls(held, (graph.one,), (), inverse, square)
        slope = inverted(first + signed)
        return cls(held, tuple(row[j] * inverse for j in held), tuple(y * slope for y in others), inverse, square)

    def turn(self, graph: Graph, row: list[Scalar]) -> None:
        """Another row for the turned unknowns."""
        given = [row[j] for j in self.columns]
        if not self.across or all(entry.is_zero for entry in given):
            return
        first, *others = self.columns
        row[first] = dot(graph, self.along, given)
        share = given[0] + row[first]
        for j, f in zip(others, self.across, strict=True):
            row[j] = row[j] - f * share

    def unknowns(self, graph: Graph, values: dict[int, Scalar]) -> None:
        """The unknowns from the turned ones."""
        if not self.across:
            return
        first, *others = self.columns
        taken = dot(graph, self.across, [values[j] for j in others])
        share = taken - values[first]
        values[first] = -(self.along[0] * share + taken)
        for j, e in zip(others, self.along[1:], strict=True):
            values[j] = values[j] - e * share


def by_rows(graph: Graph, matrix: Matrix, right: Vector, everywhere: bool = False) -> Solution:
    """The solution of a square system with more than `LARGEST_SQUARE_BY_MINORS` rows.

    With `everywhere` rows that depend on each other exactly divide by 0 in nothing but the last determinant.
    """
    size = len(matrix)
    left = {i: list(row) for i, row in enumerate(matrix)}
    columns, turned = list(range(size)), list[_Reflection]()
    values, lengths = dict[int, Scalar](), list[Scalar]()
    while len(left) > LARGEST_SQUARE_BY_MINORS:
        i = min(left, key=lambda i: sum(not left[i][j].is_zero for j in columns))
        row = left.pop(i)
        reflection = _Reflection.of(graph, row, columns, everywhere)
        before = [other.columns[0] for other in turned]
        lengths.append(graph.sum([*(row[j] * row[j] for j in before), reflection.square]))
        taken = graph.sum(row[j] * values[j] for j in before)
        values[reflection.columns[0]] = (right[i] - taken) * reflection.inverse
        for other in left.values():
            reflection.turn(graph, other)
        turned.append(reflection)
        columns.remove(reflection.columns[0])
    rests = [right[i] - graph.sum(row[j] * x for j, x in values.items()) for i, row in left.items()]
    bordered = [(*(row[j] for j in columns), rest) for row, rest in zip(left.values(), rests, strict=True)]
    *minors, determinant = cross_product(graph, tuple(bordered), LARGEST_SQUARE_BY_MINORS + 1)
    inverse = 1 / determinant
    values |= {j: -minor * inverse for j, minor in zip(columns, minors, strict=True)}
    for reflection in reversed(turned):
        reflection.unknowns(graph, values)
    lengths += [dot(graph, matrix[i], matrix[i]) for i in left]
    squares = [*(reflection.square for reflection in turned), determinant * determinant]
    return Solution(tuple(values[j] for j in range(size)), tuple(squares), tuple(lengths))
