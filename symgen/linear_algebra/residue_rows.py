"""Elimination of rows of residues: which of them follow from others, decided by arithmetic without rounding."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

ReducedRows: TypeAlias = Mapping[int, Sequence[int]]
"""Rows in reduced form, by the places of their leading ones: no row has anything where another has its 1."""


def with_row(reduced: ReducedRows, row: Sequence[int], prime: int) -> dict[int, Sequence[int]]:
    """Reduced rows and one more, if it does not follow from them."""
    rest = what_is_left(reduced, row, prime)
    if not any(rest):
        return dict(reduced)
    leading = next(k for k, x in enumerate(rest) if x)
    inverse = pow(rest[leading], -1, prime)
    rest = [x * inverse % prime for x in rest]
    others = {
        place: [(x - known[leading] * y) % prime for x, y in zip(known, rest, strict=True)]
        for place, known in reduced.items()
    }
    return {**others, leading: rest}


def what_is_left(reduced: ReducedRows, row: Sequence[int], prime: int) -> list[int]:
    """A row without what follows from others: zeros where all of it does."""
    rest = list(row)
    for place, known in reduced.items():
        if share := rest[place]:
            rest = [(x - share * y) % prime for x, y in zip(rest, known, strict=True)]
    return rest
