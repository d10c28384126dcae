"""The nearest possible bodies with SciPy alone: Newton's method with a barrier at the edge of what bodies can be.

The barrier is -log det of each pseudo-inertia; the cost is above its least value by the weight of the barrier times the
sides at most (Boyd and Vandenberghe, Convex optimization, 2004, ch. 11).
"""

from __future__ import annotations

import math

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.bodies.nearest_bodies import LEAST_EIGENVALUE, NearestBodies
from symgen.identification.bodies.pseudo_inertia import DIRECTIONS, coordinates

# Beyond the least eigenvalue, where the way inwards begins.
FIRST_SPARE = 1e-3
# From round to round, what is left of the weight of the barrier.
LESS_BARRIER = 0.1
# Of the cost, what the barrier may still hold it above its least value by.
LEAST_BARRIER = 1e-9
# Newton's step up to whose length whole steps stay possible and converge quadratically.
WHOLE_STEP = 0.25
# Of what slopes promise, the share that a longer step has to bring.
BROUGHT = 0.1
# The length of a step at which a round ends.
NEAR_THE_PATH = 1e-2
# Steps of a round at most.
MOST_BARRIER_STEPS = 100


def by_barrier(problem: NearestBodies) -> Array:
    """x (v), from what is possible on."""
    way = _Inside(problem)
    off = problem.factor @ (problem.possible + FIRST_SPARE * _inwards(problem) - problem.centre)
    sides = 4 * problem.bodies + problem.rotors
    weight = float(off @ off) / sides
    while weight * sides > LEAST_BARRIER * (1 + float(off @ off)):
        weight *= LESS_BARRIER
        off = way.least(off, weight)
    return way.unknowns(off)


def _inwards(problem: NearestBodies) -> Array:
    """The direction (v) in which all eigenvalues of bodies grow by as much, and rotors."""
    inwards = np.zeros(len(problem.centre))
    inwards[: problem.fixed_sign.start] = np.tile(coordinates(np.eye(4)), problem.bodies)
    inwards[problem.fixed_sign] = 1.0
    return inwards


class _Inside:
    """Cost and barrier of what is possible.

    Steps are taken in factor (x - centre), of which the cost is the square of the length: no direction is stiff.
    """

    def __init__(self, problem: NearestBodies) -> None:
        self._problem = problem
        self._steps = linalg.solve_triangular(problem.factor, np.eye(len(problem.centre)))

    def unknowns(self, off: Array) -> Array:
        """x (v)."""
        return np.asarray(self._problem.centre + self._steps @ off, dtype=np.float64)

    def least(self, off: Array, weight: float) -> Array:
        """Where cost and weighted barrier are least, from a possible place on."""
        for _ in range(MOST_BARRIER_STEPS):
            step, length = self._newton_step(off, weight)
            share = 1.0
            if length > WHOLE_STEP:
                here = self._height(off, weight)
                while self._height(off + share * step, weight) > here - BROUGHT * share * length**2:
                    share /= 2
            off = off + share * step
            if length < NEAR_THE_PATH:
                break
        return off

    def _newton_step(self, off: Array, weight: float) -> tuple[Array, float]:
        """The step (v), and its length in the metric of the second derivatives.

        These are rows^T rows: the step is a solution of least squares, and the condition number is not squared.
        """
        rows, ones = self._barrier(self.unknowns(off))
        share = math.sqrt(weight / 2)
        orthonormal, triangle = linalg.qr(np.vstack([np.eye(len(off)), share * rows @ self._steps]), mode="economic")
        turned = orthonormal.T @ np.concatenate([-off, share * ones])
        return linalg.solve_triangular(triangle, turned), float(np.linalg.norm(turned)) / share

    def _height(self, off: Array, weight: float) -> float:
        """Cost and barrier in units of the weight, infinite beyond the edge."""
        x = self.unknowns(off)
        spare = [np.linalg.eigvalsh(one) for one in self._problem.pseudo_inertias(x)]
        values = np.concatenate([*spare, x[self._problem.fixed_sign]]) - LEAST_EIGENVALUE
        return float(off @ off) / weight - float(np.sum(np.log(values))) if np.all(values > 0) else math.inf

    def _barrier(self, x: Array) -> tuple[Array, Array]:
        """Rows (10 b + r, v), squares of which are second derivatives of the barrier, and what slopes are by them.

        Negative slopes are rows^T times the second.
        """
        bodies, rotors = self._problem.bodies, range(len(x))[self._problem.fixed_sign]
        rows = np.zeros((rotors.stop, len(x)))
        for k, matrix in enumerate(self._problem.pseudo_inertias(x)):
            root = np.linalg.cholesky(matrix - LEAST_EIGENVALUE * np.eye(4))
            inverse = linalg.solve_triangular(root, np.eye(4), lower=True)
            part = slice(10 * k, 10 * k + 10)
            rows[part, part] = np.transpose([coordinates(inverse @ one @ inverse.T) for one in DIRECTIONS])
        rows[rotors, rotors] = 1 / (x[rotors] - LEAST_EIGENVALUE)
        return rows, np.concatenate([np.tile(coordinates(np.eye(4)), bodies), np.ones(len(rotors))])
