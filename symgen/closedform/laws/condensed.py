"""Determinants with columns that two rows share, as the passive joint of a leg: these two rows become one.

With entries b_p and b_q in such a column alone, det is that of the matrix without it in which the rows p and q are
replaced by b_q (row p) - b_p (row q), up to its sign.
"""

from __future__ import annotations

from typing import TypeAlias

from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.homogeneous import common_factor, divide
from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial
from symgen.closedform.algebra.ring import TrigRing

Row: TypeAlias = tuple[Quotient, ...]


def condensed(ring: TrigRing, matrix: Matrix) -> tuple[Matrix, tuple[PolyElement, ...]]:
    """A smaller matrix, and factors of its rows that were taken out; the same matrix where nothing is shared.

    The determinants are equal up to the sign and these factors.  For entries without denominators.
    """
    rows, contents = matrix, list[PolyElement]()
    while (pair := _shared(rows)) is not None:
        rows, content = _joined(ring, rows, *pair)
        contents.append(content)
    return rows, tuple(contents)


def _shared(rows: Matrix) -> tuple[int, int, int] | None:
    """A column and the two rows that alone have entries in it."""
    if len(rows) <= 2:
        return None
    for column, entries in enumerate(zip(*rows, strict=True)):
        filled = [i for i, entry in enumerate(entries) if entry]
        if len(filled) == 2:
            return column, filled[0], filled[1]
    return None


def _joined(ring: TrigRing, rows: Matrix, column: int, p: int, q: int) -> tuple[Matrix, PolyElement]:
    """The rows p and q as one, without the column and without a common factor, and that factor."""
    above, below = rows[p][column], rows[q][column]
    rest = [k for k in range(len(rows)) if k != column]
    joined = [(below * rows[p][k] - above * rows[q][k]).numerator for k in rest]
    shared = common_factor(ring, joined)
    if next(entry for entry in joined if entry).LC < 0:
        shared = -shared
    one: Row = tuple(polynomial(ring, divide(ring, entry, shared)) for entry in joined)
    others = [one if i == p else tuple(row[k] for k in rest) for i, row in enumerate(rows) if i != q]
    return tuple(others), shared
