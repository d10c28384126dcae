"""The quantities symgen can derive, in the order every table, header and module lists them."""

from __future__ import annotations

from typing import Literal, TypeAlias

from symgen.records import dataclass

Argument: TypeAlias = Literal["q", "qd", "qdd", "u"]


@dataclass(frozen=True, slots=True)
class QuantityRow:
    """A quantity by the name used in `outputs`, C and Python; `equation` is the number in Müller's paper, or empty."""

    name: str
    symbol: str
    equation: str
    description: str
    arguments: tuple[Argument, ...]


_Q: tuple[Argument, ...] = ("q",)
_QV: tuple[Argument, ...] = ("q", "qd")
_QVA: tuple[Argument, ...] = ("q", "qd", "qdd")
_QVU: tuple[Argument, ...] = ("q", "qd", "u")

QUANTITIES: tuple[QuantityRow, ...] = (
    QuantityRow("mass_matrix", "G", "(3)", "generalized mass matrix", _Q),
    QuantityRow("coriolis_matrix", "C", "(3)", "Coriolis matrix of Christoffel symbols, along qd as given", _QV),
    QuantityRow("coriolis_force", "C q̇", "(3)", "Coriolis and centrifugal forces", _QV),
    QuantityRow("potential_force", "Q", "(3)", "gradient of the potential energy", _Q),
    QuantityRow("applied_force", "Q_a", "", "applied generalized forces, on the right-hand side", _QV),
    QuantityRow("constraint_residual", "g", "(4)", "geometric constraints, zero on the configuration space", _Q),
    QuantityRow("constraint_jacobian", "B", "(1)", "coefficients of the velocity constraints", _Q),
    QuantityRow("constraint_jacobian_dot", "Ḃ", "", "time derivative of the constraint Jacobian along qd", _QV),
    QuantityRow("constraint_pseudoinverse", "B⁺", "", "Moore-Penrose inverse of the constraint Jacobian", _Q),
    QuantityRow("nullspace_projector", "N_B", "(21)", "orthogonal projector onto the admissible velocities", _Q),
    QuantityRow("nullspace_projector_dot", "Ṅ_B", "Remark 9", "time derivative of the projector along qd", _QV),
    QuantityRow("weighted_pseudoinverse", "B_G⁺", "(17)", "pseudoinverse of B weighted by the mass matrix", _Q),
    QuantityRow("weighted_nullspace_projector", "N_{B,G}", "(19)", "projector weighted by the mass matrix", _Q),
    QuantityRow("control_matrix", "M", "(3)", "generalized forces per unit of each input", _Q),
    QuantityRow("projected_control_matrix", "M̃", "(21)", "control matrix projected with N_B", _Q),
    QuantityRow("projected_control_pseudoinverse", "M̃⁺", "(27), (28)", "pseudoinverse of M̃", _Q),
    QuantityRow("orthogonal_complement", "F", "(8)", "velocities per independent velocity", _Q),
    QuantityRow("projected_mass_matrix", "G̃", "(30)", "projected mass matrix", _Q),
    QuantityRow("projected_coriolis_matrix", "C̃", "(30)", "projected Coriolis matrix, along N_B qd", _QV),
    QuantityRow("projected_potential_force", "Q̃", "(30)", "projected potential forces", _Q),
    QuantityRow("projected_applied_force", "N_B Q_a", "", "projected applied forces, at N_B qd", _QV),
    QuantityRow("minimal_mass_matrix", "Ḡ", "(9)", "mass matrix in the independent velocities", _Q),
    QuantityRow("minimal_coriolis_matrix", "C̄", "(9)", "Coriolis matrix in the independent velocities", _QV),
    QuantityRow("minimal_potential_force", "Q̄", "(9)", "potential forces on the independent velocities", _Q),
    QuantityRow("minimal_applied_force", "FᵀQ_a", "", "applied forces on the independent velocities", _QV),
    QuantityRow("minimal_control_matrix", "M̄", "(9)", "control matrix of the independent velocities", _Q),
    QuantityRow(
        "admissible_velocity", "N_B q̇₀", "Remark 9", "the nearest velocity that satisfies the constraints", _QV
    ),
    QuantityRow("admissible_acceleration", "N_B q̈₀ + Ṅ_B q̇", "Remark 9", "acceleration made admissible", _QVA),
    QuantityRow("projected_configuration", "q − B⁺g", "", "two Newton steps towards the configuration space", _Q),
    QuantityRow("inverse_dynamics", "u", "(27)", "the smallest inputs that produce the motion", _QVA),
    QuantityRow("inverse_dynamics_residual", "F Fᵀ(τ − M u)", "", "the force no input can supply", _QVA),
    QuantityRow("actuator_velocity", "ν", "Remark 10", "velocities along the inputs", _QV),
    QuantityRow("actuator_mass_matrix", "WᵀGW", "Remark 10", "mass matrix in the actuator velocities", _Q),
    QuantityRow("actuator_bias", "Wᵀ(GẆν + Cq̇ + Q − Q_a)", "Remark 10", "further forces along the inputs", _QV),
    QuantityRow("forward_dynamics", "q̈", "(15)", "accelerations under the inputs", _QVU),
    QuantityRow("multipliers", "λ", "(14)", "Lagrange multipliers; the reaction on the system is −Bᵀλ", _QVU),
    QuantityRow("energy", "T, U", "", "kinetic and potential energy", _QV),
    QuantityRow("singularity", "σ", "", "distances from constraint and input singularities, 0 to 1", _Q),
    QuantityRow("point_position", "(x, y, z)", "", "places of the points, a row for each in the order of the file", _Q),
    QuantityRow("point_jacobian", "J", "", "velocities of the points per rate, three rows for each", _Q),
)
