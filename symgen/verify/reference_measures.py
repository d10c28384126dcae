"""The two measures of `singularity` at one state, from Gram determinants: how far B and M~ are from losing rank."""

from __future__ import annotations

from itertools import combinations
from math import comb
from typing import Any

from flint import arb, arb_mat

from symgen.verify.reference_evaluation import Evaluation
from symgen.verify.reference_linear import columns_of, determinant, rows_of, sums_of_minors

MOST_DETERMINANTS = 10


def constraint_measure(e: Evaluation) -> Any:
    """Mean of det(B_I B_I') over the subsets I of rho rows divided by their norms; 0 for a vanishing row."""
    r, rank = e.system.r, e.ranks.constraints
    if r == 0:
        return arb(1)
    rows = []
    for row in e.at.constraints.tolist():
        size = sum((x * x for x in row), arb(0)).sqrt()
        if not size.contains(0):
            rows.append([x / size for x in row])
    if len(rows) < rank:
        return arb(0)
    unit = arb_mat(len(rows), e.system.n, [x for row in rows for x in row])
    return sum_of_minors(unit * unit.transpose(), rank) / comb(len(rows), rank)


def actuation_measure(e: Evaluation) -> Any:
    """e(M~)/e(M), e(X) the sum of det(X_J'X_J) over the subsets J of alpha inputs; 0/0 is 0."""
    projected = sum_of_minors(e.projected_control.transpose() * e.projected_control, e.ranks.actuation)
    plain = sum_of_minors(e.at.control.transpose() * e.at.control, e.ranks.actuation)
    return arb(0) if plain.contains(0) else projected / plain


def sum_of_minors(gram: Any, size: int) -> Any:
    """The sum of the principal minors of a size; many of them as a coefficient of the characteristic polynomial."""
    if comb(gram.nrows(), size) > MOST_DETERMINANTS:
        return sums_of_minors(gram)[size]
    total = arb(0)
    for subset in combinations(range(gram.nrows()), size):
        total += determinant(rows_of(columns_of(gram, subset), subset))
    return total
