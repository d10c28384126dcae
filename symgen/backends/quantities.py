"""What readers of generated code see of each quantity: the name of its output argument and one line of meaning."""

from __future__ import annotations

from symgen.ir.kernel import Kernel
from symgen.ir.wide_functions import works_with_pairs
from symgen.model.quantities import QUANTITIES

# Those with a kernel for many states: what trajectories, sampling and simulations evaluate by the million.
BATCHED = ("inverse_dynamics", "forward_dynamics", "multipliers")
_OUTPUT_ARGUMENTS: dict[str, str] = {
    "mass_matrix": "G",
    "coriolis_matrix": "C",
    "coriolis_force": "C_qd",
    "potential_force": "Q",
    "applied_force": "Q_a",
    "constraint_residual": "g",
    "constraint_jacobian": "B",
    "constraint_jacobian_dot": "B_dot",
    "constraint_pseudoinverse": "B_pinv",
    "nullspace_projector": "N_B",
    "nullspace_projector_dot": "N_B_dot",
    "weighted_pseudoinverse": "B_G_pinv",
    "weighted_nullspace_projector": "N_BG",
    "control_matrix": "M",
    "projected_control_matrix": "M_tilde",
    "projected_control_pseudoinverse": "M_tilde_pinv",
    "orthogonal_complement": "F_B",
    "projected_mass_matrix": "G_tilde",
    "projected_coriolis_matrix": "C_tilde",
    "projected_potential_force": "Q_tilde",
    "projected_applied_force": "Q_a_tilde",
    "minimal_mass_matrix": "G_bar",
    "minimal_coriolis_matrix": "C_bar",
    "minimal_potential_force": "Q_bar",
    "minimal_applied_force": "Q_a_bar",
    "minimal_control_matrix": "M_bar",
    "admissible_velocity": "qd_admissible",
    "admissible_acceleration": "qdd_admissible",
    "projected_configuration": "q_projected",
    "inverse_dynamics": "u",
    "inverse_dynamics_residual": "residual",
    "actuator_velocity": "nu",
    "actuator_mass_matrix": "G_nu",
    "actuator_bias": "bias_nu",
    "forward_dynamics": "qdd",
    "multipliers": "lambda_B",
    "energy": "T_U",
    "singularity": "measure",
    "point_position": "position",
    "point_jacobian": "J",
}
_BY_NAME = {quantity.name: quantity for quantity in QUANTITIES}


def output_argument(quantity: str) -> str:
    """The name of the output argument of a quantity."""
    return _OUTPUT_ARGUMENTS.get(quantity, "result")


def meaning(kernel: Kernel) -> str:
    """One line on a quantity: symbol, description, equation of the paper, what is to be known of this system."""
    known = _BY_NAME.get(kernel.name)
    if known is None:
        return kernel.name.replace("_", " ")
    line = f"{known.symbol}: {known.description}" + (f", {known.equation}" if known.equation else "")
    digits = "; works with twice the digits" if works_with_pairs(kernel) else ""
    return line + digits + (f"; {kernel.remark}" if kernel.remark else "")
