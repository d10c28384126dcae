"""Householder reflections: columns brought to upper triangular form."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar


class Reflections:
    """Householder reflections that bring the columns a_1..a_r to upper triangular form (Golub and Van Loan, 5.2).

    With `everywhere` a column that vanishes is left alone instead of giving 0/0.  In another `order` entries are turned
    that stand in it.
    """

    def __init__(
        self,
        graph: Graph,
        columns: Sequence[Vector],
        n: int,
        everywhere: bool = False,
        order: Sequence[int] | None = None,
    ) -> None:
        self.graph, self.n, self.everywhere = graph, n, everywhere
        self._order = range(n) if order is None else order
        self.reflectors: list[tuple[int, Vector, Scalar]] = []
        self.pivots: list[Scalar] = []
        self.triangle: list[Vector] = []
        for k, column in enumerate(columns):
            y = self.apply_transposed(column)
            tail = y[k:]
            if all(entry.is_zero for entry in tail[1:]):
                self.pivots.append(tail[0] * tail[0])
                self.triangle.append((*y[:k], tail[0]))
                continue
            self.triangle.append((*y[:k], -self._add(k, tail)))

    def _add(self, k: int, tail: Vector) -> Scalar:
        """One more reflection, of entries from place k on, which makes (-s, 0, ...) of `tail`: s."""
        graph, head = self.graph, tail[0]
        squared = graph.sum(entry * entry for entry in tail)
        norm = graph.function("sqrt", (squared,))
        # the sign that adds: no cancellation in the first component
        signed = norm if head.is_zero else graph.function("copysign", (norm, head))
        reach = norm * (norm + graph.function("abs", (head,)))
        factor = self._inverse(reach)
        self.reflectors.append((k, (head + signed, *tail[1:]), factor))
        self.pivots.append(squared)
        return signed

    def combinations(self, lengths: Sequence[Scalar]) -> list[Scalar]:
        """The squared lengths of what each pivot is made of, from those of the columns.

        The pivot is p_k = a_k - sum_j c_j a_j, j < k, with the c that make it shortest: |a_k|^2 + sum_j c_j^2 |a_j|^2.
        What is computed are the reflections of columns that are off by eps of their lengths (Higham, Accuracy and
        Stability of Numerical Algorithms, 19.3), which changes p_k by eps times the root of that: beside columns that
        are nearly parallel by far more than eps of a_k.  For columns of length 1 it is p_k^2 |R^-1 e_k|^2, so that the
        least share that a p_k^2 has of it is the square of the smallest singular value, or up to r times that.
        """
        squares = list(lengths)
        for k, column in enumerate(self.triangle):
            rest = list(column[:k])
            for j in reversed(range(k)):
                if not rest[j].is_zero:
                    amount = rest[j] * self._inverse(self.triangle[j][j])
                    squares[k] = squares[k] + amount * amount * lengths[j]
                    rest[:j] = (x - y * amount for x, y in zip(rest[:j], self.triangle[j], strict=False))
        return squares

    def _inverse(self, x: Scalar) -> Scalar:
        return self.graph.function("ratio_or_zero", (self.graph.one, x)) if self.everywhere else 1 / x

    @property
    def determinant_sign(self) -> Scalar:
        """The sign of det Q det R: each reflection has the determinant -1."""
        graph = self.graph
        sign = graph.const(-1 if len(self.reflectors) & 1 else 1)
        for k, column in enumerate(self.triangle):
            pivot = column[k]
            if pivot.constant is not None:
                sign = -sign if pivot.constant < 0 else sign
            else:
                sign = sign * graph.function("copysign", (graph.one, pivot))
        return sign

    def apply_transposed(self, x: Vector) -> Vector:
        """Q^T x."""
        x = self.in_order(x)
        for reflector in self.reflectors:
            x = self._reflect(reflector, x)
        return x

    def apply(self, x: Vector) -> Vector:
        """Q x."""
        for reflector in reversed(self.reflectors):
            x = self._reflect(reflector, x)
        there = dict(zip(self._order, x, strict=True))
        return tuple(there[j] for j in range(self.n))

    def in_order(self, x: Vector) -> Vector:
        """The entries as they are turned."""
        return tuple(x[j] for j in self._order)

    def _reflect(self, reflector: tuple[int, Vector, Scalar], x: Vector) -> Vector:
        k, v, factor = reflector
        share = dot(self.graph, v, x[k:]) * factor
        if share.is_zero:
            return x
        return (*x[:k], *(entry - share * component for entry, component in zip(x[k:], v, strict=True)))
