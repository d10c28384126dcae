"""What every drawn file ends with: outputs, start, ranges, independent velocities, what is measured, a task."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import decimal
from symgen.laboratory.zoo.draws.describe import MISTAKE, Description, Terms
from symgen.laboratory.zoo.draws.drawn import DrawnEquations, rank_at
from symgen.laboratory.zoo.draws.names import ILLEGAL
from symgen.laboratory.zoo.draws.sketch import Sketch
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded

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
OF_MEASURED = ("configuration_from_measured", "velocity_from_measured", "acceleration_from_measured")
OF_TASK = (
    "task_position", "task_velocity", "task_jacobian", "configuration_from_task", "velocity_from_task",
    "acceleration_from_task", "task_nullspace_projector",
)  # fmt: skip
OF_INDEPENDENT = ("orthogonal_complement", "minimal_mass_matrix", "minimal_coriolis_matrix", "minimal_control_matrix")

# Shares of systems that measure, and that have a task.
MEASURED_SHARE, TASK_SHARE = 0.15, 0.12
# Of systems that name several outputs, those that want some in one call.
TOGETHER_SHARE = 0.15
# Of allocations without limits those that get some, and of how many inputs at most.
LIMITED_SHARE, MOST_LIMITED = 0.6, 4


def finish(sketch: Sketch) -> Description:
    """The description, with outputs chosen at random and the start given or left out."""
    dice, blocks, start = sketch.dice, sketch.blocks, sketch.start
    if "allocation" not in blocks and len(blocks.get("inputs") or ()) > 1 and dice.chance(0.35):
        allocate(sketch)
    others = [*OTHERS, *(OF_POINTS if "points" in blocks else ())]
    if dice.chance(0.12):
        blocks["independent_velocities"] = independent(sketch)
        others += OF_INDEPENDENT
    more: list[str] = []
    if dice.chance(MEASURED_SHARE):
        blocks["measured"] = measured(sketch)
        more = dice.sample(OF_MEASURED, dice.whole(1, len(OF_MEASURED)))
    match dice.weighted({"main": 5, "some": 4, "all": 2, "none": 1}):
        case "main":
            blocks["outputs"] = [*MAIN, *more]
        case "some":
            # what the witness compares is always among them, in another place each time
            first = dice.sample(MAIN, dice.whole(1, 3))
            rest = [name for name in MAIN if name not in first]
            blocks["outputs"] = [*first, *dice.sample(others, dice.whole(0, 6)), *more, *rest]
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
    if set(ILLEGAL) & {*_names(blocks, start), *_links(sketch.files)}:
        sketch.mark("reserved name")
        sketch.mark(MISTAKE)
    elif dice.chance(0.02):
        _mistake(sketch)
    # drawn last, so that systems without one are what they were
    if dice.chance(TASK_SHARE):
        _task(sketch)
    if "limits" not in blocks.get("allocation", {"limits": {}}) and dice.chance(LIMITED_SHARE):
        _limit(sketch)
    if len(named := _outputs_by_name(sketch)) > 1 and dice.chance(TOGETHER_SHARE):
        group = dice.sample(named, dice.whole(2, min(4, len(named))))
        blocks["outputs"] = [*blocks["outputs"], {"together": group}]
    return Description(sketch.family, blocks, dict(start), tuple(sketch.marks), sketch.files)


def _outputs_by_name(sketch: Sketch) -> list[str]:
    """Those of a system without mistakes that names them."""
    outputs = sketch.blocks.get("outputs")
    return list(dict.fromkeys(outputs)) if isinstance(outputs, list) and MISTAKE not in sketch.marks else []


def _names(blocks: Mapping[str, Any], start: Mapping[str, float]) -> Iterator[str]:
    """What becomes a name in expressions or in the code; loops, springs and the like only begin names."""
    yield from start
    for block in ("parameters", "definitions", "inputs", "frames", "points"):
        yield from blocks.get(block) or ()
    for name, entry in (blocks.get("joints") or {}).items():
        yield entry.get("child", name)
    for rows in (blocks.get("constraints") or {}).values():
        yield from rows


def _links(files: Mapping[str, str]) -> Iterator[str]:
    """The links of a robot description, which become frames."""
    for text in files.values():
        yield from re.findall('<link name="([^"]*)"', text)


def _mistake(sketch: Sketch) -> None:
    """Something that must be told: a name that is nowhere, a block or a quantity that is none."""
    dice, blocks = sketch.dice, sketch.blocks
    sketch.mark(MISTAKE)
    match dice.choice(("input", "output", "block", "start", "energy")):
        case "input":
            sketch.block("inputs")["push_nothing"] = {"joint": "nowhere"}
        case "output":
            blocks["outputs"] = ["forward_dynamic"]
        case "block":
            blocks["constraint"] = {"geometric": {"one": "nowhere - 1"}}
        case "start":
            blocks["configuration"] = {**(blocks.get("configuration") or {}), "nowhere": "0.5"}
        case _:
            rate = f"{next(iter(sketch.start))}_dot"
            blocks["kinetic_energy"] = Terms((*getattr(blocks.get("kinetic_energy"), "terms", ()), f"3*{rate}"))


def allocate(sketch: Sketch) -> None:
    """Weights, preloads and limits where inputs are left over for them."""
    dice, blocks = sketch.dice, sketch.blocks
    drawn = DrawnEquations(expanded(blocks, sketch.files), sketch.start)
    names = list(blocks["inputs"])
    if len(names) <= drawn.reach:
        return
    allocation: dict[str, Any] = {}
    if dice.chance(0.6):
        chosen = dice.sample(names, dice.whole(1, 2))
        allocation["weights"] = {name: dice.choice(("3", "0.5", "10")) for name in chosen}
    if drawn.independent and drawn.reach == drawn.freedom == len(names) - 1:
        if dice.chance(0.6):
            allocation["preload"] = dice.choice(("5", "0", "-2"))
        if dice.chance(0.5):
            chosen = dice.sample(names, dice.whole(1, len(names)))
            allocation["limits"] = {name: dice.choice((["0.5", "60"], ["-8", "8"], ["-30", "2"])) for name in chosen}
    elif dice.chance(0.5):
        chosen = dice.sample(names, dice.whole(1, 2))
        allocation["preload"] = {name: dice.choice(("5", "-3")) for name in chosen}
    if allocation:
        blocks["allocation"] = allocation


def _limit(sketch: Sketch) -> None:
    """Limits of no more inputs than directions of internal force, which these keep whatever the motion is."""
    dice, blocks, names = sketch.dice, sketch.blocks, list(sketch.blocks["inputs"])
    drawn = DrawnEquations(expanded(blocks, sketch.files), sketch.start)
    left = len(names) - drawn.reach
    if drawn.reach < drawn.freedom or isinstance(blocks["allocation"].get("preload"), str):
        return
    if left > 1 or (left == 1 and not drawn.independent):
        ends = (["0.5", "60"], ["-8", "8"], ["-30", "2"], ["20", "30"])
        chosen = dice.sample(names, dice.whole(1, min(left, MOST_LIMITED)))
        blocks["allocation"]["limits"] = {name: dice.choice(ends) for name in chosen}


def _task(sketch: Sketch) -> None:
    """About as many functions of the configuration as there are directions: points, coordinates, sums of waves.

    Of fewer the least motion is taken.
    """
    dice, blocks, names = sketch.dice, sketch.blocks, list(sketch.start)
    turns = [entry["coordinate"] for entry in (blocks.get("joints") or {}).values() if entry["type"] == "revolute"]
    turns += [name for name, entry in (blocks.get("coordinates") or {}).items() if (entry or {}).get("unit") == "rad"]
    points = list(blocks.get("points") or ())
    freedom = DrawnEquations(expanded(blocks, sketch.files), sketch.start).freedom

    def function() -> str:
        if points and dice.chance(0.5):
            return f"{dice.choice(points)}.{dice.choice('xyz')}"
        if not turns or dice.chance(0.3):
            return dice.choice(names)
        one, other = dice.choice(turns), dice.choice(turns)
        waves = f"{dice.length()}*cos({one}) + {dice.length()}*sin({one} + {other})"
        return dice.choice((f"{one} - {dice.length()}*{other}", waves))

    count = max(1, freedom + dice.choice((-2, -1, -1, 0, 0, 0, 0, 1)))
    blocks["task"] = {f"{dice.choice(('x', 'aim', 'tip'))}_{k}": function() for k in range(count)}
    if isinstance(outputs := blocks.get("outputs"), list):
        blocks["outputs"] = [*outputs, *dice.sample(OF_TASK, dice.whole(1, len(OF_TASK)))]


def measured(sketch: Sketch) -> list[str]:
    """Coordinates that determine all others, and now and then some that have an encoder as well."""
    dice, names = sketch.dice, independent(sketch)
    others = [name for name in sketch.start if name not in names]
    if others and dice.chance(0.3):
        names += dice.sample(others, dice.whole(1, min(2, len(others))))
    return dice.shuffled(names)


def independent(sketch: Sketch) -> list[str]:
    """Coordinates whose rates determine all others where most rows count: as many as there are degrees of freedom."""
    drawn = DrawnEquations(expanded(sketch.blocks, sketch.files), sketch.start)
    names = list(drawn.start)
    place = max(drawn.places, key=rank_at)
    jacobian = np.array(place.rows, dtype=float).reshape(-1, len(names))
    jacobian = jacobian / np.maximum(np.linalg.norm(jacobian, axis=1, keepdims=True), NOTHING)
    dependent: list[str] = []

    def spread(name: str) -> float:
        chosen = [names.index(each) for each in (*dependent, name)]
        return float(np.linalg.svd(jacobian[:, chosen], compute_uv=False).min())

    for name in sketch.dice.shuffled(names):
        if len(dependent) < drawn.rank and spread(name) > 1e-3:
            dependent.append(name)
    # rows that all but depend on each other leave less of every further coordinate
    while len(dependent) < drawn.rank:
        dependent.append(max((name for name in names if name not in dependent), key=spread))
    return [name for name in names if name not in dependent]
