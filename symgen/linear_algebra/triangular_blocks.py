"""Square systems in blocks that are solved one after the other, as legs of a machine are once its platform is known.

Rows and columns are matched to each other, and those that depend on each other in a circle are one block (Duff and
Reid, An implementation of Tarjan's algorithm for the block triangularization of a matrix; Davis, Direct Methods for
Sparse Linear Systems, ch. 7).  Only what a block divides by can vanish: its determinant, or the pivots of its rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import cross_product
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.square import LARGEST_SQUARE_BY_MINORS, by_rows
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.passes.factoring import LONGEST_CANCELLED
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class DiagonalBlock:
    """Rows of a matrix and the columns of the unknowns that they are solved for."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


def triangular_blocks(filled: Sequence[Sequence[bool]]) -> tuple[DiagonalBlock, ...] | None:
    """The blocks in the order in which they are solved, of a square pattern; None where no values make it regular."""
    column_of = _matched(filled)
    if column_of is None:
        return None
    row_of = {column: row for row, column in column_of.items()}
    below = {
        row: [row_of[j] for j, there in enumerate(entries) if there and row_of[j] != row]
        for row, entries in enumerate(filled)
    }
    circles = _circles(below)
    return tuple(DiagonalBlock(tuple(rows), tuple(column_of[row] for row in rows)) for rows in circles)


def _matched(filled: Sequence[Sequence[bool]]) -> dict[int, int] | None:
    """A column for each row, by augmenting paths."""
    row_of: dict[int, int] = {}

    def placed(row: int, seen: set[int]) -> bool:
        for column, there in enumerate(filled[row]):
            if there and column not in seen:
                seen.add(column)
                if column not in row_of or placed(row_of[column], seen):
                    row_of[column] = row
                    return True
        return False

    if not all(placed(row, set()) for row in range(len(filled))):
        return None
    return {row: column for column, row in row_of.items()}


def _circles(below: dict[int, list[int]]) -> list[list[int]]:
    """The strongly connected parts, each after all that it leads to (Tarjan)."""
    number: dict[int, int] = {}
    lowest: dict[int, int] = {}
    open_: list[int] = []
    circles: list[list[int]] = []

    def visit(row: int) -> None:
        number[row] = lowest[row] = len(number)
        open_.append(row)
        for other in below[row]:
            if other not in number:
                visit(other)
            if other in open_:
                lowest[row] = min(lowest[row], lowest[other])
        if lowest[row] == number[row]:
            start = open_.index(row)
            circles.append(sorted(open_[start:]))
            del open_[start:]

    for row in below:
        if row not in number:
            visit(row)
    return circles


class BlockwiseSolution:
    """A matrix that is solved block by block.

    Determinants are multiplied out by `cancel`: what vanishes at a singularity is a factor then, not a difference.
    """

    def __init__(
        self, graph: Graph, matrix: Matrix, blocks: Sequence[DiagonalBlock], cancel: Callable[[Scalar], Scalar]
    ) -> None:
        self._graph, self._matrix, self._blocks, self._cancel = graph, matrix, tuple(blocks), cancel

    def solve(self, right: Sequence[Scalar]) -> Vector:
        """x with A x = right."""
        known: dict[int, Scalar] = {}
        for block in self._blocks:
            rests = [
                right[i] - self._graph.sum(self._matrix[i][j] * x for j, x in known.items()) for i in block.rows
            ]
            known |= zip(block.columns, self._solved(block, rests), strict=True)
        return tuple(known[j] for j in range(len(right)))

    def guards(self, status: Status, first: tuple[Guard, ...]) -> tuple[Guard, ...]:
        """Where a block is singular; `first` are causes that are told instead."""
        of_blocks = []
        for block in self._blocks:
            if len(block.rows) <= LARGEST_SQUARE_BY_MINORS:
                determinant = self._bordered(block, [self._graph.zero] * len(block.rows))[-1]
                if determinant.op not in ("add", "sub"):
                    # of a product the bounds of its factors are near
                    of_blocks.append(Guard(status, determinant, 1, first, directions=len(block.rows)))
                    continue
                square = determinant * determinant
                lengths: Iterable[Scalar] = (dot(self._graph, row, row) for row in self._entries(block))
            else:
                one = by_rows(self._graph, self._entries(block), (self._graph.zero,) * len(block.rows))
                square, lengths = self._graph.product(one.squares), one.lengths
            # no determinant is more than the lengths of its rows multiplied
            bound = self._graph.product(lengths)
            of_blocks.append(Guard(status, square, 2, first, bound, directions=len(block.rows)))
        return tuple(of_blocks)

    def _entries(self, block: DiagonalBlock) -> Matrix:
        return tuple(tuple(self._matrix[i][j] for j in block.columns) for i in block.rows)

    def _bordered(self, block: DiagonalBlock, right: Sequence[Scalar]) -> Vector:
        """What solves the block without its determinant, and that with the sign that is due to it."""
        rows = zip(self._entries(block), right, strict=True)
        *minors, determinant = cross_product(self._graph, tuple((*row, -x) for row, x in rows), len(block.rows) + 1)
        return (*minors, determinant if determinant.size > LONGEST_CANCELLED else self._cancel(determinant))

    def _solved(self, block: DiagonalBlock, right: Sequence[Scalar]) -> Vector:
        if len(block.rows) > LARGEST_SQUARE_BY_MINORS:
            return by_rows(self._graph, self._entries(block), tuple(right)).values
        *minors, determinant = self._bordered(block, right)
        return tuple(minor / determinant for minor in minors)
