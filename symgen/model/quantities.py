"""The quantities symgen can derive, in the order every table, header and module lists them."""

from __future__ import annotations

from typing import Literal, TypeAlias

from symgen.records import dataclass

Argument: TypeAlias = Literal["q", "qd", "qdd", "u"]


@dataclass(frozen=True, slots=True)
class Quantity:
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

QUANTITIES: tuple[Quantity, ...] = (
    Quantity("mass_matrix", "G", "(3)", "generalized mass matrix", _Q),
    Quantity("coriolis_matrix", "C", "(3)", "Coriolis matrix of Christoffel symbols, along qd as given", _QV),
    Quantity("coriolis_force", "C q̇", "(3)", "Coriolis and centrifugal forces", _QV),
    Quantity("potential_force", "Q", "(3)", "gradient of the potential energy", _Q),
    Quantity("applied_force", "Q_a", "", "applied generalized forces, on the right-hand side", _QV),
    Quantity("constraint_residual", "g", "(4)", "geometric constraints, zero on the configuration space", _Q),
    Quantity("constraint_jacobian", "B", "(1)", "coefficients of the velocity constraints", _Q),
    Quantity("constraint_jacobian_dot", "Ḃ", "", "time derivative of the constraint Jacobian along qd", _QV),
    Quantity("constraint_pseudoinverse", "B⁺", "", "Moore-Penrose inverse of the constraint Jacobian", _Q),
    Quantity("nullspace_projector", "N_B", "(21)", "orthogonal projector onto the admissible velocities", _Q),
    Quantity("nullspace_projector_dot", "Ṅ_B", "Remark 9", "time derivative of the projector along qd", _QV),
    Quantity("weighted_pseudoinverse", "B_G⁺", "(17)", "pseudoinverse of B weighted by the mass matrix", _Q),
    Quantity("weighted_nullspace_projector", "N_{B,G}", "(19)", "projector weighted by the mass matrix", _Q),
    Quantity("control_matrix", "M", "(3)", "generalized forces per unit of each input", _Q),
    Quantity("projected_control_matrix", "M̃", "(21)", "control matrix projected with N_B", _Q),
    Quantity("projected_control_pseudoinverse", "M̃⁺", "(27), (28)", "pseudoinverse of M̃", _Q),
    Quantity("orthogonal_complement", "F", "(8)", "velocities per independent velocity", _Q),
    Quantity("projected_mass_matrix", "G̃", "(30)", "projected mass matrix", _Q),
    Quantity("projected_coriolis_matrix", "C̃", "(30)", "projected Coriolis matrix, along N_B qd", _QV),
    Quantity("projected_potential_force", "Q̃", "(30)", "projected potential forces", _Q),
    Quantity("projected_applied_force", "N_B Q_a", "", "projected applied forces, at N_B qd", _QV),
    Quantity("minimal_mass_matrix", "Ḡ", "(9)", "mass matrix in the independent velocities", _Q),
    Quantity("minimal_coriolis_matrix", "C̄", "(9)", "Coriolis matrix in the independent velocities", _QV),
    Quantity("minimal_potential_force", "Q̄", "(9)", "potential forces on the independent velocities", _Q),
    Quantity("minimal_applied_force", "FᵀQ_a", "", "applied forces on the independent velocities", _QV),
    Quantity("minimal_control_matrix", "M̄", "(9)", "control matrix of the independent velocities", _Q),
    Quantity("admissible_velocity", "N_B q̇₀", "Remark 9", "the nearest velocity that satisfies the constraints", _QV),
    Quantity("admissible_acceleration", "N_B q̈₀ + Ṅ_B q̇", "Remark 9", "acceleration made admissible", _QVA),
    Quantity("projected_configuration", "q − B⁺g", "", "two Newton steps towards the configuration space", _Q),
    Quantity("inverse_dynamics", "u", "(27)", "the smallest inputs that produce the motion", _QVA),
    Quantity("inverse_dynamics_residual", "F Fᵀ(τ − M u)", "", "the force no input can supply", _QVA),
    Quantity("actuator_velocity", "ν", "Remark 10", "velocities along the inputs", _QV),
    Quantity("actuator_mass_matrix", "WᵀGW", "Remark 10", "mass matrix in the actuator velocities", _Q),
    Quantity("actuator_bias", "Wᵀ(GẆν + Cq̇ + Q − Q_a)", "Remark 10", "further forces along the inputs", _QV),
    Quantity("forward_dynamics", "q̈", "(15)", "accelerations under the inputs", _QVU),
    Quantity("multipliers", "λ", "(14)", "Lagrange multipliers; the reaction on the system is −Bᵀλ", _QVU),
    Quantity("energy", "T, U", "", "kinetic and potential energy", _QV),
    Quantity("singularity", "σ", "", "distances from constraint and input singularities, 0 to 1", _Q),
    Quantity("point_position", "(x, y, z)", "", "places of the points, a row for each in the order of the file", _Q),
    Quantity("point_jacobian", "J", "", "velocities of the points per rate, three rows for each", _Q),
)
