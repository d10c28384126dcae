"""Where the drives J alone are singular on a path: sign changes of det WᵀM_J, refined by bisecting the path itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from symgen.model.model import Model
from symgen.paths.forces import Forces, kernel_bases, oriented
from symgen.paths.path_equations import Array
from symgen.paths.trajectory import PathSolver, Trajectory

TIME_TOLERANCE = 1e-11  # of a grid interval
NEGLIGIBLE = 1e-12  # of the largest determinant: a sample that is itself singular


class SingularPoses:
    """Finds the poses of a solved path in which δ chosen inputs do not reach every admissible direction."""

    def __init__(self, model: Model, solver: PathSolver, trajectory: Trajectory, forces: Forces) -> None:
        import casadi

        from symgen.witness.lagrange import differentiate
        from symgen.witness.translate import default_parameters

        self._solver = solver
        self._trajectory = trajectory
        self._forces = forces
        s = differentiate(model)
        self._matrices: Any = casadi.Function("matrices", [s.q, s.p], [s.jacobian, s.control])
        self._parameters = default_parameters(model)

    def determinants(self, J: tuple[int, ...]) -> Array:
        """det WᵀM_J (k), continuous along the path; its square is det M̃_JᵀM̃_J."""
        return np.asarray(np.linalg.det(np.swapaxes(self._forces.W, 1, 2) @ self._forces.M[:, :, list(J)]))

    def of(self, J: tuple[int, ...]) -> tuple[tuple[float, Array], ...]:
        """Times and configurations q (n) of the zeros; zeros of even order between two samples are not seen."""
        signed = self.determinants(J)
        zero = np.abs(signed) <= NEGLIGIBLE * np.max(np.abs(signed), initial=0)
        if np.all(zero):
            return ()
        found: list[tuple[float, Array]] = []
        for k, t in enumerate(self._trajectory.t):
            if zero[k]:
                if k == 0 or not zero[k - 1]:
                    found.append((float(t), self._trajectory.q[k]))
            elif k and not zero[k - 1] and signed[k - 1] * signed[k] < 0:
                found.append(self._bisect(J, k - 1, positive=bool(signed[k - 1] > 0)))
        return tuple(found)

    def _bisect(self, J: tuple[int, ...], k: int, positive: bool) -> tuple[float, Array]:
        """The zero between samples k and k + 1, where the determinant leaves its sign at sample k."""
        low, high = float(self._trajectory.t[k]), float(self._trajectory.t[k + 1])
        q, W, tolerance = self._trajectory.q[k], self._forces.W[k], TIME_TOLERANCE * (high - low)
        while high - low > tolerance:
            middle = (low + high) / 2
            if not low < middle < high:
                break
            q_middle = self._solver.follow(q, low, middle)
            W_middle, value = self._signed(q_middle, W, J)
            if (value > 0) == positive:
                low, q, W = middle, q_middle, W_middle
            else:
                high = middle
        return low, q

    def _signed(self, q: Array, like: Array, J: tuple[int, ...]) -> tuple[Array, float]:
        B, M = self._matrices(q, self._parameters)
        W = oriented(kernel_bases(B.full()[None])[0], like)
        return W, float(np.linalg.det(W.T @ M.full()[:, list(J)]))
