"""A model's path solved on its sample grid: Newton's method continued along t, rates and accelerations exactly."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from symgen.model.configurations.closing import row_unit
from symgen.model.model import Model, Path
from symgen.paths.path_equations import Array, PathEquations, PathError, path_equations

# Of constraints and conditions on a path, in their own units unless these are far from those of coordinates.
PATH_RESIDUAL = 1e-12
# Of the largest singular value: up to this, one is 0.
RANK_TOLERANCE = 1e-9
# Newton steps to the nearest point of the path.
PATH_NEWTON_STEPS = 30
# Beside 1 and the largest rate: what the conditions of a path may violate non-holonomic rows by.
NONHOLONOMIC_RESIDUAL = 1e-9
# Of a grid interval, where continuation gives up.
SMALLEST_STEP = 1e-6


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Samples of a motion: t (k), and q, qd, qdd (k×n) in the order of the model's coordinates."""

    t: Array
    q: Array
    qd: Array
    qdd: Array


class PathSolver:
    """Solves one path at any time near a known sample; geometric rows may depend on each other (Remark 7)."""

    def __init__(self, model: Model, path: Path, equations: PathEquations | None = None) -> None:
        self.model = model
        self.path = path
        self.equations = path_equations(model, path) if equations is None else equations
        self._units: Array | None = None

    def start(self) -> Array:
        """q at t = 0, by damped Newton steps from the path's `start`, else the model's configuration, else 0."""
        known = {name: float(value) for name, value in (*self.model.configuration, *self.path.start)}
        guess = np.array([known.get(coordinate.name, 0.0) for coordinate in self.model.coordinates])
        solution = self._newton(guess, 0.0)
        if solution is None:
            raise PathError(self.path, "no solution at t = 0 near `start`", "check the conditions, or start nearer")
        self._check_count(solution)
        return solution

    def near(self, guess: Array, t: float) -> Array:
        """q at time t from a guess close to it (n)."""
        solution = self._newton(guess, t)
        if solution is None:
            raise self._lost(t)
        return solution

    def follow(self, q: Array, begin: float, end: float, known: tuple[Array, Array] | None = None) -> Array:
        """q at `end` from q at `begin`, in as many steps as keep Newton's corrections far smaller than the motion.

        `known` are q̇ and q̈ at `begin`, where the caller has them already.
        """
        interval = step = end - begin
        t = begin
        while t < end:
            step = min(step, end - t)
            qd, qdd = known or self.derivatives(q, t)
            motion = qd * step + qdd * step**2 / 2
            solution = self._newton(q + motion, t + step)
            reach = 0.2 * float(np.max(np.abs(motion))) + 1e-3
            if solution is not None and np.max(np.abs(solution - q - motion)) <= reach:
                q, t, known = solution, (end if step == end - t else t + step), None
                step *= 2
            elif step < SMALLEST_STEP * interval:
                raise self._lost(t)
            else:
                step /= 2
        return q

    def derivatives(self, q: Array, t: float) -> tuple[Array, Array]:
        """q̇ and q̈ (n) by differentiating constraints and conditions twice."""
        _, jacobian = self._position(q, t)
        self._check_regular(jacobian, t)
        units = self._units_at(q, t)
        qd = -_least_squares(jacobian, units * self.equations.rate(q, t))
        qdd = -_least_squares(jacobian, units * self.equations.acceleration(q, qd, t))
        if not np.all(np.isfinite(qd) & np.isfinite(qdd)):
            raise PathError(
                self.path,
                f"rates or accelerations are not finite at t = {t:.6g}",
                "write conditions that can be differentiated twice",
            )
        return qd, qdd

    def _position(self, q: Array, t: float) -> tuple[Array, Array]:
        """h and its Jacobian, rows in units far from those of coordinates brought back to the latter."""
        h, jacobian = self.equations.position(q, t)
        units = self._units_at(q, t)
        return units * h, units[:, None] * jacobian

    def _units_at(self, q: Array, t: float) -> Array:
        """The factors of the rows, by their gradients at the first place that is asked for."""
        if self._units is None:
            self._units = np.array([row_unit(row) for row in self.equations.position(q, t)[1].tolist()])
        return self._units

    def _newton(self, q: Array, t: float) -> Array | None:
        """The nearest solution that (damped) Gauss-Newton steps reach, polished to rounding; None if there is none."""
        h, jacobian = self._position(q, t)
        for _ in range(PATH_NEWTON_STEPS):
            if not (np.all(np.isfinite(h)) and np.all(np.isfinite(jacobian))):
                return None
            correction = _least_squares(jacobian, h)
            fraction, before = 1.0, float(np.linalg.norm(h))
            while fraction > 1e-4:
                trial = q - fraction * correction
                h, jacobian = self._position(trial, t)
                if np.linalg.norm(h) < before or before < PATH_RESIDUAL:
                    break
                fraction /= 2
            q = trial
            if np.max(np.abs(correction), initial=0) <= 1e-14 * (1 + np.max(np.abs(q))):
                break
        return q if np.max(np.abs(h), initial=0) < PATH_RESIDUAL else None

    def _check_count(self, q: Array) -> None:
        """As many conditions as V has dimensions, no more, no fewer."""
        _, jacobian = self._position(q, 0.0)
        freedom = self.model.n - _rank(jacobian[: self.equations.geometric_rows])
        count = len(self.path.conditions)
        if count != freedom:
            raise PathError(
                self.path,
                f"the number of conditions is {count}, the local degree of freedom is {freedom}",
                "give as many conditions as the configuration has degrees of freedom",
            )

    def _check_regular(self, jacobian: Array, t: float) -> None:
        if _rank(jacobian) < self.model.n:
            raise PathError(
                self.path,
                f"constraints and conditions do not determine the motion at t = {t:.6g}",
                "avoid this configuration",
            )

    def _lost(self, t: float) -> PathError:
        return PathError(
            self.path, f"no solution beyond t = {t:.6g}", "keep the conditions within what the mechanism can reach"
        )


