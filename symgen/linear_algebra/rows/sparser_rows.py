"""Rows added to each other where that leaves fewer entries: what closes two legs on a third is each leg by itself.

Elementary steps with factors of 1 and -1, so that no digit is lost and no rank: a loop from leg 1 to leg 2, with the
place of the tip of leg 1 given, is the place of the tip of leg 2.  What would be worked out from leg 1 and cancelled
again, near its own singularity with large rates, is not there any more.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.matrix import Matrix
from symgen.symbolic.scalar import Scalar

# Rows up to which pairs of them are tried: each pair takes a sum for every entry that both have.
MOST_ROWS_COMBINED = 40


class SparserRows:
    """Combinations of the rows of a matrix, each row once and others taken from it or added."""

    def __init__(self, matrix: Matrix) -> None:
        self._steps: list[tuple[int, int, int]] = []
        rows = [list(row) for row in matrix]
        filled = [{j for j, x in enumerate(row) if not x.is_zero} for row in rows]
        while len(rows) <= MOST_ROWS_COMBINED and (step := _best(rows, filled)) is not None:
            i, j, sign = step
            rows[i] = [_combined(x, y, sign) for x, y in zip(rows[i], rows[j], strict=True)]
            filled[i] = {k for k, x in enumerate(rows[i]) if not x.is_zero}
            self._steps.append(step)
        self.matrix: Matrix = tuple(map(tuple, rows))

    def of(self, values: Sequence[Scalar]) -> list[Scalar]:
        """The same combinations of other values, one a row."""
        combined = list(values)
        for i, j, sign in self._steps:
            combined[i] = _combined(combined[i], combined[j], sign)
        return combined


def _best(rows: Sequence[Sequence[Scalar]], filled: Sequence[set[int]]) -> tuple[int, int, int] | None:
    """The row, the one that is added to it and its sign, by which most entries vanish; None where none do."""
    best, gain = None, 0
    for i, own in enumerate(filled):
        for j, other in enumerate(filled):
            new = len(other - own)
            if i == j or len(own & other) - new <= gain:
                continue
            for sign in (-1, 1):
                lost = sum(_combined(rows[i][k], rows[j][k], sign).is_zero for k in own & other)
                if lost - new > gain:
                    best, gain = (i, j, sign), lost - new
    return best


def _combined(x: Scalar, y: Scalar, sign: int) -> Scalar:
    return x + y if sign > 0 else x - y
