"""How well conditioned a state is: measures of singularity and condition numbers, from the reference."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.model.quantities import MOTIONS
from symgen.verify.reference.reference import Reference, ReferenceValueError, State

BITS = 256
GRADED = 1e-2
Measures: TypeAlias = tuple[float, float]


class Conditions:
    """Numbers that tell what a normwise stable algorithm may lose at a state."""

    def __init__(self, reference: Reference) -> None:
        self._reference = reference

    def matrix(self, name: str, state: State) -> Any:
        """A quantity as an array of doubles."""
        exact = self._reference.matrices(state, (name,), BITS)[name]
        return np.array([float(x) for x in exact.entries()]).reshape(exact.nrows(), exact.ncols())

    def measures(self, state: State) -> Measures | None:
        """Both measures of singularity; None where they do not exist."""
        try:
            first, second = self.matrix("singularity", state).ravel().tolist()
        except ReferenceValueError:
            return None
        return (first, second) if math.isfinite(first) and math.isfinite(second) else None

    def columns(self, state: State) -> float:
        """How far the columns of M are from depending on each other, 0 to 1.

        Sum of the minors of M'M of the size of the degree of actuation, beside that of orthogonal columns.  The second
        measure of singularity compares M~ with M, and does not see where M itself loses rank.
        """
        M = self.matrix("control_matrix", state)
        rank = self._reference.ranks.actuation
        sizes = np.linalg.norm(M, axis=0)
        subsets = list(combinations(range(M.shape[1]), rank))
        orthogonal = sum(float(np.prod(sizes[list(J)])) ** 2 for J in subsets)
        minors = sum(float(np.prod(np.linalg.svd(M[:, J], compute_uv=False))) ** 2 for J in subsets)
        return minors / orthogonal if orthogonal > 0 else 0.0

    def floor(self, name: str, scalar: Scalar, state: State, measures: Measures | None) -> float:
        """eps κ(B) κ(FᵀM), by 1/κ² ≈ measure of rows of one length.

        FᵀM counts for inputs only, κ(G) for accelerations and multipliers.
        """
        eps = float(UNIT_ROUNDOFF[scalar])
        if measures is None:
            return math.inf
        product = measures[0] * (measures[1] if name == "inverse_dynamics" else 1.0)
        if product <= 0:
            return math.inf
        return eps / math.sqrt(product) * self._of_dependent_rows(state) * self._of_masses(state, name)

    def graded(self, state: State) -> bool:
        """Whether rows of B differ so much in length that lengths are not O(1), as the statuses assume."""
        if not self._reference.system.r:
            return False
        lengths = np.linalg.norm(self.matrix("constraint_jacobian", state), axis=1)
        return bool(lengths.min() < GRADED * lengths.max())

    def _of_masses(self, state: State, name: str) -> float:
        """κ(G), to which the loss of q̈ and λ is compared."""
        if name not in MOTIONS:
            return 1.0
        values = np.linalg.eigvalsh(self.matrix("mass_matrix", state))
        smallest, largest = float(values[0]), float(values[-1])
        return largest / smallest if smallest > 0 else math.inf

    def _of_dependent_rows(self, state: State) -> float:
        """κ(B) as it stands: rows that depend on each other are weighed by their lengths, independent ones are not."""
        rank = self._reference.ranks.constraints
        if rank == self._reference.system.r:
            return 1.0
        sizes = np.linalg.svd(self.matrix("constraint_jacobian", state), compute_uv=False)
        return float(sizes[0] / sizes[rank - 1]) if rank and sizes[rank - 1] > 0 else math.inf
