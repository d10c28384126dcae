"""The two measures of `singularity` at one state, from Gram determinants: how far B and M~ are from losing rank."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from math import comb, prod
from typing import Any

from flint import arb, arb_mat

from symgen.verify.reference.arithmetic.blocks import sum_of_minors
from symgen.verify.reference.configurations.parts import Part, piece
from symgen.verify.reference.evaluation import Evaluation


def constraint_measure(e: Evaluation) -> Any:
    """Mean of det(B_I B_I') over the subsets I of rho rows divided by their norms; 0 for a vanishing row."""
    return _constraints(e, e.system.parts, e.ranks.constraints)


def actuation_measure(e: Evaluation) -> Any:
    """e(M~)/e(M), e(X) the sum of det(X_J'X_J) over the subsets J of alpha inputs; 0/0 is 0."""
    return _inputs(e, e.system.parts, e.ranks.actuation)


def measures_of_parts(e: Evaluation) -> list[Any]:
    """Both measures of each part of the system; of all together where it is not known which parts lack ranks."""
    parts = e.system.parts
    ranks = e.ranks.of_parts
    if len(ranks) != len(parts):
        return [constraint_measure(e), actuation_measure(e)]
    measures = []
    for part, (constraints, actuation) in zip(parts, ranks, strict=True):
        measures += [_constraints(e, (part,), constraints), _inputs(e, (part,), actuation)]
    return measures


def _constraints(e: Evaluation, parts: Sequence[Part], rank: int) -> Any:
    if rank == 0:
        return arb(1)
    grams, count = [], 0
    for part in parts:
        rows = []
        for row in piece(e.at.constraints, part.rows, part.coordinates).tolist():
            size = sum((x * x for x in row), arb(0)).sqrt()
            if not size.contains(0):
                rows.append([x / size for x in row])
        unit = arb_mat(len(rows), len(part.coordinates), [x for row in rows for x in row])
        grams.append(unit * unit.transpose())
        count += len(rows)
    if count < rank:
        return arb(0)
    return sum_of_minors(grams, rank) / comb(count, rank)


def _inputs(e: Evaluation, parts: Sequence[Part], rank: int) -> Any:
    if e.driven is not None:
        own = (x for part, x in zip(e.system.parts, e.driven, strict=True) if part in parts)
        with suppress(ZeroDivisionError):  # where inputs act alike, or rows are, minors of the whole say what counts
            return prod((x.share() for x in own), start=arb(1))
    columns = [
        [piece(matrix, part.coordinates, part.inputs) for part in parts]
        for matrix in (e.projected_control, e.at.control)
    ]
    projected, plain = (sum_of_minors([x.transpose() * x for x in pieces], rank) for pieces in columns)
    return arb(0) if plain.contains(0) else projected / plain
