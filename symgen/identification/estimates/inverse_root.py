"""A root of the inverse of normal equations, which are not formed: the condition number is not squared.

Of columns A = U S V^T the inverse of A^T A is W W^T with W = V / S (Golub and Van Loan, Matrix Computations, 5.3).
"""

from __future__ import annotations

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array


def inverse_root(columns: Array) -> Array:
    """W (c, c) with W W^T = (A^T A)^-1 for columns A (N, c), in any units.

    Combinations of columns at unit length that only rounding keeps from 0 count as 0, and so does their part of W.
    """
    count = columns.shape[1]
    lengths = np.linalg.norm(columns, axis=0)
    lengths = np.where(lengths > 0, lengths, 1.0)
    tall = np.pad(columns / lengths, ((0, max(0, count - len(columns))), (0, 0)))
    _, values, rows = linalg.svd(tall, full_matrices=False)
    shown = values > max(tall.shape) * np.finfo(float).eps * values[0]
    inverses = np.where(shown, 1 / np.where(shown, values, 1.0), 0.0)
    return np.asarray(rows.T * inverses / lengths[:, None], dtype=np.float64)
