"""Gains of a linear-quadratic regulator, in the coordinates of the model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symgen.linearization.linear_system import Array, LinearSystem, NotLinearizedError, Poles, sorted_poles


@dataclass(frozen=True)
class Regulator:
    """u = u_0 - `of_places` (q - q_0) - `of_rates` q_dot, each m x n, and the poles with it."""

    of_places: Array
    of_rates: Array
    poles: Poles


def regulator(system: LinearSystem, state_weight: float, input_weight: float) -> Regulator:
    """The gains that make the integral of Q |x|^2 + R |v|^2 least (Anderson and Moore, Optimal Control, ch. 3).

    Raises NotLinearizedError where inputs do not reach a pole that is not stable.
    """
    from scipy.linalg import solve_continuous_are

    if not system.model.m:
        raise NotLinearizedError("no gains: the model has no inputs")
    if any(pole.real > -1e-9 for pole in system.unreached):
        raise NotLinearizedError("no gains: the inputs do not reach a pole that is not stable")
    size, m = system.b.shape
    cost = solve_continuous_are(system.a, system.b, state_weight * np.eye(size), input_weight * np.eye(m))
    gains = system.b.T @ cost / input_weight
    k = system.of_places.shape[1]
    return Regulator(
        gains[:, :k] @ system.of_places.T, gains[:, k:] @ system.of_rates.T, sorted_poles(system.a - system.b @ gains)
    )
