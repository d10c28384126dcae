"""The projected quantities, from the unprojected mechanics and the generic ranks."""

from __future__ import annotations

import casadi

from symgen.model.availability import WITHOUT_FRICTION, lacking
from symgen.model.configurations.assembly import ConfigurationRanks
from symgen.model.model import Model
from symgen.model.quantities import MAIN, ROWS
from symgen.witness.allocation import allocated, utilisation
from symgen.witness.given import quantities_of_given
from symgen.witness.lagrange import Lagrange, along
from symgen.witness.linear import compound, pseudoinverse, solve
from symgen.witness.regressor import regressor

# Newton steps towards V of the configuration that is projected.
PROJECTION_STEPS = 2


def derive(model: Model, s: Lagrange, ranks: ConfigurationRanks) -> dict[str, casadi.SX]:
    """Every quantity of the model as a dense symbolic matrix over the symbols of `s`; empty ones are left out."""
    G, B, M = s.mass, s.jacobian, s.control
    identity = casadi.SX.eye(model.n)
    B_plus = pseudoinverse(B, ranks.constraints)
    N = identity - B_plus @ B
    N_dot = _projector_rate(s, N, B_plus, ranks)
    M_plus = pseudoinverse(N @ M, ranks.actuation)
    least = M_plus @ s.balance
    u = least if model.allocation is None else allocated(model, model.allocation, s, N, ranks.actuation)
    v = N @ s.qd
    N_dot_v = _at_rate(s, N_dot, v)
    C_v = _at_rate(s, s.coriolis, v)
    restricted = _inverse_on_kernel(G, N)
    weighted = restricted @ G
    acceleration, multipliers = _forward(s, B_plus, dependent=ranks.constraints < model.r)
    quantities = {
        "mass_matrix": G,
        "coriolis_matrix": s.coriolis,
        "coriolis_force": s.coriolis_force,
        "potential_force": s.potential_force,
        "applied_force": s.applied_force,
        "constraint_residual": s.residual,
        "constraint_jacobian": B,
        "constraint_jacobian_dot": s.jacobian_dot,
        "constraint_pseudoinverse": B_plus,
        "nullspace_projector": N,
        "nullspace_projector_dot": N_dot,
        "weighted_pseudoinverse": (identity - weighted) @ B_plus,
        "weighted_nullspace_projector": weighted,
        "control_matrix": M,
        "projected_control_matrix": N @ M,
        "projected_control_pseudoinverse": M_plus,
        "projected_mass_matrix": N @ G @ N,
        "projected_coriolis_matrix": N @ (C_v @ N + G @ N_dot_v),
        "projected_potential_force": N @ s.potential_force,
        "projected_applied_force": N @ _at_rate(s, s.applied_force, v),
        "admissible_velocity": v,
        "admissible_acceleration": N @ s.qdd + N_dot_v @ v,
        "projected_configuration": _configuration(s, ranks),
        "inverse_dynamics": u,
        "inverse_dynamics_residual": N @ (s.balance - M @ least),
        "forward_dynamics": acceleration,
        "multipliers": multipliers,
        "energy": casadi.vertcat(s.kinetic, s.potential),
        "singularity": _singularity(s, N, model.n, ranks),
    }
    if model.allocation is not None and lacking(ROWS["utilisation"], model) is None:
        quantities["utilisation"] = utilisation(model, model.allocation, s, N, ranks.actuation)
    if lacking(ROWS["regressor"], model) is None:
        quantities["regressor"] = regressor(model, s, M_plus)
    if model.inertial_base is not None and lacking(ROWS["base_regressor"], model) is None:
        quantities["base_regressor"] = regressor(model, s, M_plus)[:, list(model.inertial_base.columns)]
    if model.rough:  # u and what follows from it hold friction of reactions, which is a fixed point
        for name in (*MAIN, *WITHOUT_FRICTION):
            quantities.pop(name, None)
    elif ranks.constraints == model.r and ranks.actuation == min(model.m, model.n - ranks.constraints):
        quantities["inverse_dynamics_jacobian"] = casadi.jacobian(u, casadi.vertcat(s.q, s.qd, s.qdd))
        by = casadi.vertcat(s.q, s.qd, s.qdd)
        quantities["inverse_dynamics_gradient"] = casadi.gradient(casadi.dot(s.further["w_u"], u), by)
        slope = quantities["inverse_dynamics_gradient"]
        quantities["inverse_dynamics_hessian_product"] = casadi.jtimes(slope, by, s.further["v_x"])
        if model.parameters:
            quantities["inverse_dynamics_parameter_jacobian"] = casadi.jacobian(u, s.p)
    if ranks.constraints == model.r and not model.rough:
        by = casadi.vertcat(s.q, s.qd, s.u)
        quantities["forward_dynamics_gradient"] = casadi.gradient(casadi.dot(s.further["w_qdd"], acceleration), by)
        if model.r:
            quantities["multipliers_jacobian"] = casadi.jacobian(multipliers, casadi.vertcat(s.q, s.qd, s.u))
        quantities["forward_dynamics_jacobian"] = casadi.jacobian(acceleration, casadi.vertcat(s.q, s.qd, s.u))
    if ranks.constraints == model.r > 0:
        quantities["constraint_variations"] = _variations(s, ranks)
    quantities |= quantities_of_given(model, s, ranks)
    if model.independent_velocities:
        quantities |= _minimal(model, s, ranks)
    if 0 < model.m == model.n - ranks.constraints == ranks.actuation:
        quantities |= _actuator(s, M_plus.T)
        if model.rough:
            del quantities["actuator_bias"]
    return {name: casadi.densify(value) for name, value in quantities.items() if 0 not in value.shape}


