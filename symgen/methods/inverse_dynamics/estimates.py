"""Counted costs that methods of u cannot fall below, known before they are built.

A method whose bound exceeds the cost of a valid one need not be derived.  Every method evaluates the model's own
expressions (balance, B, M).  Only what is certain is added: rows of B in which every entry differs from zero count, so
that sparse models, where minors vanish, are never judged by the number of their subsets.
"""

from __future__ import annotations

from math import comb

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.system import MethodInput
from symgen.symbolic.matrix import Matrix
from symgen.symbolic.traverse import Cost

# Counted cost that each reflection adds to the data of `householder` at least: a root and a division.
REFLECTION = Cost(0, 0, 0, divisions=1, roots=1, angles=0, functions=0).weight


def least_of_minors(system: MethodInput) -> int:
    """One operation at least for each minor of two rows or more, and its square in their sum."""
    rank = system.generic.rank
    return system.least_cost + _spared(system.generic) + (2 * comb(_dense(system.mechanics), rank) if rank > 1 else 0)


def least_of_basis(system: MethodInput) -> int:
    """A vector with rank + 1 components for each free rate, minors of the rows, and its product with the balance."""
    rank, dense = system.generic.rank, _dense(system.mechanics)
    each = 2 * rank + (2 * rank + 1 if rank > 1 else 1)
    return system.least_cost + _spared(system.generic) + max(dense - rank, 0) * each


def least_of_reflections(system: MethodInput) -> int:
    """A root and a division for each reflection, and what they do to M and the balance."""
    rows = system.mechanics.constraint_jacobian
    return system.least_cost + REFLECTION * len(rows) + _of_reflections(rows, system.mechanics)


def _spared(generic: Genericity) -> int:
    """u.z, z.z and u - z (u.z)/(z.z) where the inputs have an internal force."""
    return 4 * generic.m if generic.m > generic.alpha else 0


def _dense(mechanics: System) -> int:
    """Coordinates that every row of B holds."""
    rows = mechanics.constraint_jacobian
    return sum(all(not row[j].is_zero for row in rows) for j in range(mechanics.n)) if rows else 0


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
