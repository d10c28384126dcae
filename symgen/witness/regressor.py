"""The regressor from energies that are linear in the inertial parameters."""

from __future__ import annotations

import casadi

from symgen.model.by_inertial_parameters import by_inertial_parameters
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange, differentiate


def regressor(model: Model, s: Lagrange, inverse: casadi.SX) -> casadi.SX:
    """Y (m×p) = M̃⁺ ∂τ/∂π with `inverse` = M̃⁺, over the symbols of `s`.

    τ is that of the same mechanism alone, with a parameter π for each of `inertial_parameters`.
    """
    own, given = differentiate(by_inertial_parameters(model)), len(model.parameters)
    slopes = casadi.jacobian(own.balance, own.p[given:])
    here = casadi.vertcat(own.q, own.qd, own.qdd, own.p[:given])
    return inverse @ casadi.substitute(slopes, here, casadi.vertcat(s.q, s.qd, s.qdd, s.p))
