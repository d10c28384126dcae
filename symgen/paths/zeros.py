"""Where the drives J alone are singular on a path: sign changes of det WᵀM_J, refined on the path itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from symgen.model.model import Model
from symgen.paths.forces import Forces, kernel_bases, oriented
from symgen.paths.path_equations import Array
from symgen.paths.trajectory import PathSolver, Trajectory

# Of a grid interval, to which the time of a zero is found.
TIME_TOLERANCE = 1e-12
# Steps to a zero between two samples.
REFINING_STEPS = 60
# Of the largest determinant, at a sample that is itself singular; of the two at the ends, where a zero is found.
SINGULAR_SAMPLE = 1e-12


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
        zero = np.abs(signed) <= SINGULAR_SAMPLE * np.max(np.abs(signed), initial=0)
        if np.all(zero):
            return ()
        zeros: list[tuple[float, Array]] = []
        for k, t in enumerate(self._trajectory.t):
            if zero[k]:
                if k == 0 or not zero[k - 1]:
                    zeros.append((float(t), self._trajectory.q[k]))
            elif k and not zero[k - 1] and signed[k - 1] * signed[k] < 0:
                zeros.append(self._refine(J, k - 1, float(signed[k - 1]), float(signed[k])))
        return tuple(zeros)

    def _refine(self, J: tuple[int, ...], k: int, begin: float, end: float) -> tuple[float, Array]:
        """The zero between samples k and k + 1, with the values of the determinant there.

        Regula falsi with the Illinois rule: the bracket shrinks from both sides and never loses the change of sign.
        """
        low, high = float(self._trajectory.t[k]), float(self._trajectory.t[k + 1])
        q, W, tolerance = self._trajectory.q[k], self._forces.W[k], TIME_TOLERANCE * (high - low)
        t, moved = low, 0
        for _ in range(REFINING_STEPS):
            t = (low * end - high * begin) / (end - begin)
            q_t = self._solver.follow(q, low, t)
            W_t, value = self._signed(q_t, W, J)
            if abs(value) <= SINGULAR_SAMPLE * abs(end - begin) or high - low <= tolerance:
                return t, q_t
            if (value > 0) == (begin > 0):
                low, begin, q, W = t, value, q_t, W_t
                end, moved = (end / 2 if moved == 1 else end), 1
            else:
                high, end = t, value
                begin, moved = (begin / 2 if moved == -1 else begin), -1
        return t, q_t

    def _signed(self, q: Array, like: Array, J: tuple[int, ...]) -> tuple[Array, float]:
        B, M = self._matrices(q, self._parameters)
        W = oriented(kernel_bases(B.full()[None])[0], like)
        return W, float(np.linalg.det(W.T @ M.full()[:, list(J)]))
