"""Which quantities a model has: the one rule, for its checks, the derivation and the reference."""

from __future__ import annotations

from symgen.model.inertial_base import NOT_NAMED
from symgen.model.inertial_parameters import inertial_parameters
from symgen.model.model import Model
from symgen.model.open_task import directions, left_open
from symgen.model.quantities import (
    ACTUATORS,
    BASE_PARAMETERS,
    FRICTION,
    LIMITED,
    MEASURED_PLACES,
    MOTIONS,
    OF_INPUTS,
    PARTITION,
    TASK,
    TASK_OPEN,
    TASK_PLACES,
    VARIATIONS,
    QuantityRow,
)

# What would hold friction of reactions, and is made without it only.
WITHOUT_FRICTION = frozenset({"actuator_bias", "regressor", "base_regressor"})


def lacking(quantity: QuantityRow, model: Model, delta: int | None = None, actuation: int | None = None) -> str | None:
    """Why a model does not have a quantity, or None.

    `delta` and `actuation`, the rank of the projected control matrix, are left out where only the file is known.
    """
    geometric = sum(row.kind == "geometric" for row in model.constraints)
    inertial = len(inertial_parameters(model.mechanism)), "bodies and no rotor inertias"
    counts = {
        "r": (model.r, "constraints"),
        "r_g": (geometric, "geometric constraints"),
        "m": (model.m, "inputs"),
        "k": (len(model.task), "`task`"),
        "points": (len(model.mechanism.points), "points"),
        "parameters": (len(model.parameters), "parameters"),
        "inertial_parameters": inertial,
        "base_parameters": inertial,
        "delta": (delta, "degrees of freedom"),
    }
    for size, (count, what) in counts.items():
        if size in quantity.sizes and count == 0:
            return f"the model has no {what}"
    if quantity.is_of_base and (why := _without_base(quantity, model)):
        return why
    if quantity.is_of_task and not model.task:
        return "the model has no `task`"
    if quantity.is_of_task and quantity.needs != TASK and (why := _beside_task(quantity, model)):
        return why
    if quantity.needs == PARTITION and not model.independent_velocities:
        return "the model names no `independent_velocities`"
    if quantity.is_of_measured and not model.measured:
        return "the model names no `measured` coordinates"
    if quantity.needs == MEASURED_PLACES:
        if geometric == 0:
            return "the model has no geometric constraints: every place has to be measured"
        if not model.measures_places:
            return "rows that hold rates leave places open: all of these would have to be measured"
    if quantity.needs == ACTUATORS and delta is not None and not model.m == delta == actuation:
        return "it needs as many independent inputs as degrees of freedom"
    if quantity.needs == FRICTION and not model.rough:
        return "the model has no friction that grows with reactions"
    if model.rough and (quantity.name in WITHOUT_FRICTION or (quantity.is_derivative and quantity.needs != VARIATIONS)):
        return "it is not made with friction that grows with reactions: leave that out of a model of its own"
    if model.rough and quantity.name in MOTIONS and model.motion_steps is not None and model.motion_steps.locks:
        return (
            f"friction locks where inputs are given: it returns {model.motion_steps.kappa:.2g} of the reactions it "
            "grows with, and half is too much; smaller coefficients or radii let it move"
        )
    if quantity.needs == LIMITED:
        if model.allocation is None or len(model.allocation.limits) < model.m:
            return "it needs `limits` of every input, under `allocation`"
        if delta is not None and actuation is not None and actuation < delta:
            return "the inputs do not reach every direction of motion"
    if quantity.needs == VARIATIONS and not model.constraints:
        return "the model has no constraints"
    if quantity.is_derivative and delta is not None and model.n - delta < model.r:
        return "its constraints depend on each other: beside them it is not differentiable"
    if quantity.needs == OF_INPUTS and delta is not None and actuation not in (None, min(model.m, delta)):
        return "on the constraints its inputs reach less than beside them: u is not differentiable there"
    return None


def _without_base(quantity: QuantityRow, model: Model) -> str | None:
    """Why a quantity is not made of base parameters, or None."""
    base = model.inertial_base
    if base is None:
        return NOT_NAMED
    if not base.columns:
        return base.why or "no motion shows any of its inertial parameters"
    if quantity.name == BASE_PARAMETERS and not base.values:
        return base.why
    return None


def _beside_task(quantity: QuantityRow, model: Model) -> str | None:
    """Why a task does not give what is found from it, or None."""
    leaves, rolling = model.task_leaves, any(row.kind == "nonholonomic" for row in model.constraints)
    if leaves.rates and leaves.idle:
        those = "one of its functions follows" if leaves.idle == 1 else f"{leaves.idle} of its functions follow"
        return f"{left_open(model)}, and {those} from the others: leave out what follows"
    # the least step to a place may be across wheels
    if quantity.needs == TASK_PLACES and leaves.places and rolling:
        left = directions(leaves.places)
        return f"the task leaves {left} open: further entries, such as coordinates, determine the rest"
    if quantity.needs == TASK_OPEN and not leaves.rates:
        return "the task leaves no direction open"
    return None
