"""The rows of B, in the metric of G^-1, in terms of orthogonal directions: the modified Gram-Schmidt process.

Where masses are far apart the entries of a column differ as much, and reflections mix them unless they are sorted.
Here each entry changes by a multiple of the entry of the column that is taken out, in its own row (Bjorck, Numerical
Methods for Least Squares Problems, 2.4 and 4.4).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import POORER, Guard, multiplied
from symgen.linear_algebra.null_space.pivoted import longest
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, transpose
from symgen.symbolic.scalar import Scalar


class WeightedGramSchmidt:
    """A = V R by the modified Gram-Schmidt process in the metric (x, y) = sum_i x_i y_i w_i; R has a unit diagonal.

    No roots are taken: V keeps the lengths that are left of the columns.
    """

    def __init__(self, graph: Graph, columns: Sequence[Vector], weights: Sequence[Scalar]) -> None:
        self._graph, self._columns, self._metric = graph, columns, weights
        left = list(columns)
        self._directions: list[Vector] = []
        self._weighted: list[Vector] = []
        self._squares: list[Scalar] = []
        self._inverses: list[Scalar] = []
        self._upper: list[list[Scalar]] = [[] for _ in columns]  # column j of R above the diagonal
        for k, direction in enumerate(left):
            weighted = tuple(x * w for x, w in zip(direction, weights, strict=True))
            square = dot(graph, weighted, direction)
            inverse = 1 / square
            self._directions.append(direction)
            self._weighted.append(weighted)
            self._squares.append(square)
            self._inverses.append(inverse)
            for j in range(k + 1, len(left)):
                share = dot(graph, weighted, left[j]) * inverse
                self._upper[j].append(share)
                left[j] = _less(left[j], share, direction)

    def chosen(self, rows: Sequence[Vector]) -> list[Vector]:
        """Those of the rows of B whose columns are solved with: all."""
        return list(rows)

    def asked(self, rows: Sequence[Vector], c: Vector) -> Vector:  # noqa: ARG002 - of dependent rows only
        """The right-hand sides of these."""
        return c

    def regularity(self, causes: tuple[Guard, ...] = ()) -> tuple[Guard, ...]:
        """What is left of each column beside its length, and that there is something of what is divided by.

        A step loses again what the steps before have lost, as in `multiplied`: the inverse of what a column counts for
        there is (5 + |a|^2 / |v|^2) / 6.  All are compared beside the last |v|^2, so that nothing more is divided.

        A column is measured by its own length, however long the others are.  What is computed is right for columns
        that are off by some eps of their own lengths (Bjorck, 2.4), and v_j that is off by e_j |v_j| changes what is
        left of a_k by some e_j |a_k|: of v_j (v_j, a_k) / |v_j|^2 is taken, no longer than a_k however short v_j is.
        So e_j alone counts, some eps of |a_j| / |v_j| and of what steps before have added, and a row may be 1e-16 of
        the others.  Its entries are off by more where their terms cancel, up to its whole length; but so they are for
        the next numbers, and what that does to results is in d of docs/theory.md.

        Where `causes` tell ranks of rows by themselves, it may be masses that leave nothing of a difference of rows.
        Nothing else tests the rows then.  One that is lost counts for its share of all rows it is made of, each off by
        eps of its length: for s / r, not 6 s.
        """
        lengths, count = [_squared(self._graph, a, self._metric) for a in self._columns], len(self._columns)
        rows, last = Status.CONSTRAINT_RANK, self._squares[-1]
        before = tuple(Guard(rows, square, 2, scale=square) for square in self._squares[:-1])
        # of the first column, and of those that share no entry with one before, all is left
        less = [k for k in range(count) if lengths[k] is not self._squares[k]]
        if not less:
            return (*before, Guard(rows, last, 2, scale=last))
        lost = [(POORER - 1) + lengths[k] * self._inverses[k] for k in less if k < count - 1]
        counted = Fraction(POORER * count if causes else 1, POORER ** (len(lost) + 1))
        scale = self._graph.product(lost) * (lengths[-1] + (POORER - 1) * last) * counted
        return (*before, Guard(Status.MASS_RANK if causes else rows, last, 2, causes, scale))

    def solve(self, b: Vector, c: Vector, again: bool = False) -> tuple[Vector, Vector]:
        """y and l of y + A l = b, A^T W y = c.

        Components along V are taken out of b one by one, and given back in the opposite order.  Asked for `again`, what
        is there is looked at, so that what rounding has left of them on the way does not stay (Bjorck and Paige, SIAM
        J. Matrix Anal. Appl. 15, 1994).  Exactly nothing is: it has to be a number of which nothing is known then.
        """
        graph, count = self._graph, len(self._directions)
        asked: list[Scalar] = []  # (V^T W y)_k
        for k in range(count):
            asked.append(c[k] - dot(graph, self._upper[k], asked))
        y, shares = b, list[Scalar]()
        for k in range(count):
            along = dot(graph, self._weighted[k], y)
            y = _less(y, along * self._inverses[k], self._directions[k])
            shares.append((along - asked[k]) * self._inverses[k])
        if again:
            y = tuple(map(graph.rounded, y))
        for k in reversed(range(count)):
            surplus = dot(graph, self._weighted[k], y) - asked[k]
            y = _less(y, surplus * self._inverses[k], self._directions[k])
        return y, self._solved_upwards(shares)

    def shares(self, x: Vector) -> Vector:
        """What x, a combination of the columns, has of each direction."""
        amounts = list[Scalar]()
        for direction, weighted, inverse in zip(self._directions, self._weighted, self._inverses, strict=True):
            amounts.append(dot(self._graph, weighted, x) * inverse)
            x = _less(x, amounts[-1], direction)
        return tuple(amounts)

    def combined(self, factors: Vector) -> Vector:
        """What the sum of the columns times these factors has of each direction."""
        amounts = list(factors)
        for factor, column in zip(factors, self._upper, strict=True):
            for i, entry in enumerate(column):
                amounts[i] = amounts[i] + entry * factor
        return tuple(amounts)

    def given(self, amounts: Vector) -> Vector:
        """R^T `amounts`: what these amounts of the directions are along the columns."""
        return tuple(
            amount + dot(self._graph, self._upper[k], amounts[: len(self._upper[k])])
            for k, amount in enumerate(amounts)
        )

    def shortest(self, asked: Vector) -> Vector:
        """The shortest y with A^T W y = `asked`."""
        graph, shares = self._graph, list[Scalar]()
        for k, wanted in enumerate(asked):
            shares.append(wanted - dot(graph, self._upper[k], shares))
        scaled = [share * inverse for share, inverse in zip(shares, self._inverses, strict=True)]
        terms = zip(scaled, self._directions, strict=True)
        return tuple(map(graph.sum, zip(*(tuple(s * x for x in direction) for s, direction in terms), strict=True)))

    def _solved_upwards(self, right: list[Scalar]) -> Vector:
        """R^-1 `right`."""
        for k in reversed(range(len(right))):
            for i, entry in enumerate(self._upper[k]):
                right[i] = right[i] - entry * right[k]
        return tuple(right)


class PivotedGramSchmidt(WeightedGramSchmidt):
    """A = V T where only `rank` columns are independent: V holds those of which most is left beside the ones before.

    The choice is made at each configuration, by products with 0 and 1, by what is left of a column times the share that
    this is of its own length.  What is left of the others is rounding, and dropped.  Solved for are multipliers of the
    chosen rows, from which the shortest ones of all rows follow (a complete orthogonal decomposition; Golub and Van
    Loan, 5.4).
    """

    def __init__(self, graph: Graph, columns: Sequence[Vector], weights: Sequence[Scalar], rank: int) -> None:
        super().__init__(graph, (), weights)
        lengths = [_squared(graph, column, weights) for column in columns]
        left = list(columns)
        self._measures: list[Scalar] = []
        self._choices: list[list[Scalar]] = []
        rows: list[Vector] = []  # of T
        for _ in range(rank):
            squares = [_squared(graph, column, weights) for column in left]
            ratios = [graph.function("ratio_or_zero", pair) for pair in zip(squares, lengths, strict=True)]
            # long rows are known to more digits than short ones that hold the same, beside V most of all
            choice = longest(graph, [square * ratio for square, ratio in zip(squares, ratios, strict=True)])
            direction = _combined(graph, choice, left)
            weighted = tuple(x * w for x, w in zip(direction, weights, strict=True))
            square = dot(graph, weighted, direction)
            inverse = graph.function("ratio_or_zero", (graph.one, square))
            self._upper.append([dot(graph, choice, row) for row in rows])
            self._choices.append(choice)
            self._measures.append(dot(graph, choice, ratios))
            self._directions.append(direction)
            self._weighted.append(weighted)
            self._squares.append(square)
            self._inverses.append(inverse)
            shares = tuple(dot(graph, weighted, column) * inverse for column in left)
            rows.append(shares)
            # the chosen column lies in the directions taken; what rounding leaves of it must not be chosen again
            left = [
                tuple(x * (1 - c) for x in _less(column, share, direction))
                for column, share, c in zip(left, shares, choice, strict=True)
            ]

    def chosen(self, rows: Sequence[Vector]) -> list[Vector]:
        """As many of the rows of B as the rank."""
        return [_combined(self._graph, choice, rows) for choice in self._choices]

    def asked(self, rows: Sequence[Vector], c: Vector) -> Vector:
        """Their right-hand sides in what comes nearest to c of all that the rows can give, as B^+ takes it.

        Measured rates contradict rows that depend on each other; no row may then speak for the others.
        """
        base, shares = self._by_chosen(rows)
        zero = (self._graph.zero,) * len(shares)
        nearest = WeightedGramSchmidt(self._graph, shares, (self._graph.one,) * len(c)).solve(c, zero)[1]
        return base.given(nearest)

    def of_all(self, rows: Sequence[Vector], multipliers: Vector) -> Vector:
        """The shortest multipliers of all rows that do what those of the chosen ones do.

        How rows follow from each other is read off B, as what L^-1 adds to long rows may leave nothing of short ones.
        """
        if not self._choices:
            return (self._graph.zero,) * len(rows)
        base, shares = self._by_chosen(rows)
        ones = (self._graph.one,) * len(rows)
        return WeightedGramSchmidt(self._graph, shares, ones).shortest(base.combined(multipliers))

    def _by_chosen(self, rows: Sequence[Vector]) -> tuple[WeightedGramSchmidt, Matrix]:
        """Directions of the chosen rows, and what all rows have of each of them."""
        graph = self._graph
        base = WeightedGramSchmidt(graph, self.chosen(rows), (graph.one,) * len(rows[0]))
        return base, transpose(tuple(map(base.shares, rows)), len(self._choices))

    def regularity(self, causes: tuple[Guard, ...] = ()) -> tuple[Guard, ...]:
        """What is left of each chosen column, in units of its length; causes are told of independent rows alone."""
        assert not causes
        return multiplied(Status.CONSTRAINT_RANK, self._measures, [self._graph.one] * len(self._measures))


def _combined(graph: Graph, shares: Sequence[Scalar], vectors: Sequence[Vector]) -> Vector:
    return tuple(
        graph.sum(share * x for share, x in zip(shares, entries, strict=True)) for entries in zip(*vectors, strict=True)
    )


def _squared(graph: Graph, column: Vector, weights: Sequence[Scalar]) -> Scalar:
    return dot(graph, tuple(x * w for x, w in zip(column, weights, strict=True)), column)


def _less(x: Vector, share: Scalar, direction: Vector) -> Vector:
    return tuple(entry - share * component for entry, component in zip(x, direction, strict=True))
