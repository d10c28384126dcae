"""A path of many machines that differ in parameters, solved side by side; what goes wrong is left to `solve_path`."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from symgen.model.configurations.closing import row_unit
from symgen.model.model import Model, Path
from symgen.paths.path_equations import Array, PathEquations, PathError
from symgen.paths.trajectory import PATH_RESIDUAL, RANK_TOLERANCE, PathSolver, Trajectory, solve_path

# Steps to the path from a prediction, all with the derivatives there: each takes a share of the error off.
CHORD_STEPS = 12
# Of what is predicted: how far the path may be from there, as where one machine is followed alone.
PREDICTED_SHARE = 0.2
# Beside this share, in units of coordinates.
PREDICTED_DISTANCE = 1e-3
# Of 1 and the largest coordinate: the correction after which there is no further one.
LAST_CORRECTION = 1e-14


class PathFamily:
    """One path of a model with its equations, for machines with any parameters."""

    def __init__(self, model: Model, path: Path, equations: PathEquations) -> None:
        self._model, self._path, self._equations = model, path, equations
        self._has_rates = any(row.kind == "nonholonomic" for row in model.constraints)

    def solved(self, parameters: Array) -> list[Trajectory | None]:
        """The motions of c machines with these parameters (c×...), None where the path has no solution.

        Each is the same to the last bit whatever others stand beside it.
        """
        if self._has_rates:
            # what rows of rates leave is looked at one machine after the other
            return [self._alone(p) for p in parameters]
        starts = [self._start(p) for p in parameters]
        known = [k for k, start in enumerate(starts) if start is not None]
        made: list[Trajectory | None] = [None] * len(parameters)
        if known:
            q = np.array([starts[k] for k in known])
            for k, motion in zip(known, self._followed(parameters[known], q), strict=True):
                made[k] = self._alone(parameters[k]) if motion is None else motion
        return made

    def _alone(self, p: Array) -> Trajectory | None:
        try:
            return solve_path(self._model, self._path, self._equations.of(p.tolist()))
        except PathError:
            return None

    def _start(self, p: Array) -> Array | None:
        try:
            return PathSolver(self._model, self._path, self._equations.of(p.tolist())).start()
        except PathError:
            return None

    def _followed(self, p: Array, q: Array) -> list[Trajectory | None]:
        """Motions from q (c×n) at the start; None for a machine that needs shorter steps, or is lost."""
        times = np.linspace(0.0, float(self._path.duration), self._path.samples)
        rows = self._equations.positions(q, 0.0, p)[1]
        units = np.array([[row_unit(row) for row in one] for one in rows.tolist()])
        lost = np.zeros(len(p), dtype=np.bool_)
        qd, qdd = self._derivatives(q, 0.0, p, units, lost)
        motion = [(q, qd, qdd)]
        for begin, end in pairwise(map(float, times)):
            q = self._stepped(motion[-1], begin, end, p, units, lost)
            motion.append((q, *self._derivatives(q, end, p, units, lost)))
        q_all, qd_all, qdd_all = (np.stack(part, axis=1) for part in zip(*motion, strict=True))
        return [
            None if lost[k] else Trajectory(times, q_all[k], qd_all[k], qdd_all[k]) for k in range(len(p))
        ]

    def _stepped(
        self,
        motion: tuple[Array, Array, Array],
        begin: float,
        end: float,
        p: Array,
        units: Array,
        lost: NDArray[np.bool_],
    ) -> Array:
        """q at `end`; machines that do not come there from the prediction stay and are `lost`."""
        q, qd, qdd = motion
        step = end - begin
        moved = qd * step + qdd * step**2 / 2
        there = q + moved
        h, jacobian = self._rows(there, end, p, units)
        inverse, _ = _inverses(jacobian)
        done = lost.copy()
        for _ in range(CHORD_STEPS):
            correction = np.where(done[:, None], 0.0, _applied(inverse, h))
            there = there - correction
            done |= np.abs(correction).max(axis=1) <= LAST_CORRECTION * (1 + np.abs(there).max(axis=1))
            h, _ = self._rows(there, end, p, units)
            if done.all():
                break
        reach = PREDICTED_SHARE * np.abs(moved).max(axis=1) + PREDICTED_DISTANCE
        near = np.abs(there - q - moved).max(axis=1) <= reach
        lost |= ~(done & near & (np.abs(h).max(axis=1, initial=0) < PATH_RESIDUAL))
        return np.where(lost[:, None], q, there)

    def _rows(self, q: Array, t: float, p: Array, units: Array) -> tuple[Array, Array]:
        h, jacobian = self._equations.positions(q, t, p)
        return units * h, units[:, :, None] * jacobian

    def _derivatives(
        self, q: Array, t: float, p: Array, units: Array, lost: NDArray[np.bool_]
    ) -> tuple[Array, Array]:
        """q̇ and q̈ (c×n); machines whose motion is not determined are `lost`, and stand still."""
        inverse, regular = _inverses(self._rows(q, t, p, units)[1])
        qd = -_applied(inverse, units * self._equations.rates(q, t, p))
        qdd = -_applied(inverse, units * self._equations.accelerations(q, qd, t, p))
        lost |= ~(regular & np.isfinite(qd).all(axis=1) & np.isfinite(qdd).all(axis=1))
        return np.where(lost[:, None], 0.0, qd), np.where(lost[:, None], 0.0, qdd)


def _inverses(jacobian: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Pseudoinverses (c×n×k) of Jacobians (c×k×n), and which of them have rank n."""
    finite = np.asarray(np.isfinite(jacobian).all(axis=(1, 2)))
    left, values, right = np.linalg.svd(np.where(finite[:, None, None], jacobian, 0.0), full_matrices=False)
    kept = values > RANK_TOLERANCE * values[:, :1]
    inverted = np.divide(1.0, values, out=np.zeros_like(values), where=kept)
    # sums in one order, however many machines there are
    inverse = sum(
        (right[:, i, :, None] * inverted[:, i, None, None]) * left[:, None, :, i] for i in range(values.shape[1])
    )
    return np.asarray(inverse), finite & (kept.sum(axis=1) == jacobian.shape[2])


def _applied(matrices: Array, vectors: Array) -> Array:
    """Matrices (c×n×k) times vectors (c×k), summed in one order."""
    return np.asarray(sum(matrices[:, :, i] * vectors[:, i, None] for i in range(vectors.shape[1])))
