"""The null space of B where rows depend on each other: Householder reflections that pivot by arithmetic.

rho reflections, rho = the generic rank, each towards the row of which most is left beside the directions already taken,
times the share that this is of its own length (Golub and Van Loan, 5.4; the selection is a product with 0 or 1 made by
copysign, hence the same code for every state).  By length alone, what rounding leaves of a long row that follows from
others may be longer than a short row of its own; by shares alone, a row that is all but 0 here, and of which rounded
angles leave few digits, is as good as the longest.  A fixed choice of rows would be a parametrisation; this one follows
the configuration.  What is left of the other rows, zero on V and of the size of the drift beside it, is dropped.  With
B = L Q_1^T, L of full column rank, B^+ = Q_1 L^+ comes from a second factorisation, of L (complete orthogonal
decomposition).

Rows of what inputs do along the constraints are no rows of their own: they are components in an orthonormal basis, one
of which may vanish at any configuration.  Of those the longest is taken as it is.

Coordinates that are locked by rows without others, as many of them as the rank of these rows, come first, and so do the
rows: their reflections touch nothing else, and N_B is 0 there without a rounding.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.linear_algebra.reflections import Reflections
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, transpose
from symgen.symbolic.scalar import Scalar


class PivotedReflections(Reflections):
    """`rank` reflections, each made from the row with the longest remainder.

    `lengths` are the squared lengths of the rows chosen, `coefficients` L: the rows in terms of the directions taken,
    `rest` what is left of the rows beside these directions.  With `own` remainders count beside the rows' lengths.
    """

    def __init__(
        self,
        graph: Graph,
        rows: Matrix,
        n: int,
        rank: int,
        everywhere: bool = False,
        own: bool = True,
        locked: Sequence[int] = (),
    ) -> None:
        super().__init__(graph, (), n, everywhere, (*locked, *(j for j in range(n) if j not in locked)))
        remaining = [self.in_order(row) for row in rows]
        squares = [dot(graph, row, row) for row in rows]
        # 1 for rows that were not chosen yet: what rounding leaves of the others must not be chosen again
        free = [graph.one] * len(rows)
        self.lengths: list[Scalar] = []
        for k, places in enumerate(_candidates(rows, rank, locked)):
            left = [free[i] * dot(graph, remaining[i][k:], remaining[i][k:]) for i in places]
            shares = [graph.function("ratio_or_zero", (a, squares[i])) for a, i in zip(left, places, strict=True)]
            # long rows are known to more digits than short ones that hold the same
            best = longest(graph, [a * b for a, b in zip(left, shares, strict=True)] if own else left)
            chosen = [graph.zero] * len(rows)
            for i, wins in zip(places, best, strict=True):
                chosen[i] = wins
            taken = [(c * one, row) for c, one, row in zip(chosen, free, remaining, strict=True)]
            tail = tuple(graph.sum(c * row[i] for c, row in taken) for i in range(k, n))
            self.lengths.append(graph.sum(c * square for c, square in zip(chosen, squares, strict=True)))
            self._add(k, tail)
            remaining = [self._reflect(self.reflectors[-1], row) for row in remaining]
            free = [one * (1 - c) for c, one in zip(chosen, free, strict=True)]
        # the chosen rows lie in the directions taken
        self.rest: Matrix = tuple(
            (*row[:rank], *(entry * one for entry in row[rank:])) for row, one in zip(remaining, free, strict=True)
        )
        self.coefficients: Matrix = tuple(row[:rank] for row in remaining)

    def combinations(self, lengths: Sequence[Scalar]) -> list[Scalar]:
        """Their own lengths: a row of which less is left than of those before is made of little of them."""
        return list(lengths)


def _candidates(rows: Matrix, rank: int, locked: Sequence[int]) -> Iterator[Sequence[int]]:
    """For each reflection the rows it may be made from: those that lock coordinates first, then the others."""
    if not locked:
        yield from [range(len(rows))] * rank
        return
    first = [i for i, row in enumerate(rows) if all(x.is_zero for j, x in enumerate(row) if j not in locked)]
    others = [i for i in range(len(rows)) if i not in first]
    for places, count in ((first, len(locked)), (others, rank - len(locked))):
        # as many rows as reflections are taken as they come
        yield from [[i] for i in places] if len(places) == count else [places] * count


def longest(graph: Graph, sizes: Sequence[Scalar]) -> list[Scalar]:
    """1 for the largest of the sizes, the last one where several are equal, 0 for the others."""
    best = sizes[0]
    wins = [graph.one]
    for size in sizes[1:]:
        win = (1 + graph.function("copysign", (graph.one, size - best))) / 2
        wins = [*(earlier * (1 - win) for earlier in wins), win]
        best = graph.function("max", (best, size))
    return wins


class PivotedSpace(HouseholderSpace):
    """By reflections of as many rows as the rank, chosen by length at each configuration."""

    def __init__(
        self,
        graph: Graph,
        rows: Matrix,
        n: int,
        rank: int,
        everywhere: bool = False,
        own: bool = True,
        locked: Sequence[int] = (),
    ) -> None:
        self.graph, self.rows, self.n, self.rank, self.locked = graph, rows, n, rank, locked
        self.delta = n - rank
        self._pivoted = PivotedReflections(graph, rows, n, rank, everywhere, own, locked)
        self.reflections = self._pivoted

    @cached_property
    def lengths(self) -> list[Scalar]:
        """The squared lengths of the rows that were chosen."""
        return self._pivoted.lengths

    @cached_property
    def _inner(self) -> Reflections:
        columns = transpose(self._pivoted.coefficients, self.rank)
        return Reflections(self.graph, columns, len(self.rows), self._pivoted.everywhere)

    @property
    def square(self) -> Scalar:
        """det L^T L, on V the sum of det(B_I B_I^T) over the row subsets I of size rho."""
        return self.graph.product(self._inner.pivots)

    @property
    def rank_measures(self) -> list[Scalar]:
        """Those of the rows chosen, and those of L."""
        return [*self.reflections.pivots, *self._inner.pivots]

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+ = Q_1 L^+, n x r."""
        return transpose(tuple(self.lift(axis) for axis in identity(self.graph, len(self.rows))), self.n)

    def lift(self, a: Vector) -> Vector:
        """Q_1 L^+ a."""
        y = list(self._inner.apply_transposed(a)[: self.rank])
        triangle = self._inner.triangle
        for k in reversed(range(self.rank)):
            y[k] = y[k] / triangle[k][k]
            for i in range(k):
                y[i] = y[i] - triangle[k][i] * y[k]
        return self.reflections.apply((*y, *(self.graph.zero,) * self.delta))

    def lift_transposed(self, x: Vector) -> Vector:
        """(L^+)^T Q_1^T x, the one of least norm."""
        right = self.reflections.apply_transposed(x)[: self.rank]
        y: list[Scalar] = []
        for column, entry in zip(self._inner.triangle, right, strict=True):
            y.append((entry - dot(self.graph, column[: len(y)], y)) / column[len(y)])
        return self._inner.apply((*y, *(self.graph.zero,) * (len(self.rows) - self.rank)))


def reflected(
    graph: Graph,
    rows: Matrix,
    n: int,
    rank: int,
    everywhere: bool = False,
    own: bool = True,
    locked: Sequence[int] = (),
) -> HouseholderSpace:
    """The null space by reflections, with pivoting only where rows depend on each other.

    With `own` each row counts by what is left of its own length.  `locked` are coordinates that rows without others
    lock: as many as the rank of these.
    """
    if rank == len(rows):
        return HouseholderSpace(graph, rows, n, everywhere, locked)
    return PivotedSpace(graph, rows, n, rank, everywhere, own, locked)
