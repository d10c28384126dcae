"""Rows in floats: their lengths, their rank, and what they leave free."""

from __future__ import annotations

from typing import Any

import numpy as np

from symgen.laboratory.zoo.witness.kkt import EquationValues
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING

# of the largest singular value: what is less is none
SAME = 1e-8


def normalized(rows: Any) -> Any:
    """Rows of length 1; those that vanish left out."""
    lengths = np.linalg.norm(rows, axis=1)
    return rows[lengths > NOTHING] / lengths[lengths > NOTHING, None]


def null_space(at: EquationValues, rank: int | None = None) -> Any:
    """Orthonormal columns that span the velocities which the constraints allow, of this rank where it is known."""
    rows: Any = normalized(np.array(at.rows, dtype=float).reshape(-1, at.n))
    if not rows.size:
        return np.eye(at.n)
    values, directions = np.linalg.svd(rows)[1:]
    held = int((values > SAME * values.max()).sum()) if rank is None else rank
    free = directions[held:].T
    # a coordinate that cannot move stands still: float32 has no squares of what rounding leaves of its rate
    return np.where(np.abs(free) > NOTHING, free, 0.0)


def rank_of(rows: Any, threshold: float, absolute: bool = False) -> int:
    """How many singular values are above the threshold, relative to the largest unless it is `absolute`."""
    if not rows.size:
        return 0
    values = np.linalg.svd(rows, compute_uv=False)
    return int((values > threshold * (1.0 if absolute else values.max())).sum())
