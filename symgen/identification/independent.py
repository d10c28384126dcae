"""Which columns say something of their own."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array

# Of a column, what is not a combination of others; below it the column says nothing of its own.
OWN_SHARE = 1e-6
# Of the longest column, what rounding makes of one that is 0.
ROUNDED_LENGTH = 1e-9


def independent_columns(flat: Array) -> list[int]:
    """Columns of (N, c) that no combination of those before them gives, in their order."""
    lengths = np.linalg.norm(flat, axis=0)
    kept: list[int] = []
    basis = np.empty((len(flat), 0))
    for k in np.flatnonzero(lengths > ROUNDED_LENGTH * np.max(lengths, initial=0.0)):
        own = flat[:, k] / lengths[k]
        for _ in range(2):  # the second time takes what rounding left
            own = own - basis @ (basis.T @ own)
        size = float(np.linalg.norm(own))
        if size > OWN_SHARE and len(kept) < len(flat):
            kept.append(int(k))
            basis = np.column_stack([basis, own / size])
    return kept
