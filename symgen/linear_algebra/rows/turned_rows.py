"""Two rows in axes that turn with an angle which they hold in no other way: orthogonal, so no digit is lost.

The place of an arm's tip turns with its column: along the arm the column moves it by what stands beside it alone,
across it nothing else moves it.  What is worked out from sums in fixed axes and cancels is not there.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from symgen.linear_algebra.rows.sparser_rows import MOST_ROWS_COMBINED
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached, substitute


@dataclass(frozen=True, slots=True)
class _TurnedPair:
    """Two rows, the angle, and to which side."""

    first: int
    second: int
    angle: Scalar
    side: int


class TurnedRows:
    """Rows of which pairs are turned where that leaves fewer entries; each row once."""

    def __init__(self, graph: Graph, matrix: Matrix, angles: Sequence[Scalar]) -> None:
        self._graph = graph
        self._turns: list[_TurnedPair] = []
        rows: list[Sequence[Scalar]] = list(matrix)
        pairs = combinations(range(len(rows)), 2) if len(rows) <= MOST_ROWS_COMBINED else ()
        for i, j in pairs:
            if any({i, j} & {turn.first, turn.second} for turn in self._turns):
                continue
            held = reached([*rows[i], *rows[j]])
            for turn in (_TurnedPair(i, j, x, side) for x in angles if x in held for side in (1, -1)):
                made = self._shorter(turn, (rows[i], rows[j]))
                if made is not None:
                    rows[i], rows[j] = made
                    self._turns.append(turn)
                    break
        self.matrix: Matrix = tuple(map(tuple, rows))

    def of(self, values: Sequence[Scalar]) -> list[Scalar]:
        """The same turns of other values, one a row."""
        turned = list(values)
        for turn in self._turns:
            turned[turn.first], turned[turn.second] = self._turned(turn, values[turn.first], values[turn.second])
        return turned

    def _turned(self, turn: _TurnedPair, first: Scalar, second: Scalar) -> tuple[Scalar, Scalar]:
        c, s = (self._graph.trig(name, turn.angle) for name in ("cos", "sin"))
        s = s * turn.side
        return c * first + s * second, c * second - s * first

    def _shorter(
        self, turn: _TurnedPair, rows: tuple[Sequence[Scalar], Sequence[Scalar]]
    ) -> tuple[list[Scalar], ...] | None:
        """The rows in turned axes, where they do not hold the angle there and have fewer entries."""
        pairs = [self._turned(turn, a, b) for a, b in zip(*rows, strict=True)]
        entries = [x for pair in pairs for x in pair]
        before = sum(not x.is_zero for row in rows for x in row)
        if sum(not x.is_zero for x in entries) >= before:
            return None
        slopes = derivative_along(self._graph, entries, {turn.angle: self._graph.one})
        if not all(x.is_zero for x in slopes):
            return None
        # the same at every angle, and shortest at 0
        at_zero = substitute(self._graph, entries, {turn.angle: self._graph.zero})
        return at_zero[::2], at_zero[1::2]
