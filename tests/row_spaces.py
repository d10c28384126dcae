"""Which velocities rows hold, however they are combined."""

from __future__ import annotations

from typing import Any

import numpy as np


def projector(rows: Any) -> Any:
    """On the space that the rows span."""
    _, sizes, right = np.linalg.svd(rows)
    basis = right[: int((sizes > 1e-9 * sizes.max()).sum())]
    return basis.T @ basis
