"""What every drawn file ends with: outputs, start, ranges."""

from __future__ import annotations

from typing import Any

from symgen.zoo.describe import Description
from symgen.zoo.dice import Dice, decimal

MAIN = ("inverse_dynamics", "forward_dynamics", "multipliers")
OTHERS = (
    "mass_matrix", "coriolis_matrix", "coriolis_force", "potential_force", "applied_force", "constraint_residual",
    "constraint_jacobian", "constraint_jacobian_dot", "constraint_pseudoinverse", "nullspace_projector",
    "nullspace_projector_dot", "weighted_pseudoinverse", "weighted_nullspace_projector", "control_matrix",
    "projected_control_matrix", "projected_control_pseudoinverse", "projected_mass_matrix",
    "projected_coriolis_matrix", "projected_potential_force", "projected_applied_force", "admissible_velocity",
    "admissible_acceleration", "projected_configuration", "inverse_dynamics_residual", "actuator_velocity",
    "actuator_mass_matrix", "actuator_bias", "energy", "singularity",
)  # fmt: skip


def finish(dice: Dice, family: str, blocks: dict[str, Any], start: dict[str, float]) -> Description:
    """The description, with outputs chosen at random and the start given or left out."""
    match dice.weighted({"main": 5, "some": 4, "all": 2, "none": 1}):
        case "main":
            blocks["outputs"] = list(MAIN)
        case "some":
            # what the witness compares stays among them
            blocks["outputs"] = [*dice.sample(MAIN, dice.whole(1, 3)), *dice.sample(OTHERS, dice.whole(0, 6))]
        case "all":
            blocks["outputs"] = "all"
    if dice.chance(0.7):
        blocks["configuration"] = {name: decimal(value, 6) for name, value in start.items()}
    if dice.chance(0.25):
        names = dice.sample(list(start), dice.whole(1, len(start)))
        blocks["ranges"] = {
            name: [decimal(start[name] - dice.uniform(0.3, 1), 3), decimal(start[name] + dice.uniform(0.3, 1), 3)]
            for name in names
        }
    return Description(family, blocks, dict(start))
