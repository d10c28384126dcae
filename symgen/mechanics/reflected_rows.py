"""The null space of B by reflections, as every method takes it."""

from __future__ import annotations

from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.linear_algebra.null_space.proportional_columns import FamilySpace, families
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System


def reflected_rows(mechanics: System, generic: Genericity) -> HouseholderSpace:
    """B = [R^T 0] Q^T, one column for those that are multiples of each other.

    N_B is 0, without a rounding, for what is locked where coordinates are the model's own.
    """
    graph, rows, n = mechanics.graph, mechanics.constraint_jacobian, mechanics.n
    locked = generic.locked if type(mechanics) is System and mechanics.change is None else ()
    column_families = families(rows, n)
    if all(len(family.members) == 1 for family in column_families):
        return reflected(graph, rows, n, generic.rank, locked=locked)
    first = [k for k, family in enumerate(column_families) if family.members[0] in locked]
    return FamilySpace(graph, rows, n, generic.rank, column_families, first)
