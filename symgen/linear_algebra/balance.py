"""Whether forces of the constraints alone are in balance: the rows that an elimination has turned, without inputs.

Multipliers that a row with one entry, a number or a parameter, makes 0 are left out, so that the rank of B is that of
fewer and shorter vectors: of the forces across each leg of a platform.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from symgen.model.kinematics.triples import Rows, transposed
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, dot
from symgen.symbolic.scalar import Scalar

Coefficients: TypeAlias = dict[int, Scalar]


def multipliers_alone(rows: Sequence[Mapping[int, Scalar]], safe: Callable[[Scalar], bool], zero: Scalar) -> Matrix:
    """What each multiplier does in the rows: vectors that depend on each other exactly where the rows of B do.

    `safe` knows the pivots that never vanish.  Rows with one entry come first.
    """
    left = [dict(row) for row in rows]
    while (alone := next((row for row in left if len(row) == 1 and safe(*row.values())), None)) is not None:
        (vanishing,) = alone
        left = [{j: c for j, c in row.items() if j != vanishing} for row in left]
    left = sorted(filter(None, left), key=len)
    names = sorted({j for row in left for j in row})
    return tuple(tuple(row.get(j, zero) for row in left) for j in names)


def along_rates(graph: Graph, moments: Sequence[Mapping[int, Scalar]], turning: Rows[Scalar]) -> list[Coefficients]:
    """Three rows of moments along the rates a' of angles that turn a body by w = `turning` a'."""
    names = sorted({j for row in moments for j in row})
    rows = []
    for column in transposed(turning):
        sums = {j: dot(graph, column, [row.get(j, graph.zero) for row in moments]) for j in names}
        rows.append({j: entry for j, entry in sums.items() if not entry.is_zero})
    return rows
