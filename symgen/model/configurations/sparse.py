"""Small sparse linear algebra in floats: rows are dictionaries from column to entry.

A loop touches a few coordinates of many, so that a mechanism of a hundred loops has rows of five entries.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TypeAlias

Row: TypeAlias = dict[int, float]

# Between what counts as zero and what counts as a pivot a matrix is too close to losing rank to tell.
NEGLIGIBLE = 1e-9
# What counts as a pivot, in rows that are scaled.
PLAIN = 1e-5
# Times that rows and columns are scaled in turn.
SWEEPS = 3


class Scales:
    """Factors that bring rows and columns of matrices of one shape to size one, from the sizes entries usually have.

    A row by its length at one point would be no measure: where it vanishes, what rounding leaves of it would count.
    """

    def __init__(self, typical: Sequence[Row]) -> None:
        kept = [{j: value for j, value in row.items() if value > 0} for row in typical]
        columns = {j for row in kept for j in row}
        self.rows = [1.0] * len(kept)
        self.columns = dict.fromkeys(sorted(columns), 1.0)
        for _ in range(SWEEPS):
            for i, row in enumerate(kept):
                if row:
                    self.rows[i] = 1 / max(value * self.columns[j] for j, value in row.items())
            most = dict.fromkeys(self.columns, 0.0)
            for factor, row in zip(self.rows, kept, strict=True):
                for j, value in row.items():
                    most[j] = max(most[j], factor * value)
            self.columns = {j: 1 / value for j, value in most.items()}
        self._kept = [frozenset(row) for row in kept]

    def scaled(self, rows: Sequence[Row]) -> list[Row]:
        """The rows with usual entries of size one at most; entries that are zero everywhere are left out."""
        return [
            {j: factor * value * self.columns[j] for j, value in row.items() if j in kept}
            for row, factor, kept in zip(rows, self.rows, self._kept, strict=True)
        ]


def typical(samples: Iterable[Sequence[Row]]) -> list[Row]:
    """The largest size of each entry over some matrices."""
    largest: list[Row] = []
    for rows in samples:
        largest = largest or [{} for _ in rows]
        for sizes, row in zip(largest, rows, strict=True):
            for j, value in row.items():
                sizes[j] = max(sizes.get(j, 0.0), abs(value))
    return largest


def clear_rank(rows: Sequence[Row], plain: float) -> int | None:
    """The rank of scaled rows by elimination with complete pivoting; None where it is not clear-cut."""
    sizes = pivots(rows)
    return None if sizes is None or (sizes and sizes[-1] < plain) else len(sizes)


def pivots(rows: Sequence[Row]) -> list[float] | None:
    """The sizes of the pivots of scaled rows that are not negligible, with complete pivoting; None for NaN."""
    left = [dict(row) for row in rows]
    if not all(math.isfinite(value) for row in left for value in row.values()):
        return None
    # of each row its largest entry, the first of equal ones: only rows that a step changes are looked at again
    largest = [_largest(row) for row in left]
    sizes: list[float] = []
    while left:
        size, place, column = max((size, -i, column) for i, (size, column) in enumerate(largest))
        if size < NEGLIGIBLE:
            break
        lead = left.pop(-place)
        del largest[-place]
        pivot = lead.pop(-column)
        for i, row in enumerate(left):
            entry = row.pop(-column, 0.0)
            if entry:
                factor = entry / pivot
                for j, value in lead.items():
                    row[j] = row.get(j, 0.0) - factor * value
                largest[i] = _largest(row)
        sizes.append(size)
    return sizes


def _largest(row: Row) -> tuple[float, int]:
    """The size of the largest entry of a row, and its column with a minus sign."""
    return max(((abs(x), -j) for j, x in row.items()), default=(0.0, 0))


def solve_gram(rows: Sequence[Row], right: Sequence[float], damping: float) -> list[float] | None:
    """y with (A A^T + damping) y = right, for the rows A; None where the matrix is not positive to rounding.

    Rows that share most others are eliminated last, which keeps what a chain of loops fills in small.
    """
    touching: dict[int, list[int]] = {}
    for i, row in enumerate(rows):
        for j in row:
            touching.setdefault(j, []).append(i)
    gram: list[Row] = [{i: damping} for i in range(len(rows))]
    for j, these in touching.items():
        entries = [(i, rows[i][j]) for i in these]
        for i, factor in entries:
            own = gram[i]
            for k, entry in entries:
                own[k] = own.get(k, 0.0) + factor * entry
    values = list(right)
    left = set(range(len(rows)))
    taken: list[tuple[int, float, Row]] = []
    while left:
        k = min([(len(gram[i]), i) for i in left])[1]
        left.remove(k)
        row = gram[k]
        pivot = row.pop(k)
        if not 0 < pivot < math.inf:
            return None
        for i, entry in row.items():
            factor = entry / pivot
            other = gram[i]
            del other[k]
            for j, value in row.items():
                other[j] = other.get(j, 0.0) - factor * value
            values[i] -= factor * values[k]
        taken.append((k, pivot, row))
    solution = [0.0] * len(rows)
    for k, pivot, row in reversed(taken):
        solution[k] = (values[k] - sum(value * solution[j] for j, value in row.items())) / pivot
    return solution


def transposed_product(rows: Sequence[Row], weights: Sequence[float]) -> Row:
    """A^T y."""
    total: Row = {}
    for row, weight in zip(rows, weights, strict=True):
        for j, value in row.items():
            total[j] = total.get(j, 0.0) + weight * value
    return total


def groups(rows: Sequence[Row], n: int) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Rows and columns that hang together, by the places rows have entries in; columns without rows are left out."""
    leader = list(range(n))

    def of(j: int) -> int:
        while leader[j] != j:
            leader[j] = leader[leader[j]]
            j = leader[j]
        return j

    for row in rows:
        first, *others = row or (0,)
        for j in others:
            leader[of(j)] = of(first)
    by_leader: dict[int, tuple[list[int], list[int]]] = {}
    for i, row in enumerate(rows):
        for j in row:
            by_leader.setdefault(of(j), ([], []))[0].append(i)
            break
    for j in range(n):
        if of(j) in by_leader:
            by_leader[of(j)][1].append(j)
    return [(tuple(these), tuple(columns)) for these, columns in by_leader.values()]
