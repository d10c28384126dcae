"""How well inputs that each drive one coordinate reach the directions of motion: by the minors of the other columns.

For the orthogonal projector N on the null space of B the minor det N_JJ of as many coordinates J as there are
directions is det(B_K)^2 / det(B B^T), with K the coordinates that are not in J (complementary minors of an orthogonal
matrix: Horn and Johnson, Matrix Analysis, 0.8.4).  K has as many members as B has rows, however long a chain is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import prod

from symgen.linear_algebra.exterior import few_minors, unit, wedge_all
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.scalar import Scalar

# Minors of B up to which those that inputs drive are listed.
MOST_LISTED_MINORS = 600


def driven_minors(graph: Graph, rows: Matrix, inputs: Sequence[Vector], n: int) -> tuple[Scalar, int] | None:
    """The sum of det(B_K)^2 over all choices of n - r inputs, and how many choices drive as many coordinates.

    None where an input drives more than one coordinate, there are no rows, or the minors are too many.
    """
    drives = [0] * n
    for column in inputs:
        places = [j for j, entry in enumerate(column) if not entry.is_zero]
        if len(places) != 1 or not column[places[0]].is_one:
            return None
        drives[places[0]] += 1
    r = len(rows)
    passive = [j for j in range(n) if not drives[j]]
    if not r or len(passive) > r or not few_minors(rows, r, MOST_LISTED_MINORS):
        return None
    minors = wedge_all(unit(graph), rows)
    total, choices = graph.zero, 0
    active = [j for j in range(n) if drives[j]]
    for idle in combinations(active, r - len(passive)):
        # inputs that drive the same coordinate stand in for each other
        count = prod(drives[j] for j in active if j not in idle)
        minor = minors.get(sum(1 << j for j in (*passive, *idle)), graph.zero)
        total, choices = total + count * (minor * minor), choices + count
    return total, choices
