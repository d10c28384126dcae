"""What acts on a drawn mechanism: springs, friction, force elements, rotors, inputs of every kind."""

from __future__ import annotations

from typing import Any

from symgen.laboratory.zoo.dice import decimal
from symgen.laboratory.zoo.draws.describe import Terms
from symgen.laboratory.zoo.draws.draw_closures import add_point
from symgen.laboratory.zoo.draws.draw_parts import MAIN_AXES, DrawnPart
from symgen.laboratory.zoo.draws.draw_potentials import potentials
from symgen.laboratory.zoo.draws.sketch import Sketch


def elements(sketch: Sketch, parts: list[DrawnPart], plane: str) -> None:
    """Springs, friction, forces, rotors."""
    dice = sketch.dice
    single = [part.coordinates[0] for part in parts if part.kind in ("revolute", "prismatic")]
    for name in single:
        if dice.chance(0.1):
            sketch.block("rotor_inertias")[name] = dice.number(0.01, 0.5, 2)
        if dice.chance(0.1):
            sketch.block("friction")[name] = {"viscous": dice.number(0.05, 2, 2)} | (
                {"coulomb": "0.5", "width": "0.01"} if dice.chance(0.4) else {}
            )
    if single and dice.chance(0.2):
        name = dice.choice(single)
        sketch.block("springs")[sketch.name("spring")] = {"joint": name, "stiffness": "20", "length": "0.1"}
    if dice.chance(0.2):
        part = dice.choice(parts)
        far = [decimal(dice.uniform(2, 4), 2) if axis != plane else "0" for axis in MAIN_AXES]
        hook = add_point(sketch, "hook", "world", far)
        spring = {"between": [part.frame, hook], "stiffness": dice.choice(("200", "1e4")), "length": "0.5"}
        if dice.chance(0.5):
            spring["damping"] = "3"
        sketch.block("springs")[sketch.name("rope")] = spring
    if dice.chance(0.12):
        frame = dice.choice(parts).frame
        wind = {
            "point": frame,
            "direction": ["1", "0", "0"],
            "magnitude": f"-0.3*{frame}.vx*sqrt({frame}.vx**2 + 1e-4)",
        }
        sketch.block("forces")[sketch.name("wind")] = wind

    if dice.chance(0.25):
        _energies(sketch, parts, plane)


def _energies(sketch: Sketch, parts: list[DrawnPart], plane: str) -> None:
    """Energies that are written out, added to those of the bodies."""
    dice = sketch.dice
    angles = [part.coordinates[0] for part in parts if part.kind == "revolute"]
    ways = [part.coordinates[0] for part in parts if part.kind == "prismatic"]
    if not angles and not ways:
        return
    part = dice.choice(parts)
    owner = add_point(sketch, "place", part.frame, list(part.tip)) if dice.chance(0.5) else part.frame
    axes = [axis for axis in MAIN_AXES if axis != plane]
    terms = potentials(sketch, angles, ways, (f"{owner}.{axes[0]}", f"{owner}.{axes[-1]}"))
    if terms:
        sketch.blocks["potential_energy"] = Terms(tuple(terms))
    if dice.chance(0.4):
        rate = f"{dice.choice([*angles, *ways])}_dot"
        sketch.blocks["kinetic_energy"] = Terms((f"{dice.number(0.01, 0.5, 2)}/2*{rate}**2",))


def inputs(sketch: Sketch, parts: list[DrawnPart], freedom: int) -> None:
    """Too few, enough or too many, of every kind."""
    dice = sketch.dice
    count = max(0, freedom + dice.weighted({-2: 1, -1: 2, 0: 6, 1: 2, 2: 1}))
    single = dice.shuffled([part.coordinates[0] for part in parts if part.kind in ("revolute", "prismatic")])
    for k in range(1, count + 1):
        if single and dice.chance(0.8):
            entry: dict[str, Any] = {"joint": single.pop()}
        else:
            entry = _force(sketch, parts, k)
        sketch.block("inputs")[sketch.name(f"u_{k}")] = entry


def _force(sketch: Sketch, parts: list[DrawnPart], k: int) -> dict[str, Any]:
    dice = sketch.dice
    part = dice.choice(parts)
    direction = ["0", "0", "0"]
    direction[dice.whole(0, 2)] = "1"
    match dice.choice(("point", "torque", "cable", "coordinate")):
        case "point":
            point = add_point(sketch, f"push_{k}", part.frame, list(part.tip))
            entry: dict[str, Any] = {"point": point, "direction": direction}
            if dice.chance(0.3):
                entry["axes"] = part.frame
            return entry
        case "torque":
            entry = {"torque_on": part.frame, "direction": direction}
            if dice.chance(0.4) and part.parent >= 0:
                entry |= {"reaction": parts[part.parent].frame, "axes": part.frame}
            return entry
        case "cable":
            tip = add_point(sketch, f"end_{k}", part.frame, list(part.tip))
            far = [decimal(dice.uniform(2, 3) * dice.choice((-1, 1)), 2) for _ in MAIN_AXES]
            pulley = add_point(sketch, f"pulley_{k}", "world", far)
            return {"cable": [tip, pulley]}
    return {"acts_on": {dice.choice(part.coordinates): "1"}}
