"""Elimination in balls: what may vanish counts as 0, anything else does not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from flint import arb, arb_mat

from symgen.model.combinations.taylor_balls import Ball, may_vanish

Matrix: TypeAlias = list[list[Ball]]


@dataclass(frozen=True)
class Echelon:
    """A matrix reduced by rows: 1 at its pivots, each with its column."""

    rows: Matrix
    pivots: tuple[int, ...]

    @property
    def rank(self) -> int:
        """As many rows as there are."""
        return len(self.pivots)


def reduced(rows: Sequence[Sequence[Ball]], columns: Sequence[int]) -> Echelon:
    """Gauss and Jordan's elimination, column by column in this order: a column depends on those before it or not."""
    left = [list(row) for row in rows]
    made: Matrix = []
    pivots: list[int] = []
    for column in columns:
        able = [i for i, row in enumerate(left) if not may_vanish(row[column])]
        if not able:
            continue
        lead = max(able, key=lambda i: abs(float(left[i][column].mid())))
        row = left.pop(lead)
        inverse = 1 / row[column]
        row = [entry * inverse for entry in row]
        row[column] = arb(1)
        entries = [(j, entry) for j, entry in enumerate(row) if not entry.is_zero() and j != column]
        for other in (*left, *made):
            factor = other[column]
            if not factor.is_zero():
                for j, entry in entries:
                    other[j] -= factor * entry
                other[column] = arb(0)
        made.append(row)
        pivots.append(column)
    return Echelon(made, tuple(pivots))


def extended(echelon: Echelon, rows: Sequence[Sequence[Ball]], columns: Sequence[int]) -> Echelon:
    """What `reduced` makes of rows that are reduced and further ones: pivots of the former stay."""
    if not echelon.rows:
        return reduced(rows, columns)
    new = reduced(_without(rows, echelon), columns)
    if not new.rows:
        return echelon
    return Echelon([*_without(echelon.rows, new), *new.rows], (*echelon.pivots, *new.pivots))


def _without(rows: Sequence[Sequence[Ball]], echelon: Echelon) -> Matrix:
    """The rows less what reduced ones make of their entries at the pivots."""
    at_pivots = arb_mat([[row[pivot] for pivot in echelon.pivots] for row in rows])
    left = (arb_mat(rows) - at_pivots * arb_mat(echelon.rows)).tolist()
    for row in left:
        for pivot in echelon.pivots:
            row[pivot] = arb(0)
    return [list(row) for row in left]


def kernel(rows: Sequence[Sequence[Ball]], count: int, columns: Sequence[int]) -> tuple[Echelon, Matrix]:
    """The reduced rows, and a basis of their null space: one vector for each column that is no pivot."""
    echelon = reduced(rows, columns)
    free = [j for j in range(count) if j not in echelon.pivots]
    basis: Matrix = []
    for j in free:
        vector = [arb(0)] * count
        vector[j] = arb(1)
        for row, pivot in zip(echelon.rows, echelon.pivots, strict=True):
            vector[pivot] = -row[j]
        basis.append(vector)
    return echelon, basis