def _at_rate(s: Lagrange, value: casadi.SX, rate: casadi.SX) -> casadi.SX:
    """The same quantity along another velocity."""
    return casadi.substitute(value, s.qd, rate)


def _projector_rate(s: Lagrange, N: casadi.SX, B_plus: casadi.SX, ranks: ConfigurationRanks) -> casadi.SX:
    """Ṅ (n×n) along q̇ as given.

    Differentiated where rank B = r; for dependent rows N is differentiable along V only, so there Remark 9:
    Ṅ = −X − Xᵀ, X = B⁺ Ḃ N.
    """
    if ranks.constraints == s.jacobian.shape[0]:
        return along(N, s.q, s.qd)
    X = B_plus @ s.jacobian_dot @ N
    return -X - X.T


def _inverse_on_kernel(G: casadi.SX, N: casadi.SX) -> casadi.SX:
    """F (FᵀGF)⁻¹ Fᵀ (n×n) for any basis F of ker B; G need be positive definite on ker B only."""
    n = G.shape[0]
    return N @ solve(N @ G @ N + casadi.trace(G) / n * (casadi.SX.eye(n) - N), N)


def _forward(s: Lagrange, B_plus: casadi.SX, dependent: bool) -> tuple[casadi.SX, casadi.SX]:
    """q̈ (n) and λ (r, of least norm) of G q̈ + Bᵀλ = M u − C q̇ − Q + Q_a, B q̈ = −Ḃ q̇.

    For dependent rows the block −(I − B B⁺) makes the matrix regular and sets the free part of λ to zero.
    """
    n, r = s.q.shape[0], s.jacobian.shape[0]
    force = s.control @ s.u - s.coriolis_force - s.potential_force + s.applied_force
    range_projector = s.jacobian @ B_plus if dependent else casadi.SX.eye(r)
    matrix = casadi.vertcat(
        casadi.horzcat(s.mass, s.jacobian.T), casadi.horzcat(s.jacobian, range_projector - casadi.SX.eye(r))
    )
    right = casadi.vertcat(force, -range_projector @ (s.jacobian_dot @ s.qd))
    solution = solve(matrix, right)
    return solution[:n], solution[n:]


def _configuration(s: Lagrange, ranks: ConfigurationRanks) -> casadi.SX:
    """Two Newton steps q − B⁺ g towards V with the geometric rows alone, n."""
    rows = s.residual.shape[0]
    step = s.q - pseudoinverse(s.jacobian[:rows, :], ranks.geometric) @ s.residual
    result = s.q
    for _ in range(PROJECTION_STEPS):
        result = casadi.substitute(step, s.q, result)
    return result


