"""Mechanisms closed numerically: g(q) = 0 by Levenberg and Marquardt's method, loop by loop.

Each row counts in units of its own gradient over one coordinate width, so that a row in other units is the same row.
Loops that share no coordinate are closed one by one, each with its own damping (Nocedal and Wright, Numerical
Optimization, ch. 10).  An iteration ends where rounding leaves no further progress, well below what is asked for: close
to a configuration where a gradient vanishes a residual of 1e-12 is still a distance of 1e-6.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TypeAlias

from symgen.model.configurations.sparse import Row, groups, solve_gram, transposed_product
from symgen.records import dataclass

# What is left of a row that is closed, in units of its gradient over one coordinate width.
CLOSED = 1e-10
# The same where a further step gains nothing.
CLOSED_TO_ROUNDING = 1e-15
# Steps towards a closed loop, at most.
CLOSING_STEPS = 80
# An iteration gives up where so many steps in a row gain less than this share.
SLOW_STEPS, SLOW = 6, 1e-3
# Steps in a row that come no closer, once a loop is closed.
MOST_REFUSED = 2

Residuals: TypeAlias = Callable[[Sequence[float], Sequence[int]], tuple[list[float], list[Row]]]
"""Values and gradients of the rows with the given numbers at q; ArithmeticError or ValueError outside a domain."""


# A row whose gradient has entries this far from 1 is in units of its own.
ORDINARY = 2.0**10


def row_unit(entries: Iterable[float]) -> float:
    """The factor that brings a row back to ordinary size, by its gradient; a power of 2, and 1 where none is needed."""
    size = max(map(abs, entries), default=0.0)
    return 1.0 if not 0 < size < math.inf or 1 / ORDINARY <= size <= ORDINARY else 2.0 ** -math.frexp(size)[1]


@dataclass(frozen=True, slots=True)
class KinematicLoop:
    """Rows that hang together, and the coordinates they touch."""

    rows: tuple[int, ...]
    coordinates: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ClosureResult:
    """Where an iteration ended: q, and the loops that stay open."""

    q: tuple[float, ...]
    open: tuple[KinematicLoop, ...]


class Closer:
    """Closes the loops of one mechanism; `effort` counts the rows that were evaluated."""

    def __init__(self, residuals: Residuals, lengths: Sequence[Row], widths: Sequence[float]) -> None:
        self._residuals, self._lengths, self._widths = residuals, lengths, widths
        self._units = [
            1 / max((value * widths[j] for j, value in row.items()), default=0.0) if any(row.values()) else 1.0
            for row in lengths
        ]
        self.loops = tuple(KinematicLoop(rows, columns) for rows, columns in groups(lengths, len(widths)))
        self.effort = 0

    def close(
        self, q: Sequence[float], loops: Sequence[KinematicLoop] | None = None, held: Collection[int] = frozenset()
    ) -> ClosureResult:
        """The configuration that is reached from q, loop by loop; `held` coordinates stay where they are."""
        place = list(q)
        still = tuple(loop for loop in (self.loops if loops is None else loops) if not self._close(place, loop, held))
        return ClosureResult(tuple(place), still)

    def gaps(self, q: Sequence[float], loop: KinematicLoop) -> list[float]:
        """The values of the rows of a loop, in their own units; NaN outside of a domain."""
        try:
            return self._residuals(q, loop.rows)[0]
        except (ArithmeticError, ValueError):
            return [math.nan] * len(loop.rows)

    def widest(self, q: Sequence[float], loop: KinematicLoop, share: float) -> KinematicLoop:
        """The rows of a loop that stay open by this share of the widest gap or more, in units of their gradients."""
        gaps = [abs(self._units[i] * gap) for i, gap in zip(loop.rows, self.gaps(q, loop), strict=True)]
        rows = tuple(i for i, gap in zip(loop.rows, gaps, strict=True) if gap >= share * max(gaps))
        return KinematicLoop(rows, tuple(sorted({j for i in rows for j in self._lengths[i]})))

    def rest(self, q: Sequence[float]) -> float:
        """What is left of the rows of the widest open loop, in units of their gradients; NaN outside a domain."""
        scaled = [self._scaled(q, loop.rows, ()) for loop in self.loops]
        return max((math.nan if one is None else _length(one[0]) for one in scaled), default=0.0)

    def along(self, q: Sequence[float], direction: Sequence[float]) -> list[float] | None:
        """The part of a direction (in coordinate widths) that leaves all rows as they are to first order."""
        moved = list(direction)
        for loop in self.loops:
            scaled = self._scaled(q, loop.rows, ())
            if scaled is None:
                return None
            rows = scaled[1]
            size = _mean_square(rows)
            for _ in range(2):
                rates = [sum(value * moved[j] for j, value in row.items()) for row in rows]
                weights = solve_gram(rows, rates, 1e-12 * size)
                if weights is None:
                    return None
                for j, share in transposed_product(rows, weights).items():
                    moved[j] -= share
        return moved

    def _scaled(
        self, q: Sequence[float], numbers: Sequence[int], held: Collection[int]
    ) -> tuple[list[float], list[Row]] | None:
        """Residuals and gradients in units of rows and widths; none along held coordinates."""
        self.effort += len(numbers)
        try:
            values, rows = self._residuals(q, numbers)
        except (ArithmeticError, ValueError):
            return None
        units, widths = self._units, self._widths
        if not all(map(math.isfinite, values)):
            return None
        return (
            [units[i] * value for i, value in zip(numbers, values, strict=True)],
            [
                {j: units[i] * value * widths[j] for j, value in row.items() if j not in held}
                for i, row in zip(numbers, rows, strict=True)
            ],
        )

    def _close(self, q: list[float], loop: KinematicLoop, held: Collection[int]) -> bool:
        """Whether the loop closes; q ends where the iteration does."""
        state = self._scaled(q, loop.rows, held)
        if state is None:
            return False
        damping, slow, refused = 1e-3, 0, 0
        values, rows = state
        size = _length(values)
        for _ in range(CLOSING_STEPS):
            if size <= CLOSED_TO_ROUNDING or slow == SLOW_STEPS:
                break
            weights = solve_gram(rows, values, damping * _mean_square(rows))
            trial = list(q)
            fresh = None
            if weights is not None:
                for j, share in transposed_product(rows, weights).items():
                    trial[j] -= share * self._widths[j]
                fresh = self._scaled(trial, loop.rows, held)
            fresh_size = math.inf if fresh is None else _length(fresh[0])
            if fresh is not None and fresh_size < size:
                slow = slow + 1 if fresh_size > (1 - SLOW) * size else 0
                q[:], (values, rows) = trial, fresh
                damping = max(damping * min(0.1, fresh_size / size), 1e-14)
                size, refused = fresh_size, 0
            else:
                refused += 1
                damping = max(damping, 1e-12) * 10
                if damping > 1e8 or (size <= CLOSED and refused > MOST_REFUSED):
                    break
        return size <= CLOSED


def _mean_square(rows: Sequence[Row]) -> float:
    """Of the lengths of rows; 1 where all of them vanish."""
    return sum(value * value for row in rows for value in row.values()) / len(rows) or 1.0


def _length(values: Sequence[float]) -> float:
    return math.sqrt(sum(value * value for value in values))
