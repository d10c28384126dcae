"""Short bases W of the null space of B: columns with few terms, whose entries are those of B where these suffice."""

from __future__ import annotations

from typing import Literal

from sympy import Expr, ImmutableDenseMatrix, Integer

from symgen.closedform.algebra.quotient import Matrix, Quotient
from symgen.closedform.exact import Exact
from symgen.closedform.laws.terms import entry_symbol
from symgen.closedform.singular import essential_factors
from symgen.closedform.spelling import Speller
from symgen.records import dataclass

LONGEST_BASIS = 300
"""A basis of the null space with more operations, which fills most of a page, is not printed."""

MOST_BASIS_ROWS = 9
"""A basis with more rows is taller than half a page, and says no more than B does."""


@dataclass(frozen=True, slots=True)
class ShortBasis:
    """W (n x delta), a basis where none of `divisors`, entries of B, vanishes; of kind kernel it loses rank itself."""

    matrix: ImmutableDenseMatrix
    kind: Literal["basis", "kernel"]
    divisors: tuple[Expr, ...] = ()


def short_basis(exact: Exact, speller: Speller, kernel: ImmutableDenseMatrix | None) -> ShortBasis | None:
    """W with one entry of B over another in each place where rows have columns of their own, else the kernel.

    `kernel` is the polynomial basis, where that is short.
    """
    if exact.model.n > MOST_BASIS_ROWS or not exact.delta:
        return None
    own = own_columns(exact)
    if own is not None:
        return _by_own_columns(exact, speller, own)
    if kernel is None or sum(int(entry.count_ops()) for entry in kernel) > LONGEST_BASIS:
        return None
    return ShortBasis(kernel, "kernel")


def own_columns(exact: Exact) -> tuple[int, ...] | None:
    """For each row of B a column in which it alone has an entry, as each leg of a platform has; None without."""
    jacobian = exact.mechanics.jacobian
    if exact.structure.constraint_rank < len(jacobian):
        return None
    chosen = []
    for row in jacobian:
        alone = [j for j, entry in enumerate(row) if entry and sum(bool(other[j]) for other in jacobian) == 1]
        if not alone:
            return None
        chosen.append(min(alone, key=lambda j: (*_awkward(exact, row[j]), j)))
    return tuple(chosen)


def _awkward(exact: Exact, entry: Quotient) -> tuple[bool, int]:
    """How little an entry is fit to divide by: whether it can vanish, and its length."""
    return can_vanish(exact, entry), len(entry.numerator) + len(entry.denominator)


def can_vanish(exact: Exact, entry: Quotient) -> bool:
    """Whether an entry has a factor that may be zero at a configuration."""
    return bool(essential_factors(exact.ring, entry.numerator))


def _by_own_columns(exact: Exact, speller: Speller, own: tuple[int, ...]) -> ShortBasis:
    """The unit matrix in the rows of the other coordinates, quotients of entries of B in those of the own ones."""
    jacobian = exact.mechanics.jacobian
    free = [j for j in range(exact.model.n) if j not in own]
    rows: list[list[Expr]] = [[Integer(int(j == k)) for k in free] for j in range(exact.model.n)]
    for i, pivot in enumerate(own):
        rows[pivot] = [_ratio(speller, jacobian, i, k, pivot) for k in free]
    divisors = [entry_symbol(i, pivot) for i, pivot in enumerate(own) if can_vanish(exact, jacobian[i][pivot])]
    return ShortBasis(ImmutableDenseMatrix(rows), "basis", tuple(divisors))


def _ratio(speller: Speller, jacobian: Matrix, i: int, k: int, pivot: int) -> Expr:
    """- B_ik / B_ip."""
    above = entry_of(speller, jacobian, i, k)
    return -above / entry_of(speller, jacobian, i, pivot) if above else Integer(0)


def entry_of(speller: Speller, jacobian: Matrix, i: int, j: int) -> Expr:
    """An entry of B by its symbol, or what it is where that is a number."""
    entry = jacobian[i][j]
    constant = entry.numerator.is_ground and entry.denominator.is_ground
    return speller.quotient(entry) if constant else entry_symbol(i, j)
