"""What every drawn file ends with: outputs, start, ranges, independent velocities."""

from __future__ import annotations

from typing import Any

import numpy as np

from symgen.zoo.describe import Description
from symgen.zoo.dice import Dice, decimal
from symgen.zoo.fields import Floats
from symgen.zoo.mechanics import equations
from symgen.zoo.reader import System

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
OF_POINTS = ("point_position", "point_jacobian")
OF_INDEPENDENT = ("orthogonal_complement", "minimal_mass_matrix", "minimal_coriolis_matrix", "minimal_control_matrix")


def finish(dice: Dice, family: str, blocks: dict[str, Any], start: dict[str, float]) -> Description:
    """The description, with outputs chosen at random and the start given or left out."""
    others = [*OTHERS, *(OF_POINTS if "points" in blocks else ())]
    if dice.chance(0.12):
        blocks["independent_velocities"] = _independent(dice, blocks, start)
        others += OF_INDEPENDENT
    match dice.weighted({"main": 5, "some": 4, "all": 2, "none": 1}):
        case "main":
            blocks["outputs"] = list(MAIN)
        case "some":
            # what the witness compares stays among them
            blocks["outputs"] = [*dice.sample(MAIN, dice.whole(1, 3)), *dice.sample(others, dice.whole(0, 6))]
        case "all":
            blocks["outputs"] = "all"
    if dice.chance(0.7):
        blocks["configuration"] = {name: decimal(value, 6) for name, value in start.items()}
    if dice.chance(0.25):
        names = dice.sample(list(start), dice.whole(1, len(start)))
        ranges = blocks.setdefault("ranges", {})
        for name in names:
            lower, upper = start[name] - dice.uniform(0.3, 1), start[name] + dice.uniform(0.3, 1)
            ranges.setdefault(name, [decimal(lower, 3), decimal(upper, 3)])
    if dice.chance(0.03):
        blocks["trig_range"] = "wide"
    return Description(family, blocks, dict(start))


def _independent(dice: Dice, blocks: dict[str, Any], start: dict[str, float]) -> list[str]:
    """Coordinates whose rates determine all others at the start."""
    system = System(blocks)
    rows = equations(system).rows
    values = {**start, **dict.fromkeys(system.rate_names, 0.0)}
    for name, node in system.parameters.items():
        values[name] = system.tape.evaluate([node], values, Floats())[0]
    names = list(system.coordinates)
    jacobian = np.array([system.tape.evaluate(row, values, Floats()) for row in rows]).reshape(-1, len(names))
    jacobian = jacobian / np.maximum(np.linalg.norm(jacobian, axis=1, keepdims=True), 1e-12)
    dependent: list[str] = []
    for name in dice.shuffled(names):
        chosen = [names.index(each) for each in (*dependent, name)]
        if (
            rows
            and np.linalg.svd(jacobian[:, chosen], compute_uv=False).min(initial=1.0) > 1e-3
            and len(chosen) <= len(rows)
        ):
            dependent.append(name)
    return [name for name in names if name not in dependent]
