"""What measured coordinates or a task determine, from its definition: pseudoinverses of S N, and Newton's method.

Of a task that leaves directions open it is the least motion, and what leaves the task still.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi

from symgen.model.configurations.assembly import ConfigurationRanks
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange, along
from symgen.witness.linear import pseudoinverse

# Steps, each of which leaves a share of what is missing by which the encoders disagree.
SOLVING_STEPS = 8


@dataclass(frozen=True)
class GivenFunctions:
    """Functions of q (k) with their derivatives (k x n), and symbols for their values, rates and accelerations.

    Where these disagree, differences count in `scales` (k).
    """

    functions: casadi.SX
    slopes: casadi.SX
    scales: Sequence[float]
    values: casadi.SX
    rates: casadi.SX
    accelerations: casadi.SX

    def inverse(self, directions: casadi.SX, rank: int) -> casadi.SX:
        """(W S N)^+ W: what is nearest along directions N (n x n), W the diagonal matrix of the scales."""
        weights = casadi.diag(casadi.SX(list(self.scales)))
        return pseudoinverse(weights @ self.slopes @ directions, rank) @ weights


def quantities_of_given(model: Model, s: Lagrange, ranks: ConfigurationRanks) -> dict[str, casadi.SX]:
    """The quantities of a model that names what is measured or has a task; none of others."""
    quantities: dict[str, casadi.SX] = {}
    if model.measured:
        S = casadi.SX.eye(model.n)[list(model.measured_places), :]
        given = (s.further[name] for name in ("q_m", "qd_m", "qdd_m"))
        scales = [float(scale) for scale in model.measured_scales]
        quantities |= _determined(model, s, ranks, GivenFunctions(S @ s.q, S, scales, *given), "measured")
    if model.task:
        slopes = casadi.densify(casadi.jacobian(s.task, s.q))
        quantities |= {"task_position": s.task, "task_velocity": slopes @ s.qd, "task_jacobian": slopes}
        given = (s.further[name] for name in ("x_t", "xd_t", "xdd_t"))
        alike = [1.0] * len(model.task)
        quantities |= _determined(model, s, ranks, GivenFunctions(s.task, slopes, alike, *given), "task")
    return quantities


def _determined(
    model: Model, s: Lagrange, ranks: ConfigurationRanks, given: GivenFunctions, of: str
) -> dict[str, casadi.SX]:
    n, slopes = model.n, given.slopes
    k, rows = slopes.shape[0], s.residual.shape[0]
    quantities = {}
    B_plus = pseudoinverse(s.jacobian, ranks.constraints)
    projector, leaves = casadi.SX.eye(n) - B_plus @ s.jacobian, model.task_leaves
    least_motion = of == "task" and bool(leaves.rates) and not leaves.idle
    if k >= n - ranks.constraints or least_motion:
        inverse = given.inverse(projector, min(k, n - ranks.constraints))
        velocity = inverse @ given.rates
        least = -B_plus @ (casadi.substitute(s.jacobian_dot, s.qd, velocity) @ velocity)
        left = given.accelerations - along(slopes, s.q, velocity) @ velocity
        quantities[f"velocity_from_{of}"] = velocity
        quantities[f"acceleration_from_{of}"] = least + inverse @ (left - slopes @ least)
    if least_motion:
        quantities["acceleration_from_task"] = along(velocity, s.q, velocity) + inverse @ given.accelerations
        quantities["task_nullspace_projector"] = projector - inverse @ (slopes @ projector)
    of_places = rows == s.jacobian.shape[0]
    if (k >= n - ranks.geometric and (of_places or k >= n - rows)) or (least_motion and of_places):
        quantities[f"configuration_from_{of}"] = _configuration(s, given, ranks.geometric)
    return quantities


def _configuration(s: Lagrange, given: GivenFunctions, rank: int) -> casadi.SX:
    """The closed configuration that is nearest to what is given, from q on."""
    rows, n, S = s.residual.shape[0], s.q.shape[0], given.slopes
    B = s.jacobian[:rows, :]
    B_plus = pseudoinverse(B, rank)
    least = -B_plus @ s.residual
    moving = given.inverse(casadi.SX.eye(n) - B_plus @ B, min(S.shape[0], n - rank))
    after = s.q + least + moving @ (given.values - given.functions - S @ least)
    step = casadi.Function("step", [s.q, given.values, s.p], [after])
    result = s.q
    for _ in range(SOLVING_STEPS):
        result = step(result, given.values, s.p)
    return result
