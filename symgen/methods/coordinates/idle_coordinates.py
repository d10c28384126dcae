"""Coordinates that stand in B, though its null space does not depend on them.

A point that slides in a plane moves its row of B, and the other rows hold the plane.  N_B depends on q_j where the rows
of dB/dq_j are no sums of those of B: then dN_B/dq_j = -X - X^T with X = B^+ dB/dq_j N_B is not 0.  Of a rate that turns
nothing a kernel would leave rounding, beside what others turn.
"""

from __future__ import annotations

from symgen.linear_algebra.residue_rows import ReducedRows, what_is_left, with_row
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.angles.circle import FIELD
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.matrix import Matrix, identity


def idle_coordinates(mechanics: System, generic: Genericity) -> frozenset[int]:
    """The numbers of coordinates that B depends on and N_B does not, on V and off it; none where that is not known."""
    graph, rows = mechanics.graph, mechanics.constraint_jacobian
    turned = {j: mechanics.constraint_jacobian_dot(axis) for j, axis in enumerate(identity(graph, mechanics.n))}
    idle = {j for j, turning in turned.items() if any(not x.is_zero for row in turning for x in row)}
    for seed in (1, 2):
        point = ExactValues(seed)
        reduced: ReducedRows = {}
        for row in _residues(point, rows) or ():
            reduced = with_row(reduced, row, FIELD.prime)
        if len(reduced) != 2 * generic.rank:
            return frozenset()
        idle = {j for j in idle if _follows(point, turned[j], reduced)}
    return frozenset(idle)


def _follows(point: ExactValues, rows: Matrix, reduced: ReducedRows) -> bool:
    residues = _residues(point, rows)
    return residues is not None and not any(any(what_is_left(reduced, row, FIELD.prime)) for row in residues)


def _residues(point: ExactValues, rows: Matrix) -> list[list[int]] | None:
    """The rows at a point, and i times them: of a + b i all a, then all b.  None where nothing is known of an entry.

    What is a sum of rows with factors of that kind is one of both with residues as factors.
    """
    residues = []
    for row in rows:
        pairs = point.pairs(row)
        if pairs is None:
            return None
        residues += [[a for a, _ in pairs] + [b for _, b in pairs], [-b for _, b in pairs] + [a for a, _ in pairs]]
    return residues
