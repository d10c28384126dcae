"""Ten inertial parameters of a body as a symmetric 4 x 4 matrix, which is positive definite where the body can be.

The pseudo-inertia is the integral of (r, 1) (r, 1)^T over the masses, r from the origin of the body's frame: second
moments (kg m^2), first moments (kg m), the mass (Wensing, Kim and Slotine, Linear matrix inequalities for physically
consistent inertial parameter identification, 2018).
"""

from __future__ import annotations

import math

import numpy as np

from symgen.identification.arrays import Array

# Rows and columns of the elements xy, xz, yz of a tensor.
_OFF_DIAGONAL = (0, 0, 1), (1, 2, 2)


def pseudo_inertia(ten: Array) -> Array:
    """The matrix (4, 4) of m, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the origin (10)."""
    tensor = np.diag(ten[4:7])
    tensor[_OFF_DIAGONAL] = ten[7:]
    tensor[_OFF_DIAGONAL[::-1]] = ten[7:]
    matrix = np.empty((4, 4))
    matrix[:3, :3] = np.trace(tensor) / 2 * np.eye(3) - tensor
    matrix[:3, 3] = matrix[3, :3] = ten[1:4]
    matrix[3, 3] = ten[0]
    return matrix


def ten_parameters(matrix: Array) -> Array:
    """The ten (10) of a pseudo-inertia (4, 4)."""
    second = matrix[:3, :3]
    tensor = np.trace(second) * np.eye(3) - second
    return np.array([matrix[3, 3], *matrix[:3, 3], *np.diag(tensor), *tensor[_OFF_DIAGONAL]])


def _directions() -> Array:
    made = []
    for i in range(4):
        for j in range(i + 1):
            one = np.zeros((4, 4))
            one[i, j] = one[j, i] = 1.0 if i == j else math.sqrt(0.5)
            made.append(one)
    return np.array(made)


# Symmetric matrices (10, 4, 4) that are orthonormal: lengths of coordinates are Frobenius's norms.
DIRECTIONS = _directions()


def coordinates(matrix: Array) -> Array:
    """Those (10) of a symmetric matrix along DIRECTIONS."""
    return np.asarray(np.einsum("kij,ij->k", DIRECTIONS, matrix), dtype=np.float64)


def of_coordinates(given: Array) -> Array:
    """The matrix (4, 4) again."""
    return np.asarray(np.einsum("kij,k->ij", DIRECTIONS, given), dtype=np.float64)


def nearest_possible(matrix: Array, least: float) -> Array:
    """The matrix nearest in Frobenius's norm whose eigenvalues are `least` and more (Higham, 1988)."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray((vectors * np.maximum(values, least)) @ vectors.T, dtype=np.float64)


def about_centre(ten: Array) -> tuple[float, Array, Array]:
    """Mass, place of the centre of mass (3), and the inertia tensor about it (3, 3); zeros for what has no mass."""
    mass = float(ten[0])
    centre = ten[1:4] / mass if mass else np.zeros(3)
    xx, yy, zz, xy, xz, yz = ten[4:10]
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    moved = mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    return mass, np.asarray(centre, dtype=np.float64), np.asarray(tensor - moved, dtype=np.float64)
