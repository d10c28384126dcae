"""The null space of B by reflections, as every method takes it."""

from __future__ import annotations

from symgen.linear_algebra.null_spaces import HouseholderSpace
from symgen.linear_algebra.pivoted import reflected
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System


def reflected_rows(mechanics: System, generic: Genericity) -> HouseholderSpace:
    """B = [R^T 0] Q^T, with 0 in N_B for coordinates that are locked where they are the model's own."""
    locked = generic.locked if type(mechanics) is System and mechanics.change is None else ()
    return reflected(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank, locked=locked)
