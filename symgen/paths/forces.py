"""Constraint Jacobian, control matrix and required forces along a trajectory, and the inputs that supply them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.model.model import Model
from symgen.paths.path_equations import Array
from symgen.paths.trajectory import RANK_TOLERANCE, Trajectory


@dataclass(frozen=True, slots=True)
class Forces:
    """Along k samples: B (k×r×n), M (k×n×m), τ = G q̈ + C q̇ + Q − Q_a (k×n), and W (k×n×δ).

    W are orthonormal bases of ker B whose orientation does not change along the trajectory.
    """

    B: Array
    M: Array
    tau: Array
    W: Array


def forces_along(model: Model, trajectory: Trajectory) -> Forces:
    """The forces of a trajectory of one constraint rank, with the model's default parameters."""
    import casadi

    from symgen.witness.lagrange import differentiate
    from symgen.witness.translate import default_parameters

    s = differentiate(model)
    function = casadi.Function("forces", [s.q, s.qd, s.qdd, s.p], [s.jacobian, s.control, s.balance])
    parameters = default_parameters(model)
    samples = zip(trajectory.q, trajectory.qd, trajectory.qdd, strict=True)
    B, M, tau = (np.array(part) for part in zip(*(_full(function(*x, parameters)) for x in samples), strict=True))
    return Forces(B, M, tau[:, :, 0], kernel_bases(B))


def inverse_dynamics(forces: Forces) -> Array:
    """u (k×m) of least norm with WᵀMu = Wᵀτ, by singular values; those that vanish are left out."""
    W_t = np.swapaxes(forces.W, 1, 2)
    left, values, right = np.linalg.svd(W_t @ forces.M, full_matrices=False)
    kept = values > RANK_TOLERANCE * values[:, :1]
    along = np.swapaxes(left, 1, 2) @ (W_t @ forces.tau[:, :, None])
    scaled = np.divide(along[:, :, 0], values, out=np.zeros_like(values), where=kept)
    return np.asarray((np.swapaxes(right, 1, 2) @ scaled[:, :, None])[:, :, 0])


def kernel_bases(B: Array) -> Array:
    """Orthonormal bases W (k×n×δ) of ker B (k×r×n), each oriented like the one before."""
    samples, rows, n = B.shape
    if rows == 0:
        return np.broadcast_to(np.eye(n), (samples, n, n)).copy()
    _, values, Vt = np.linalg.svd(B)
    rank = int(np.max(np.sum(values > RANK_TOLERANCE * values[:, :1], axis=1)))
    W = np.swapaxes(Vt[:, rank:], 1, 2)
    for k in range(1, samples):
        W[k] = oriented(W[k], W[k - 1])
    return np.asarray(W)


def oriented(W: Array, like: Array) -> Array:
    """The basis W (n×δ), its first vector turned round where it is oriented against `like`."""
    if W.shape[1] and np.linalg.det(like.T @ W) < 0:
        return np.concatenate([-W[:, :1], W[:, 1:]], axis=1)
    return W


def _full(values: tuple[Any, ...]) -> tuple[Array, ...]:
    return tuple(value.full() for value in values)
