"""How far ranks are from dropping, in scalings that rows, masses and coordinates do not change.

Rows of B count by their directions, coordinates both as they are given and in units in which each of them has the same
inertia: a light body is no massless one, and a long lever no drop of rank.
"""

from __future__ import annotations

from math import comb
from typing import Any

import numpy as np

from symgen.ir.kernel import Status
from symgen.laboratory.stress.conditions import Conditions
from symgen.verify.reference.friction import friction_of
from symgen.verify.reference.reference import REFERENCE_BITS, Reference, ReferenceValueError, State

# Of kappa, where kernels lock, less what rounding makes of it.
LEAST_ROOM = 0.5 * (1 - 1e-5)


class ScaledMeasures:
    """The measures of a state that a status may be due to; 1 is as far from a drop of rank as can be."""

    def __init__(self, reference: Reference) -> None:
        self._reference = reference
        self._conditions = Conditions(reference)

    def at(self, state: State) -> dict[Status, float]:
        """The measures of ranks, and where friction grows with reactions how far that is from locking."""
        reference = self._reference
        locking = {Status.FRICTION_LOCK: least_room(reference, state)} if reference.model.rough else {}
        return self._of_ranks(state) | locking

    def _of_ranks(self, state: State) -> dict[Status, float]:
        """Squares of volumes for ranks, a volume for the mass matrix along the constraints; 0 where there is none."""
        conditions, ranks, system = self._conditions, self._reference.ranks, self._reference.system
        measures = conditions.measures(state)
        if measures is None:
            return {Status.CONSTRAINT_RANK: 0.0, Status.ACTUATION_RANK: 0.0, Status.MASS_RANK: 0.0}
        constraint, actuation = measures
        mass = 1.0
        try:
            G = conditions.matrix("mass_matrix", state)
            B = conditions.matrix("constraint_jacobian", state) if system.r else np.zeros((0, system.n))
        except ReferenceValueError:
            return {Status.CONSTRAINT_RANK: constraint, Status.ACTUATION_RANK: actuation, Status.MASS_RANK: 0.0}
        sizes = np.sqrt(np.abs(np.diag(G)))
        if np.all(sizes > 0):
            scaled = B / sizes
            constraint = min(constraint, _volume(scaled, ranks.constraints))
            mass = _along(G / np.outer(sizes, sizes), scaled, ranks.constraints)
        else:
            mass = _along(G / max(float(np.abs(G).max()), 1e-300), B, ranks.constraints)
        inputs = min(actuation, conditions.columns(state)) if ranks.actuation else 1.0
        return {
            Status.CONSTRAINT_RANK: constraint,
            Status.ACTUATION_RANK: constraint * inputs,
            Status.MASS_RANK: mass,
        }


def least_room(reference: Reference, state: State) -> float:
    """1 / (2 kappa), at most 1 where friction locks, for a motion or for inputs; 0 where ranks drop.

    What rounding makes of kappa counts as locking.
    """

    def largest() -> float:
        e = reference.evaluation(state)
        return max(float(friction_of(e, of_motion).kappa) for of_motion in (False, True))

    try:
        kappa = reference.regular(largest, REFERENCE_BITS)
    except ReferenceValueError:
        return 0.0
    return LEAST_ROOM / kappa if kappa else 2.0


def _unit_rows(B: Any) -> Any:
    lengths = np.linalg.norm(B, axis=1, keepdims=True)
    return B / np.where(lengths > 0, lengths, 1.0)


def _volume(B: Any, rank: int) -> float:
    """The mean of det(B_I B_I') over the subsets I of as many rows of length 1 as the rank."""
    if not rank:
        return 1.0
    squares = np.linalg.svd(_unit_rows(B), compute_uv=False) ** 2
    sums = [1.0, *(0.0 for _ in range(rank))]
    for square in squares:
        for k in range(rank, 0, -1):
            sums[k] += float(square) * sums[k - 1]
    return sums[rank] / comb(len(B), rank)


def _along(G: Any, B: Any, rank: int) -> float:
    """det(F'GF) for an orthonormal basis F of ker B."""
    n = len(G)
    if rank == n:
        return 1.0
    basis = np.linalg.svd(_unit_rows(B), full_matrices=True)[2][rank:].T if len(B) else np.eye(n)
    return float(np.prod(np.clip(np.linalg.eigvalsh(basis.T @ G @ basis), 0.0, None)))
