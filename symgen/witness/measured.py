"""What measured coordinates determine, from its definition: pseudoinverses of S N, and Gauss and Newton's method."""

from __future__ import annotations

import casadi

from symgen.model.configurations.assembly import ConfigurationRanks
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange
from symgen.witness.linear import pseudoinverse

# Steps, each of which leaves a share of what is missing by which the encoders disagree.
SOLVING_STEPS = 8


def measured_quantities(model: Model, s: Lagrange, ranks: ConfigurationRanks) -> dict[str, casadi.SX]:
    """The quantities of a model that names what is measured; none of others."""
    if not model.measured:
        return {}
    n, identity = model.n, casadi.SX.eye(model.n)
    S = identity[list(model.measured_places), :]
    B_plus = pseudoinverse(s.jacobian, ranks.constraints)
    inverse = pseudoinverse(S @ (identity - B_plus @ s.jacobian), n - ranks.constraints)
    velocity = inverse @ s.qd_m
    least = -B_plus @ (casadi.substitute(s.jacobian_dot, s.qd, velocity) @ velocity)
    found = {
        "velocity_from_measured": velocity,
        "acceleration_from_measured": least + inverse @ (s.qdd_m - S @ least),
    }
    rows = s.residual.shape[0]
    if rows and (rows == s.jacobian.shape[0] or len(model.measured) >= n - rows):
        found["configuration_from_measured"] = _configuration(s, S, ranks.geometric)
    return found


def _configuration(s: Lagrange, S: casadi.SX, rank: int) -> casadi.SX:
    """The closed configuration that is nearest to what is measured, from q on."""
    rows, n = s.residual.shape[0], s.q.shape[0]
    B = s.jacobian[:rows, :]
    B_plus = pseudoinverse(B, rank)
    closed = s.q - B_plus @ s.residual
    along = pseudoinverse(S @ (casadi.SX.eye(n) - B_plus @ B), n - rank)
    step = casadi.Function("step", [s.q, s.q_m, s.p], [closed + along @ (s.q_m - S @ closed)])
    result = s.q
    for _ in range(SOLVING_STEPS):
        result = step(result, s.q_m, s.p)
    return result
