"""Inverse dynamics literally as printed, (27) with (28) and partition switching: the reference path for comparisons.

Slower and less accurate than symgen's kernels (it inverts B Bᵀ and Gram matrices and depends on chosen columns of M̃);
kept to show that both agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.paths.path_equations import Array


@dataclass(frozen=True, slots=True)
class SwitchedInputs:
    """u (k×m) along a path, and which partition was in use at each sample (k, indices into the partitions)."""

    u: Array
    partition: tuple[int, ...]


def inverse(a: Any) -> Any:
    """A⁻¹ by elimination with partial pivoting in the type of A; LinAlgError for a pivot of zero.

    The print inverts, so this does.  NumPy's routine would lift float32 to float64, and its last bits are those of the
    LAPACK at hand.
    """
    size = a.shape[0]
    work = np.concatenate([a, np.eye(size, dtype=a.dtype)], axis=1)
    for k in range(size):
        pivot = k + int(np.argmax(np.abs(work[k:, k])))
        if not abs(work[pivot, k]) > 0:
            raise np.linalg.LinAlgError("Singular matrix")
        work[[k, pivot]] = work[[pivot, k]]
        work[k] /= work[k, k]
        for i in range(size):
            if i != k:
                work[i] -= work[i, k] * work[k]
    return work[:, size:]


def projector(B: Array) -> Array:
    """N_B = I − Bᵀ(B Bᵀ)⁻¹ B (21), n×n."""
    return np.asarray(np.eye(B.shape[1], dtype=B.dtype) - B.T @ inverse(B @ B.T) @ B)


def pseudoinverse(M_tilde: Array, first: Sequence[int]) -> Array:
    """M̃⁺ (28), m×n, with M̃₁ the columns `first`; LinAlgError where these δ columns are dependent."""
    second = [j for j in range(M_tilde.shape[1]) if j not in first]
    M_1, M_2 = M_tilde[:, list(first)], M_tilde[:, second]
    M_1_plus = inverse(M_1.T @ M_1) @ M_1.T
    R = M_1_plus @ M_2
    lower = inverse(np.eye(len(second), dtype=M_tilde.dtype) + R.T @ R) @ R.T @ M_1_plus
    result = np.empty((M_tilde.shape[1], M_tilde.shape[0]), dtype=M_tilde.dtype)
    result[list(first)] = M_1_plus @ (np.eye(M_tilde.shape[0], dtype=M_tilde.dtype) - M_2 @ lower)
    result[second] = lower
    return result


def inverse_dynamics(B: Array, M: Array, tau: Array, first: Sequence[int]) -> Array:
    """u = M̃⁺ N_B τ (27), m, for one state with B (r×n), M (n×m), τ (n)."""
    N = projector(B)
    return np.asarray(pseudoinverse(N @ M, first) @ N @ tau)


def switched_inverse_dynamics(
    B: Array, M: Array, tau: Array, partitions: Sequence[Sequence[int]], threshold: float
) -> SwitchedInputs:
    """(27) and (28) along a path (leading axis k), keeping a partition until its determinant falls too low.

    The motion starts with the partition of largest det M̃₁ᵀM̃₁; where the determinant of the one in use drops below
    `threshold`, the one with the largest determinant there takes over (Sec. 5.4).
    """
    current: int | None = None
    used: list[int] = []
    u: list[Array] = []
    for B_k, M_k, tau_k in zip(B, M, tau, strict=True):
        M_tilde = projector(B_k) @ M_k
        values = [float(np.linalg.det(M_tilde[:, list(J)].T @ M_tilde[:, list(J)])) for J in partitions]
        if current is None or values[current] < threshold:
            current = int(np.argmax(values))
        used.append(current)
        u.append(inverse_dynamics(B_k, M_k, tau_k, partitions[current]))
    return SwitchedInputs(np.array(u), tuple(used))
