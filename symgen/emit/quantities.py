"""What readers of generated code see of each quantity: the name of its output argument and one line of meaning."""

from __future__ import annotations

# quantity: (name of the output argument, meaning); theory and equation numbers as in the paper.
_QUANTITIES: dict[str, tuple[str, str]] = {
    "mass_matrix": ("G", "generalized mass matrix G(q), equation (3)"),
    "coriolis_matrix": ("C", "Coriolis matrix C(q, qd) of Christoffel symbols, equation (3)"),
    "coriolis_force": ("C_qd", "Coriolis and centrifugal force C(q, qd) qd"),
    "potential_force": ("Q", "gradient of the potential energy, Q(q), equation (3)"),
    "applied_force": ("Q_a", "applied generalized force Q_a(q, qd), on the right-hand side"),
    "constraint_residual": ("g", "geometric constraints g(q), equation (4); zero on the manifold"),
    "constraint_jacobian": ("B", "constraint Jacobian B(q), equation (1): geometric rows first"),
    "constraint_jacobian_dot": ("B_dot", "time derivative of the constraint Jacobian along qd"),
    "constraint_pseudoinverse": ("B_pinv", "pseudoinverse of the constraint Jacobian"),
    "nullspace_projector": ("N_B", "orthogonal projector N_B onto the null space of B, equation (21)"),
    "nullspace_projector_dot": ("N_B_dot", "time derivative of N_B along qd, Remark 9"),
    "weighted_pseudoinverse": ("B_G_pinv", "pseudoinverse of B in the metric of the mass matrix, equation (17)"),
    "weighted_nullspace_projector": ("N_BG", "null-space projector in the metric of the mass matrix, equation (19)"),
    "control_matrix": ("M", "control matrix M(q), equation (3)"),
    "projected_control_matrix": ("M_tilde", "projected control matrix N_B M, equation (21)"),
    "projected_control_pseudoinverse": ("M_tilde_pinv", "pseudoinverse of N_B M, equations (27), (28)"),
    "orthogonal_complement": ("F_B", "orthogonal complement F of B for the independent velocities, equation (8)"),
    "projected_mass_matrix": ("G_tilde", "projected mass matrix, equation (30)"),
    "projected_coriolis_matrix": ("C_tilde", "projected Coriolis matrix, equation (30); qd is projected first"),
    "projected_potential_force": ("Q_tilde", "projected potential force N_B Q, equation (30)"),
    "projected_applied_force": ("Q_a_tilde", "projected applied force N_B Q_a; qd is projected first"),
    "minimal_mass_matrix": ("G_bar", "mass matrix of the independent velocities, equation (9)"),
    "minimal_coriolis_matrix": ("C_bar", "Coriolis matrix of the independent velocities, equation (9)"),
    "minimal_potential_force": ("Q_bar", "potential force of the independent velocities, equation (9)"),
    "minimal_applied_force": ("Q_a_bar", "applied force of the independent velocities"),
    "minimal_control_matrix": ("M_bar", "control matrix of the independent velocities, equation (9)"),
    "admissible_velocity": ("qd_admissible", "the admissible velocity nearest to qd, N_B qd, Remark 9"),
    "admissible_acceleration": ("qdd_admissible", "admissible acceleration N_B qdd + N_B_dot N_B qd, Remark 9"),
    "projected_configuration": ("q_projected", "q after two Newton steps q - B^+ g towards the manifold"),
    "inverse_dynamics": ("u", "control forces u for the motion q, qd, qdd, equation (27)"),
    "inverse_dynamics_residual": ("residual", "projected generalized force that no input can supply"),
    "actuator_velocity": ("nu", "actuator velocity M^T qd, Remark 10"),
    "actuator_mass_matrix": ("G_nu", "mass matrix in actuator coordinates, Remark 10"),
    "actuator_bias": ("bias_nu", "bias force in actuator coordinates, Remark 10"),
    "forward_dynamics": ("qdd", "acceleration of the constrained system under u"),
    "multipliers": ("lambda_B", "Lagrange multipliers lambda of equation (3): the reaction is -B^T lambda"),
    "energy": ("T_U", "kinetic and potential energy"),
    "singularity": ("measure", "measures in [0, 1] of constraint and input regularity; 0 = singular"),
    "point_position": ("position", "position of the point in world axes"),
    "point_jacobian": ("J", "Jacobian of the position of the point"),
}


def output_argument(quantity: str) -> str:
    """The name of the output argument of a quantity."""
    return _QUANTITIES.get(quantity, ("result", ""))[0]


def meaning(quantity: str) -> str:
    """One line on a quantity."""
    return _QUANTITIES.get(quantity, ("", quantity.replace("_", " ")))[1]
