"""The quantities of docs/quantities.md at one state, each from its definition.

Equation numbers are those of the paper as corrected in docs/paper.md; notation as in `evaluation`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from symgen.model.quantities import DIRECTION, ROWS
from symgen.verify.reference.arithmetic.linear import column, identity, right_pseudoinverse
from symgen.verify.reference.base_regressor import base_parameters, base_regressor
from symgen.verify.reference.configurations.given import QUANTITIES_OF_GIVEN
from symgen.verify.reference.configurations.parts import placed
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.friction import friction_of
from symgen.verify.reference.inputs.allocation import allocated, utilisation
from symgen.verify.reference.measures import actuation_measure, constraint_measure
from symgen.verify.reference.regressor import regressor
from symgen.verify.reference.slopes import curvature, jacobian


def _inverse_dynamics(e: Evaluation) -> Any:
    """u (27), as the model's allocation says, or with the friction of reactions."""
    if e.system.model.rough:
        return e.control_inverse * (e.projector * (e.load + friction_of(e).force))
    allocation = e.system.model.allocation
    if allocation is not None:
        return allocated(e, allocation)
    return e.inputs


def _friction_residual(e: Evaluation) -> Any:
    return e.projector * (e.load + friction_of(e).force - e.at.control * column(e.u))


def _utilisation(e: Evaluation) -> Any:
    allocation = e.system.model.allocation
    assert allocation is not None
    return utilisation(e, allocation)


def _inverse_dynamics_jacobian(e: Evaluation) -> Any:
    """The derivatives of u by (q, qd, qdd)."""
    return jacobian(e, _inverse_dynamics, ("q", "qd", "qdd"))


def _inverse_dynamics_gradient(e: Evaluation) -> Any:
    """J_u^T w, the weights being the numbers that are given as u."""
    return _inverse_dynamics_jacobian(e).transpose() * column(e.u)


def _inverse_dynamics_hessian_product(e: Evaluation) -> Any:
    """The second derivatives of w^T u times v, the weights being given as u and the direction as (qd, qdd, q)."""

    def weighted(at: Evaluation) -> Any:
        return column(e.u).transpose() * _inverse_dynamics(at)

    return curvature(e, weighted, {"q": e.qd, "qd": e.qdd, "qdd": e.q})


def _inverse_dynamics_parameter_jacobian(e: Evaluation) -> Any:
    """The derivatives of u by the parameters."""
    return jacobian(e, _inverse_dynamics, ("parameters",))


def _forward_dynamics_jacobian(e: Evaluation) -> Any:
    """The derivatives of qdd by (q, qd, u)."""
    return jacobian(e, lambda at: at.accelerations, ("q", "qd", "u"))


def _forward_dynamics_gradient(e: Evaluation) -> Any:
    """J_a^T w, the weights being the numbers that are given as qdd."""
    return _forward_dynamics_jacobian(e).transpose() * column(e.qdd)


def _constraint_acceleration(e: Evaluation) -> Any:
    return e.at.constraints * column(e.qdd) + e.motion(e.rate)[1]


def _constraint_variations(e: Evaluation) -> Any:
    """The projector onto (dq, dqd, dqdd) that keep g = 0, B qd = 0 and B qdd + Bdot qd = 0."""
    n = e.system.n
    _, rows = e.system.geometry(e.q, e.parameters, e.literals)
    places = identity(n)
    if e.system.r_geometric:
        places -= right_pseudoinverse(rows, e.ranks.geometric) * rows
    by_places = jacobian(e, lambda at: at.at.constraints * at.rate, ("q",))
    of_rates = -(e.inverse * (by_places * places))
    drift_by_places = jacobian(e, _constraint_acceleration, ("q",))
    drift_by_rates = jacobian(e, lambda at: at.motion(at.rate)[1], ("qd",))
    of_accelerations = -(e.inverse * (drift_by_places * places + drift_by_rates * of_rates))
    by_own_rates = -(e.inverse * (drift_by_rates * e.projector))
    first, second, third = range(n), range(n, 2 * n), range(2 * n, 3 * n)
    blocks = (
        (first, first, places),
        (second, first, of_rates),
        (second, second, e.projector),
        (third, first, of_accelerations),
        (third, second, by_own_rates),
        (third, third, e.projector),
    )
    return placed(3 * n, 3 * n, blocks)


def _inverse_dynamics_residual(e: Evaluation) -> Any:
    return e.projector * (e.load - e.at.control * e.inputs)


def _weighted_pseudoinverse(e: Evaluation) -> Any:
    return e.inverse - e.weighted * (e.at.mass * e.inverse)


def _projected_coriolis_matrix(e: Evaluation) -> Any:
    velocity = e.projected_rate
    inner = e.coriolis(velocity) * e.projector + e.at.mass * e.projector_dot(velocity)
    return e.projector * inner


def _minimal_coriolis_matrix(e: Evaluation) -> Any:
    return e.complement.transpose() * (e.rate_coriolis * e.complement + e.at.mass * e.complement_dot)


def _admissible_acceleration(e: Evaluation) -> Any:
    velocity = e.projected_rate
    if e.ranks.constraints == e.system.r:  # B+' v = 0, and N_dot v = -B+ B_dot v by Remark 9
        return e.projector * column(e.qdd) - e.inverse * e.motion(velocity)[1]
    return e.projector * column(e.qdd) + e.projector_dot(velocity) * velocity


def _projected_configuration(e: Evaluation) -> Any:
    q = column(e.q)
    if e.system.r_geometric == 0:
        return q
    for _ in range(2):
        residual, rows = e.system.geometry(q.entries(), e.parameters, e.literals)
        q = q - right_pseudoinverse(rows, e.ranks.geometric) * residual
    return q


