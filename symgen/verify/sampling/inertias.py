"""Where masses determine accelerations: states far from where they do not are those at which kernels are judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from symgen.model.quantities import MOTIONS
from symgen.verify.reference.reference import Reference

# What divides by masses.
DIVIDED_BY_MASSES = frozenset({*MOTIONS, "weighted_pseudoinverse", "weighted_nullspace_projector"})
# What the least inertia is made of.
NEEDED = ("mass_matrix", "nullspace_projector")
# Of the largest share that is met.  Where a direction loses its mass, the share vanishes with the square of the
# distance from there: this is a thousandth of the usual one.
REGULAR_INERTIA = 1e-6


class Inertias:
    """The least inertia of a direction that the constraints allow, beside the largest one, at states of one model."""

    def __init__(self, reference: Reference, quantities: Sequence[str]) -> None:
        self._reference = reference
        self._asked = not DIVIDED_BY_MASSES.isdisjoint(quantities)
        self._largest = 0.0

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that it is made of."""
        return NEEDED if self._asked else ()

    def share(self, matrices: Mapping[str, Any]) -> float:
        """The least over the largest at one state, which has these quantities; 1 where nothing divides by masses."""
        if not self._asked:
            return 1.0
        mass, projector = (_array(matrices[name]) for name in NEEDED)
        # what the constraints hold comes first, with 0
        eigenvalues = np.linalg.eigvalsh(projector @ mass @ projector)[self._reference.ranks.constraints :]
        if not len(eigenvalues) or not np.isfinite(eigenvalues).all() or eigenvalues[-1] <= 0:
            return 1.0
        share = max(0.0, float(eigenvalues[0] / eigenvalues[-1]))
        self._largest = max(self._largest, share)
        return share

    def is_regular(self, share: float) -> bool:
        """Whether a state of this share is far from where a direction has no mass, as far as states were met."""
        return share >= REGULAR_INERTIA * self._largest


def _array(matrix: Any) -> Any:
    return np.array([[float(x) for x in row] for row in matrix.tolist()])
