"""Linear algebra on symbolic matrices, valid wherever the rank is the stated one: no pivots, no choices."""

from __future__ import annotations

import casadi


def householder(matrix: casadi.SX) -> tuple[casadi.SX, casadi.SX]:
    """Q (a×a, orthogonal) and R (a×b) with Q R = matrix (a×b, a ≥ b, full column rank)."""
    rows, columns = matrix.shape
    R = casadi.densify(matrix)
    Q = casadi.SX.eye(rows)
    for column in range(columns):
        v = R[column:, column]
        length = casadi.sqrt(casadi.sumsqr(v))
        v[0] += casadi.if_else(v[0] >= 0, length, -length)
        scaled = v * (2 / casadi.sumsqr(v))
        R[column:, column:] -= scaled @ (v.T @ R[column:, column:])
        Q[:, column:] -= (Q[:, column:] @ v) @ scaled.T
    return casadi.densify(Q), R


def solve(matrix: casadi.SX, right: casadi.SX) -> casadi.SX:
    """matrix⁻¹ right for a regular matrix."""
    Q, R = householder(matrix)
    return _back_substitute(R, Q.T @ right)


def _back_substitute(upper: casadi.SX, right: casadi.SX) -> casadi.SX:
    result = casadi.SX.zeros(upper.shape[1], right.shape[1])
    for row in reversed(range(upper.shape[1])):
        rest = right[row, :] - upper[row, row + 1 :] @ result[row + 1 :, :]
        result[row, :] = rest / upper[row, row]
    return result


def pseudoinverse(matrix: casadi.SX, rank: int) -> casadi.SX:
    """The Moore-Penrose inverse (b×a) of a matrix (a×b) of known rank.

    Full rank: by orthogonal reflections.  Otherwise Aᵀ adj_k(S)/e_k(S) with S = A Aᵀ, e_k the sum of its principal
    k×k minors and adj_k its derivative: by Cauchy-Binet the mean of the inverses over all row subsets of size k,
    weighted by their squared volumes.
    """
    rows, columns = matrix.shape
    if rank == 0:
        return casadi.SX.zeros(columns, rows)
    if rank == columns:
        Q, R = householder(matrix)
        return _back_substitute(R, Q[:, :rank].T)
    if rank == rows or rows > columns:
        return pseudoinverse(matrix.T, rank).T
    adjugate, volume = compound(matrix @ matrix.T, rank)
    return matrix.T @ adjugate / volume


def compound(symmetric: casadi.SX, order: int) -> tuple[casadi.SX, casadi.SX]:
    """adj_k(S) = ∂e_k/∂S (a×a) and e_k(S), the sum of the principal k×k minors (Faddeev and Le Verrier); e_0 = 1."""
    size = symmetric.shape[0]
    adjugate, volume = casadi.SX.zeros(size, size), casadi.SX(1)
    for k in range(1, order + 1):
        adjugate = volume * casadi.SX.eye(size) - symmetric @ adjugate
        volume = casadi.trace(symmetric @ adjugate) / k
    return adjugate, volume
