"""The quantities symgen can derive, in the order every table, header and module lists them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal, TypeAlias, cast

from symgen.records import dataclass

# What some models have beside q, qd, qdd and u: measured coordinates with their rates and accelerations, those of the
# task, weights of inputs and of accelerations, of whose sums there are gradients, and a direction of (q, qd, qdd).
FurtherName: TypeAlias = Literal["q_m", "qd_m", "qdd_m", "x_t", "xd_t", "xdd_t", "w_u", "w_qdd", "v_x"]
MEASURED_ARGUMENTS: tuple[FurtherName, ...] = ("q_m", "qd_m", "qdd_m")
WEIGHT_ARGUMENTS: tuple[FurtherName, ...] = ("w_u", "w_qdd")
DIRECTION: FurtherName = "v_x"
Argument: TypeAlias = Literal["q", "qd", "qdd", "u"] | FurtherName
# What a model must have for some quantities.
PARTITION, ACTUATORS, POINTS, LIMITED = "independent_velocities", "m = delta", "points", "limits of all inputs"
FRICTION = "friction of reactions"
# What encoders determine: of rates, and of places.
MEASURED, MEASURED_PLACES = "measured", "measured places"
# A task, one that determines rates, one that determines places, each as the least where it leaves directions open, and
# one that does.
TASK, TASK_RATES, TASK_PLACES, TASK_OPEN = "task", "task rates", "task places", "open task"
# Those that `all` takes where the model says `derivatives` only; the latter two need more than constraints that do not
# depend on each other.
DERIVATIVES, OF_INPUTS, VARIATIONS = "derivatives", "derivatives of inputs", "derivatives along constraints"

# What is made where it is named, and never for `all`.
NAMED = "its name in outputs"


@dataclass(frozen=True, slots=True)
class QuantityRow:
    """A quantity by the name used in `outputs`, C and Python; `equation` is the number in Müller's paper, or empty.

    `result` is what its array is called in C.  `shape` has its extents, sums of products of numbers and of sizes of the
    system: n coordinates, m inputs, r rows, of these r_g geometric, delta degrees of freedom, k coordinates of the
    task, points, parameters, inertial and base parameters.  A quantity exists where none of them is 0 and the model has
    what it `needs`.  The `main` ones are what the equations of motion are solved for.
    """

    name: str
    symbol: str
    equation: str
    result: str
    arguments: tuple[Argument, ...]
    shape: tuple[str, ...]
    description: str
    needs: str
    main: bool

    @property
    def sizes(self) -> frozenset[str]:
        """Of which none may be 0: those of extents that are one product."""
        return frozenset(factor for extent in self.shape if "+" not in extent for factor in extent.split("*"))

    @property
    def is_derivative(self) -> bool:
        """Whether `all` takes it where the model says `derivatives` only."""
        return self.needs in (DERIVATIVES, OF_INPUTS, VARIATIONS)

    @property
    def is_of_measured(self) -> bool:
        """Whether it is found from measured coordinates."""
        return self.needs in (MEASURED, MEASURED_PLACES)

    @property
    def is_of_task(self) -> bool:
        """Whether it is one of a task."""
        return self.needs in (TASK, TASK_RATES, TASK_PLACES, TASK_OPEN)

    @property
    def is_of_base(self) -> bool:
        """Whether it is made of the combinations of inertial parameters that count."""
        return "base_parameters" in self.sizes

    def extents(self, sizes: Mapping[str, int]) -> tuple[int, ...]:
        """Its shape in numbers."""

        def product(term: str) -> int:
            return math.prod(int(factor) if factor.isdigit() else sizes[factor] for factor in term.split("*"))

        return tuple(sum(map(product, extent.split("+"))) for extent in self.shape)


def _row(
    name: str, symbol: str, equation: str, result: str, arguments: str, shape: str, description: str, needs: str = "",
    *, main: bool = False,
) -> QuantityRow:  # fmt: skip
    given = cast(tuple[Argument, ...], tuple(arguments.split()))
    return QuantityRow(name, symbol, equation, result, given, tuple(shape.split()), description, needs, main)


# fmt: off
QUANTITIES: tuple[QuantityRow, ...] = (
    _row("mass_matrix", "G", "(3)", "G", "q", "n n", "generalized mass matrix"),
    _row("coriolis_matrix", "C", "(3)", "C", "q qd", "n n",
         "Coriolis matrix of Christoffel symbols, along qd as given"),
    _row("coriolis_force", "C q̇", "(3)", "C_qd", "q qd", "n", "Coriolis and centrifugal forces"),
    _row("potential_force", "Q", "(3)", "Q", "q", "n", "gradient of the potential energy"),
    _row("applied_force", "Q_a", "", "Q_a", "q qd", "n", "applied generalized forces, on the right-hand side"),
    _row("constraint_residual", "g", "(4)", "g", "q", "r_g", "geometric constraints, zero on the configuration space"),
    _row("constraint_jacobian", "B", "(1)", "B", "q", "r n", "coefficients of the velocity constraints"),
    _row("constraint_jacobian_dot", "Ḃ", "", "B_dot", "q qd", "r n",
         "time derivative of the constraint Jacobian along qd"),
    _row("constraint_pseudoinverse", "B⁺", "", "B_pinv", "q", "n r",
         "Moore-Penrose inverse of the constraint Jacobian"),
    _row("nullspace_projector", "N_B", "(21)", "N_B", "q", "n n",
         "orthogonal projector onto the admissible velocities"),
    _row("nullspace_projector_dot", "Ṅ_B", "Remark 9", "N_B_dot", "q qd", "n n",
         "time derivative of the projector along qd"),
    _row("weighted_pseudoinverse", "B_G⁺", "(17)", "B_G_pinv", "q", "n r",
         "pseudoinverse of B weighted by the mass matrix"),
    _row("weighted_nullspace_projector", "N_{B,G}", "(19)", "N_BG", "q", "n n",
         "projector weighted by the mass matrix"),
    _row("control_matrix", "M", "(3)", "M", "q", "n m", "generalized forces per unit of each input"),
    _row("projected_control_matrix", "M̃", "(21)", "M_tilde", "q", "n m", "control matrix projected with N_B"),
    _row("projected_control_pseudoinverse", "M̃⁺", "(27), (28)", "M_tilde_pinv", "q", "m n", "pseudoinverse of M̃"),
    _row("orthogonal_complement", "F", "(8)", "F_B", "q", "n delta", "velocities per independent velocity", PARTITION),
    _row("projected_mass_matrix", "G̃", "(30)", "G_tilde", "q", "n n", "projected mass matrix"),
    _row("projected_coriolis_matrix", "C̃", "(30)", "C_tilde", "q qd", "n n",
         "projected Coriolis matrix, along N_B qd"),
    _row("projected_potential_force", "Q̃", "(30)", "Q_tilde", "q", "n", "projected potential forces"),
    _row("projected_applied_force", "N_B Q_a", "", "Q_a_tilde", "q qd", "n", "projected applied forces, at N_B qd"),
    _row("minimal_mass_matrix", "Ḡ", "(9)", "G_bar", "q", "delta delta",
         "mass matrix in the independent velocities", PARTITION),
    _row("minimal_coriolis_matrix", "C̄", "(9)", "C_bar", "q qd", "delta delta",
         "Coriolis matrix in the independent velocities", PARTITION),
    _row("minimal_potential_force", "Q̄", "(9)", "Q_bar", "q", "delta",
         "potential forces on the independent velocities", PARTITION),
    _row("minimal_applied_force", "FᵀQ_a", "", "Q_a_bar", "q qd", "delta",
         "applied forces on the independent velocities", PARTITION),
    _row("minimal_control_matrix", "M̄", "(9)", "M_bar", "q", "delta m",
         "control matrix of the independent velocities", PARTITION),
    _row("admissible_velocity", "N_B q̇₀", "Remark 9", "qd_admissible", "q qd", "n",
         "the nearest velocity that satisfies the constraints"),
    _row("admissible_acceleration", "N_B q̈₀ + Ṅ_B q̇", "Remark 9", "qdd_admissible", "q qd qdd", "n",
         "acceleration made admissible"),
    _row("projected_configuration", "q − B⁺g", "", "q_projected", "q", "n",
         "two Newton steps towards the configuration space"),
    _row("configuration_from_measured", "q(q_m)", "", "q_result", "q_m q", "n",
         "the configuration with the measured coordinates, or nearest to them, on the branch of q", MEASURED_PLACES),
    _row("velocity_from_measured", "q̇(q̇_m)", "", "qd_result", "q qd_m", "n",
         "the admissible velocity with the measured rates, or nearest to them", MEASURED),
    _row("acceleration_from_measured", "q̈(q̈_m)", "", "qdd_result", "q qd_m qdd_m", "n",
         "the admissible acceleration with the measured ones, or nearest to them, at the measured velocity", MEASURED),
    _row("task_position", "x", "", "x", "q", "k", "coordinates of the task", TASK),
    _row("task_velocity", "ẋ", "", "xd", "q qd", "k", "their rates", TASK),
    _row("task_jacobian", "J_x", "", "x_q", "q", "k n", "derivatives of the coordinates of the task by q", TASK),
    _row("configuration_from_task", "q(x)", "", "q_result", "x_t q", "n",
         "the configuration with these coordinates of the task, or nearest to them, on the branch of q", TASK_PLACES),
    _row("velocity_from_task", "q̇(ẋ)", "", "qd_result", "q xd_t", "n",
         "the admissible velocity with these rates of the task, or nearest to them", TASK_RATES),
    _row("acceleration_from_task", "q̈(ẍ)", "", "qdd_result", "q xd_t xdd_t", "n",
         "the admissible acceleration with these ones of the task, or nearest to them, at that velocity", TASK_RATES),
    _row("task_nullspace_projector", "N_x", "", "N_x", "q", "n n",
         "orthogonal projector onto the admissible velocities that leave the task still", TASK_OPEN),
    _row("inverse_dynamics", "u", "(27)", "u", "q qd qdd", "m", "the smallest inputs that produce the motion",
         main=True),
    _row("inverse_dynamics_jacobian", "J_u", "", "u_x", "q qd qdd", "m 3*n",
         "derivatives of u by q, qd and qdd, each by itself", OF_INPUTS),
    _row("inverse_dynamics_gradient", "J_uᵀ w", "", "w_u_x", "q qd qdd w_u", "3*n",
         "derivatives of wᵀu by q, qd and qdd, for weights of the inputs", OF_INPUTS),
    _row("inverse_dynamics_hessian_product", "H_{wᵀu} v", "", "w_u_xv", "q qd qdd w_u v_x", "3*n",
         "derivatives of J_uᵀ w by q, qd and qdd along a direction v of these", OF_INPUTS),
    _row("inverse_dynamics_parameter_jacobian", "J_p", "", "u_p", "q qd qdd", "m parameters",
         "derivatives of u by the parameters, in their order", OF_INPUTS),
    _row("regressor", "Y", "", "Y", "q qd qdd", "m inertial_parameters",
         "least inputs for a unit of each inertial parameter, in which u of bodies and rotors is linear", NAMED),
    _row("base_regressor", "Y_β", "", "Y_base", "q qd qdd", "m base_parameters",
         "least inputs for a unit of each base parameter: columns of Y that do not depend on each other", NAMED),
    _row("base_parameters", "β", "", "beta", "q", "base_parameters",
         "combinations of inertial parameters that count, Y π = Y_β β on the constraints; q does not change them",
         NAMED),
    _row("constraint_variations", "X", "", "X", "q qd qdd", "3*n 3*n",
         "projector onto the changes of q, qd and qdd that the constraints allow", VARIATIONS),
    _row("inverse_dynamics_residual", "F Fᵀ(τ − M u)", "", "residual", "q qd qdd", "n",
         "the force no input can supply"),
    _row("friction_residual", "N_B(τ + D(λ) − M u)", "Remark 3", "residual", "q qd qdd u", "n",
         "what given inputs lack, with friction that grows with reactions", FRICTION),
    _row("utilisation", "ρ", "", "share", "q qd qdd", "1",
         "the share of their limits that the inputs need at least, possible up to 1", LIMITED),
    _row("actuator_velocity", "ν", "Remark 10", "nu", "q qd", "m", "velocities along the inputs", ACTUATORS),
    _row("actuator_mass_matrix", "WᵀGW", "Remark 10", "G_nu", "q", "m m",
         "mass matrix in the actuator velocities", ACTUATORS),
    _row("actuator_bias", "Wᵀ(GẆν + Cq̇ + Q − Q_a)", "Remark 10", "bias_nu", "q qd", "m",
         "further forces along the inputs", ACTUATORS),
    _row("forward_dynamics", "q̈", "(15)", "qdd", "q qd u", "n", "accelerations under the inputs",
         main=True),
    _row("forward_dynamics_jacobian", "J_a", "", "qdd_x", "q qd u", "n 2*n+m",
         "derivatives of q̈ by q, qd and u, each by itself", DERIVATIVES),
    _row("forward_dynamics_gradient", "J_aᵀ w", "", "w_qdd_x", "q qd u w_qdd", "2*n+m",
         "derivatives of wᵀq̈ by q, qd and u, for weights of the accelerations", DERIVATIVES),
    _row("multipliers", "λ", "(14)", "lambda_B", "q qd u", "r",
         "Lagrange multipliers; the reaction on the system is −Bᵀλ", main=True),
    _row("multipliers_jacobian", "J_λ", "", "lambda_x", "q qd u", "r 2*n+m",
         "derivatives of λ by q, qd and u, each by itself", DERIVATIVES),
    _row("energy", "T, U", "", "T_U", "q qd", "2", "kinetic and potential energy"),
    _row("singularity", "σ", "", "measure", "q", "2", "distances from constraint and input singularities, 0 to 1"),
    _row("point_position", "(x, y, z)", "", "position", "q", "points 3",
         "places of the points, a row for each in the order of the file", POINTS),
    _row("point_jacobian", "J", "", "J", "q", "3*points n",
         "velocities of the points per rate, three rows for each", POINTS),
)
# fmt: on
ROWS = {quantity.name: quantity for quantity in QUANTITIES}
MAIN = tuple(quantity.name for quantity in QUANTITIES if quantity.main)
"""u, q̈ and λ, which take methods of their own."""
MOTIONS = MAIN[1:]
"""q̈ and λ, which follow from inputs: methods make them together."""
MULTIPLIERS = MOTIONS[1]
GIVEN_PLACES = ("configuration_from_measured", "configuration_from_task")
"""q of what encoders or a plan say of it."""
GIVEN_MOTIONS = (
    "velocity_from_measured", "acceleration_from_measured", "velocity_from_task", "acceleration_from_task",
)  # fmt: skip
"""q̇ and q̈ of what encoders or a plan say of them."""
# Whose columns have names: those of the inertial parameters.
REGRESSOR = "regressor"
# The columns of this one are some of these, and belong to combinations that `explain` tells of by their name.
BASE_REGRESSOR, BASE_PARAMETERS = "base_regressor", "base_parameters"