def _actuator_bias(e: Evaluation) -> Any:
    velocity = e.quasi_velocity
    nu = e.at.control.transpose() * e.rate
    inner = e.at.mass * (e.quasi_dot(velocity) * nu) + e.coriolis(velocity) * velocity
    return e.quasi.transpose() * (inner + e.at.potential_gradient - e.applied(velocity))


def _accelerations(e: Evaluation) -> Any:
    """q_ddot, with the friction of reactions."""
    return e.accelerations - e.weighted * friction_of(e, True).force if e.system.model.rough else e.accelerations


def _multipliers(e: Evaluation) -> Any:
    if not e.system.model.rough:
        return e.inverse.transpose() * (e.force - e.at.mass * e.accelerations)
    force = friction_of(e, True).force
    return e.inverse.transpose() * (e.force - force - e.at.mass * (e.accelerations - e.weighted * force))


def _multipliers_jacobian(e: Evaluation) -> Any:
    """The derivatives of lambda by (q, qd, u)."""
    return jacobian(e, _multipliers, ("q", "qd", "u"))


def _energy(e: Evaluation) -> Any:
    return column(e.system.energies(e.q, e.qd, e.parameters, e.literals))


def _singularity(e: Evaluation) -> Any:
    return column([constraint_measure(e), actuation_measure(e)])


Definition = Callable[[Evaluation], Any]
QUANTITIES: dict[str, Definition] = {
    "mass_matrix": lambda e: e.at.mass,
    "coriolis_matrix": lambda e: e.rate_coriolis,
    "coriolis_force": lambda e: e.motion(e.rate)[0],
    "potential_force": lambda e: e.at.potential_gradient,
    "applied_force": lambda e: e.applied(e.rate),
    "constraint_residual": lambda e: e.at.residual,
    "constraint_jacobian": lambda e: e.at.constraints,
    "constraint_jacobian_dot": lambda e: e.constraints_dot(e.rate),
    "constraint_pseudoinverse": lambda e: e.inverse,
    "nullspace_projector": lambda e: e.projector,
    "nullspace_projector_dot": lambda e: e.projector_dot(e.rate),
    "weighted_pseudoinverse": _weighted_pseudoinverse,
    "weighted_nullspace_projector": lambda e: e.weighted * e.at.mass,
    "control_matrix": lambda e: e.at.control,
    "projected_control_matrix": lambda e: e.projected_control,
    "projected_control_pseudoinverse": lambda e: e.control_inverse,
    "orthogonal_complement": lambda e: e.complement,
    "projected_mass_matrix": lambda e: e.projector * e.at.mass * e.projector,
    "projected_coriolis_matrix": _projected_coriolis_matrix,
    "projected_potential_force": lambda e: e.projector * e.at.potential_gradient,
    "projected_applied_force": lambda e: e.projector * e.applied(e.projected_rate),
    "minimal_mass_matrix": lambda e: e.complement.transpose() * e.at.mass * e.complement,
    "minimal_coriolis_matrix": _minimal_coriolis_matrix,
    "minimal_potential_force": lambda e: e.complement.transpose() * e.at.potential_gradient,
    "minimal_applied_force": lambda e: e.complement.transpose() * e.applied(e.rate),
    "minimal_control_matrix": lambda e: e.complement.transpose() * e.at.control,
    "admissible_velocity": lambda e: e.projected_rate,
    "admissible_acceleration": _admissible_acceleration,
    "projected_configuration": _projected_configuration,
    **QUANTITIES_OF_GIVEN,
    "inverse_dynamics": _inverse_dynamics,
    "inverse_dynamics_jacobian": _inverse_dynamics_jacobian,
    "inverse_dynamics_gradient": _inverse_dynamics_gradient,
    "inverse_dynamics_hessian_product": _inverse_dynamics_hessian_product,
    "inverse_dynamics_parameter_jacobian": _inverse_dynamics_parameter_jacobian,
    "forward_dynamics_jacobian": _forward_dynamics_jacobian,
    "forward_dynamics_gradient": _forward_dynamics_gradient,
    "multipliers_jacobian": _multipliers_jacobian,
    "regressor": regressor,
    "base_regressor": base_regressor,
    "base_parameters": base_parameters,
    "constraint_variations": _constraint_variations,
    "inverse_dynamics_residual": _inverse_dynamics_residual,
    "friction_residual": _friction_residual,
    "utilisation": _utilisation,
    "actuator_velocity": lambda e: e.at.control.transpose() * e.rate,
    "actuator_mass_matrix": lambda e: e.quasi.transpose() * e.at.mass * e.quasi,
    "actuator_bias": _actuator_bias,
    "forward_dynamics": _accelerations,
    "multipliers": _multipliers,
    "energy": _energy,
    "singularity": _singularity,
    "point_position": lambda e: e.points[0],
    "point_jacobian": lambda e: e.points[1],
}
# Of two thirds of the digits that others have.
DIFFERENCED = frozenset(row.name for row in ROWS.values() if row.is_derivative)
# What takes differences of differences, at a place ahead and one back.
CURVED = frozenset(row.name for row in ROWS.values() if DIRECTION in row.arguments)
# What no finite count of operations gives exactly.
ITERATED = frozenset({"configuration_from_measured", "configuration_from_task"})
# The matrices whose rates these take; the others do with what a velocity adds to forces and accelerations.
RATES = {
    "coriolis_matrix": ("mass",),
    "constraint_jacobian_dot": ("constraints",),
    "nullspace_projector_dot": ("constraints",),
    "projected_coriolis_matrix": ("mass", "constraints"),
    "minimal_coriolis_matrix": ("mass", "constraints"),
    "actuator_bias": ("mass", "constraints", "control"),
    "regressor": ("mass",),
    "base_regressor": ("mass",),
    "base_parameters": ("mass",),
}
