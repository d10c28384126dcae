"""CasADi as its user writes the paper's formulas: full matrices, `inv`, `@`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi

from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange


def user_matrices(s: Lagrange) -> Any:
    """τ = G q̈ + C q̇ + Q − Q_a with the Christoffel matrix C."""
    return s.mass @ s.qdd + s.coriolis @ s.qd + s.potential_force - s.applied_force


def direct_balance(s: Lagrange) -> Any:
    """τ by derivatives along directions, without matrices."""
    momentum = casadi.gradient(s.kinetic, s.qd)
    rates = casadi.jtimes(momentum, casadi.vertcat(s.q, s.qd), casadi.vertcat(s.qd, s.qdd))
    return rates - casadi.gradient(s.kinetic - s.potential, s.q) - s.applied_force


def inverse_dynamics(model: Model, s: Lagrange, balance: Callable[[Lagrange], Any] = user_matrices) -> Any:
    """u = M~⁺ N_B τ (27), M~⁺ by (28) with the first δ inputs as M~1; `balance` gives τ."""
    n, r, m = model.n, model.r, model.m
    delta = n - r
    B = s.jacobian
    N = casadi.SX.eye(n) - (B.T @ casadi.inv(B @ B.T) @ B if r else 0)
    projected = N @ s.control
    split = min(m, delta)
    first, rest = projected[:, :split], projected[:, split:]
    inverse = casadi.inv(first.T @ first) @ first.T
    if m > delta:
        R = inverse @ rest
        lower = casadi.inv(casadi.SX.eye(m - delta) + R.T @ R) @ R.T @ inverse
        inverse = casadi.vertcat(inverse - R @ lower, lower)
    return inverse @ N @ balance(s)


def forward_dynamics(model: Model, s: Lagrange) -> tuple[Any, Any]:
    """q̈ and λ by (14) and (15) as corrected: λ = (B G⁻¹Bᵀ)⁻¹(Ḃ q̇ + B G⁻¹(M u − C q̇ − Q + Q_a))."""
    force = s.control @ s.u - s.coriolis @ s.qd - s.potential_force + s.applied_force
    inverse = casadi.inv(s.mass)
    if not model.r:
        return inverse @ force, casadi.SX(0, 1)
    B = s.jacobian
    multipliers = casadi.inv(B @ inverse @ B.T) @ (s.jacobian_dot @ s.qd + B @ inverse @ force)
    return inverse @ (force - B.T @ multipliers), multipliers
