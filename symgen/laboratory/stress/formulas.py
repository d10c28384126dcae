"""The paper's formulas in NumPy, in the precision of their data: (9), and (27) with (28) beside (14) and (15).

They start from B, M, G, C, Q as the generated kernels compute them, so that errors are those of the formulas.  A
choice of coordinates or inputs that fails raises LinAlgError.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from symgen.paths.printed import inverse, projector, pseudoinverse

Values: TypeAlias = Any  # array of float64 or float32


@dataclass(frozen=True, slots=True)
class Data:
    """One state: G, C (n×n), B, Ḃ (r×n), M (n×m), Q = Q − Q_a, q̇, q̈ (n), u (m), all of one type."""

    G: Values
    C: Values
    B: Values
    B_dot: Values
    M: Values
    Q: Values
    qd: Values
    qdd: Values
    u: Values

    @property
    def tau(self) -> Values:
        """τ = G q̈ + C q̇ + Q."""
        return self.G @ self.qdd + self.C @ self.qd + self.Q


def partitioned(data: Data, independent: Sequence[int]) -> dict[str, Values]:
    """Coordinate partitioning (9): u, q̈, λ and N_B with F = [−B₁⁻¹B₂; I] of the independent velocities."""
    n = data.G.shape[0]
    dependent = [j for j in range(n) if j not in independent]
    chosen = list(independent)
    F = np.zeros((n, len(chosen)), dtype=data.G.dtype)
    F[chosen] = np.eye(len(chosen), dtype=data.G.dtype)
    F_dot = np.zeros_like(F)
    B_1_inverse = inverse(data.B[:, dependent])
    F[dependent] = -B_1_inverse @ data.B[:, chosen]
    F_dot[dependent] = -B_1_inverse @ (data.B_dot @ F)
    G = F.T @ data.G @ F
    bias = F.T @ (data.G @ (F_dot @ data.qd[chosen]) + data.C @ data.qd + data.Q)
    result = {"nullspace_projector": F @ inverse(F.T @ F) @ F.T}
    M = F.T @ data.M
    drive = np.zeros(len(chosen), dtype=data.G.dtype)
    if data.M.shape[1]:
        result["inverse_dynamics"] = _least_norm(M, G @ data.qdd[chosen] + bias)
        drive = M @ data.u
    qdd = F @ (inverse(G) @ (drive - bias)) + F_dot @ data.qd[chosen]
    result["forward_dynamics"] = qdd
    rest = (data.M @ data.u if data.M.shape[1] else 0) - data.G @ qdd - data.C @ data.qd - data.Q
    result["multipliers"] = B_1_inverse.T @ rest[dependent]
    return result


def _least_norm(M: Values, force: Values) -> Values:
    """M̄⁺ f for a δ×m matrix of full row rank, or of full column rank where there are fewer inputs."""
    if M.shape[0] <= M.shape[1]:
        return M.T @ (inverse(M @ M.T) @ force)
    return inverse(M.T @ M) @ (M.T @ force)


def projected(data: Data, first: Sequence[int]) -> dict[str, Values]:
    """(27) and (28) with M̃₁ the columns `first` (NaN where they are dependent), N_B by (21), λ and q̈ by (14), (15)."""
    N = projector(data.B)
    result = {"nullspace_projector": N, **_multipliers_first(data)}
    if data.M.shape[1]:
        try:
            result["inverse_dynamics"] = pseudoinverse(N @ data.M, first) @ (N @ data.tau)
        except np.linalg.LinAlgError:
            result["inverse_dynamics"] = np.full(data.M.shape[1], np.nan)  # the rest does not choose inputs
    return result


def switched(data: Data, choices: Sequence[Sequence[int]]) -> dict[str, Values]:
    """As `projected`, with the inputs of largest det M̃₁ᵀM̃₁ (Sec. 5.4)."""
    M = projector(data.B) @ data.M
    sizes = [abs(float(np.linalg.det((M[:, list(J)].T @ M[:, list(J)]).astype(np.float64)))) for J in choices]
    return projected(data, choices[int(np.argmax(sizes))])


def _multipliers_first(data: Data) -> dict[str, Values]:
    """λ (14), then q̈ (15)."""
    G_inverse = inverse(data.G)
    force = (data.M @ data.u if data.M.shape[1] else 0) - data.C @ data.qd - data.Q
    multipliers = inverse(data.B @ G_inverse @ data.B.T) @ (data.B_dot @ data.qd + data.B @ (G_inverse @ force))
    return {"multipliers": multipliers, "forward_dynamics": G_inverse @ (force - data.B.T @ multipliers)}
