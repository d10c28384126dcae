"""Counted costs that forms of u cannot fall below, known before they are built.

A form whose bound exceeds the cost of one that is admitted need not be derived.  Every form evaluates the model's own
expressions (balance, B, M).  Only what is certain is added: rows of B in which every entry differs from zero count, so
that sparse models, where minors vanish, are never judged by the number of their subsets.
"""

from __future__ import annotations

from math import comb

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.angles import share_angles
from symgen.symbolic.matrix import Matrix, flatten
from symgen.symbolic.traverse import cost

# A root and a division for each reflection are the least that the Householder form adds to its data.
REFLECTION = 12


def least_costs(mechanics: System, generic: Genericity) -> dict[str, int]:
    """Bounds of `minor`, `nullspace` and `householder`, in the units of `Form.weight`."""
    rows, rank = mechanics.constraint_jacobian, generic.rank
    data = [*mechanics.balance, *flatten(rows), *flatten(mechanics.control_matrix)]
    # u.z, z.z and u - z (u.z)/(z.z) where the inputs have an internal force
    spared = 4 * generic.m if generic.m > generic.alpha else 0
    base = cost(share_angles(mechanics.graph, data)).weight
    dense = sum(all(not row[j].is_zero for row in rows) for j in range(mechanics.n)) if rows else 0
    return {
        "minor": base + spared + _of_minors(dense, rank),
        "nullspace": base + spared + _of_basis(dense, rank),
        "householder": base + REFLECTION * len(rows) + _of_reflections(rows, mechanics),
    }


def _of_minors(dense: int, rank: int) -> int:
    """One operation at least for each minor of two rows or more, and its square in their sum."""
    return 2 * comb(dense, rank) if rank > 1 else 0


def _of_basis(dense: int, rank: int) -> int:
    """A vector with rank + 1 components for each free rate, minors of the rows, and its product with the balance."""
    return max(dense - rank, 0) * (2 * rank + (2 * rank + 1 if rank > 1 else 1))


def _of_reflections(rows: Matrix, mechanics: System) -> int:
    """Each reflection of each column of M and of the balance that it meets: a product for every entry it changes.

    Filled-in entries are followed; an entry is counted once though it takes a product and a difference.
    """
    reflectors: list[frozenset[int]] = []
    for k, row in enumerate(rows):
        support = _filled(frozenset(j for j, entry in enumerate(row) if not entry.is_zero), reflectors)
        reflectors.append(frozenset(j for j in support if j >= k) | {k})
    columns = [frozenset(i for i, entry in enumerate(column) if not entry.is_zero) for column in mechanics.inputs]
    total = 0
    for column in (*columns, frozenset(range(mechanics.n))):
        support = column
        for reflector in reflectors:
            if len(reflector) > 1 and support & reflector:
                total += len(reflector)
                support |= reflector
    return total


def _filled(support: frozenset[int], reflectors: list[frozenset[int]]) -> frozenset[int]:
    for reflector in reflectors:
        if support & reflector:
            support |= reflector
    return support