def solve_path(model: Model, path: Path, equations: PathEquations | None = None) -> Trajectory:
    """The path on `samples` equidistant times, residual of constraints and conditions below 1e-12.

    `equations` are those of the path with other values of the parameters than the model's.

    PathError where there is no solution, where the number of conditions is not δ_loc, or where the prescribed motion
    violates the non-holonomic rows: these cannot be solved for positions, so the conditions must respect them.
    """
    solver = PathSolver(model, path, equations)
    times = np.linspace(0.0, float(path.duration), path.samples)
    positions = [solver.start()]
    derivatives = [solver.derivatives(positions[0], 0.0)]
    for begin, end in pairwise(float(t) for t in times):
        positions.append(solver.follow(positions[-1], begin, end, derivatives[-1]))
        derivatives.append(solver.derivatives(positions[-1], end))
    qd = np.array([rate for rate, _ in derivatives])
    _check_nonholonomic(solver, times, positions, qd)
    return Trajectory(times, np.array(positions), qd, np.array([acceleration for _, acceleration in derivatives]))


def _check_nonholonomic(solver: PathSolver, times: Array, positions: list[Array], qd: Array) -> None:
    for t, q, rate in zip(times, positions, qd, strict=True):
        residual = solver.equations.nonholonomic(q, rate)
        if np.max(np.abs(residual), initial=0) > NONHOLONOMIC_RESIDUAL * (1 + np.max(np.abs(rate))):
            rows = [row.name for row in solver.model.constraints if row.kind == "nonholonomic"]
            worst = rows[int(np.argmax(np.abs(residual)))]
            raise PathError(
                solver.path,
                f"the prescribed motion violates the non-holonomic constraint {worst} at t = {t:.6g} "
                f"(residual {np.max(np.abs(residual)):.3g})",
                "choose conditions that satisfy it: it cannot be solved for positions",
            )


def _least_squares(jacobian: Array, right: Array) -> Array:
    return np.asarray(np.linalg.lstsq(jacobian, right, rcond=RANK_TOLERANCE)[0])


def _rank(matrix: Array) -> int:
    """Numerical rank of a matrix whose rows and columns are of comparable size."""
    if matrix.size == 0:
        return 0
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > RANK_TOLERANCE * values[0]))