def _singularity(s: Lagrange, N: casadi.SX, n: int, ranks: ConfigurationRanks) -> casadi.SX:
    """Measures in [0, 1] of the distance to constraint and input singularities, 2; 0/0 counts as 0."""
    constraint = casadi.SX(1)
    rows = s.jacobian.shape[0]
    if rows:
        lengths = casadi.sqrt(casadi.sum2(s.jacobian**2))
        unit = s.jacobian / casadi.repmat(casadi.if_else(lengths == 0, 1, lengths), 1, n)
        possible = compound(casadi.diag(lengths != 0), ranks.constraints)[1]  # subsets without a vanishing row
        constraint = _ratio_or_zero(compound(unit @ unit.T, ranks.constraints)[1], possible)
    order = ranks.actuation
    projected = compound(s.control.T @ N @ s.control, order)[1]
    plain = compound(s.control.T @ s.control, order)[1]
    return casadi.vertcat(constraint, _ratio_or_zero(projected, plain))


def _ratio_or_zero(numerator: casadi.SX, denominator: casadi.SX) -> casadi.SX:
    return casadi.if_else(denominator == 0, 0, numerator / denominator)


def _variations(s: Lagrange, ranks: ConfigurationRanks) -> casadi.SX:
    """The projector (3n×3n) onto the changes of (q, q̇, q̈) that the constraints allow.

    With E for all that is to stay 0 on V, written one below another, and E⁺ that answers it place by place, I − E⁺ ∂E:
    rows of places answer changes of q, those of rates changes of q̇, those of accelerations changes of q̈.
    """
    rows = s.residual.shape[0]
    motion = casadi.vertcat(s.q, s.qd, s.qdd)
    held = (s.residual, s.jacobian @ s.qd, s.jacobian @ s.qdd + s.jacobian_dot @ s.qd)
    answers = [pseudoinverse(s.jacobian[:rows, :], ranks.geometric)] if rows else [casadi.SX(s.q.shape[0], 0)]
    answers += [pseudoinverse(s.jacobian, ranks.constraints)] * 2
    projector = casadi.SX.eye(motion.shape[0])
    n = s.q.shape[0]
    for k, (what, answer) in enumerate(zip(held, answers, strict=True)):
        answered = answer @ casadi.jacobian(what, motion) @ projector
        projector[k * n : (k + 1) * n, :] -= answered
    return projector


def _minimal(model: Model, s: Lagrange, ranks: ConfigurationRanks) -> dict[str, casadi.SX]:
    """F (8) for the model's independent velocities, and the coefficients of (9) along q̇ as given."""
    names = [coordinate.name for coordinate in model.coordinates]
    independent = [names.index(name) for name in model.independent_velocities]
    dependent = [i for i in range(model.n) if i not in independent]
    F = casadi.SX.zeros(model.n, len(independent))
    for column, i in enumerate(independent):
        F[i, column] = 1
    if dependent:
        B_1, B_2 = s.jacobian[:, dependent], s.jacobian[:, independent]
        F[dependent, :] = -pseudoinverse(B_1, ranks.constraints) @ B_2
    return {
        "orthogonal_complement": F,
        "minimal_mass_matrix": F.T @ s.mass @ F,
        "minimal_coriolis_matrix": F.T @ (s.coriolis @ F + s.mass @ along(F, s.q, s.qd)),
        "minimal_potential_force": F.T @ s.potential_force,
        "minimal_applied_force": F.T @ s.applied_force,
        "minimal_control_matrix": F.T @ s.control,
    }


def _actuator(s: Lagrange, W: casadi.SX) -> dict[str, casadi.SX]:
    """Equations in the quasi-velocities ν = Mᵀ q̇ (Remark 10), W = (M̃⁺)ᵀ (n×m), all at the velocity W ν."""
    nu = s.control.T @ s.qd
    held = casadi.SX.sym("nu", W.shape[1])
    drift = casadi.substitute(casadi.jtimes(W @ held, s.q, s.qd), held, nu)
    force = s.mass @ drift + s.coriolis_force + s.potential_force - s.applied_force
    return {
        "actuator_velocity": nu,
        "actuator_mass_matrix": W.T @ s.mass @ W,
        "actuator_bias": W.T @ _at_rate(s, force, W @ nu),
    }
