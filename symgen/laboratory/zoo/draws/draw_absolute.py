"""Energies in coordinates that need rows: bodies in the plane, points, gyroscopes and quaternions in space."""

from __future__ import annotations

import math

from symgen.laboratory.zoo.dice import Dice, decimal
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.draws.endings import finish
from symgen.laboratory.zoo.draws.sketch import Sketch


def absolute_coordinates(dice: Dice) -> Description:
    """Rods in the plane, each with the place of its centre and its angle; joints are rows."""
    sketch = Sketch(dice, "absolute_coordinates")
    sketch.mark("absolute coordinates")
    kinetic, potential = [], []
    end = ("0", "0")
    drives: list[dict[str, str]] = []
    count = dice.whole(1, 4)
    for k in range(1, count + 1):
        angle = dice.angle()
        half = sketch.parameter(f"h_{k}", dice.length())
        x, y = (sketch.name(f"{letter}_{k}") for letter in "xy")
        a = sketch.name(f"a_{k}")
        for name, unit in ((x, "m"), (y, "m"), (a, "rad")):
            sketch.block("coordinates")[name] = {"unit": unit}
        sketch.start[a] = angle
        sketch.start[x] = sketch.measured(f"{end[0]} + {half}*cos({a})")
        sketch.start[y] = sketch.measured(f"{end[1]} + {half}*sin({a})")
        rows = sketch.block("constraints").setdefault("geometric", {})
        place = ("" if part == "0" else f" - ({part})" for part in end)
        rows[sketch.name(f"px_{k}")] = f"{x} - {half}*cos({a}){next(place)}"
        rows[sketch.name(f"py_{k}")] = f"{y} - {half}*sin({a}){next(place)}"
        mass, inertia = sketch.parameter(f"m_{k}", dice.mass()), sketch.parameter(f"J_{k}", dice.number(0.01, 0.5, 2))
        kinetic += [f"{mass}/2*({x}_dot**2 + {y}_dot**2)"]
        kinetic += [f"{inertia}/2*{a}_dot**2"] if not dice.chance(0.1) else []
        potential.append(f"{mass}*9.81*{y}")
        drives.append({a: "1"} if not drives else {a: "1", next(iter(drives[-1])): "-1"})
        end = (f"{x} + {half}*cos({a})", f"{y} + {half}*sin({a})")
    if count > 2 and dice.chance(0.6):
        sketch.row("close_x", end[0])
        sketch.row("close_y", end[1])
    elif count > 1 and dice.chance(0.4):
        sketch.row("rail", end[1])
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    sketch.blocks["potential_energy"] = Terms(tuple(potential))
    for k, column in enumerate(dice.sample(drives, dice.whole(1, count)), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}
    return finish(sketch)


def points_and_rods(dice: Dice) -> Description:
    """Points in the plane or in space, joined by rods and held by springs, pushed by forces."""
    sketch = Sketch(dice, "points_and_rods")
    letters = dice.choice(("xy", "xyz"))
    count = dice.whole(1, 12 // len(letters) - 1)
    points = []
    for k in range(1, count + 1):
        names = [sketch.coordinate(f"{letter}_{k}", round(dice.uniform(-1.5, 1.5), 2), "m") for letter in letters]
        points.append(names)
    anchors = [[decimal(dice.uniform(-2, 2), 2) for _ in letters] for _ in range(2)]
    kinetic = []
    for k, names in enumerate(points, 1):
        speed = " + ".join(f"{name}_dot**2" for name in names)
        kinetic.append(f"{sketch.parameter(f'm_{k}', dice.mass(dice.chance(0.05)))}/2*({speed})")
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    for index in range(dice.whole(0, len(letters) * count - 1 if count < 3 else count)):
        one = dice.choice(points)
        other = dice.choice([each for each in (*points, *anchors) if each is not one])
        square = " + ".join(f"({a} - {_bracketed(b)})**2" for a, b in zip(one, other, strict=True))
        match dice.weighted({"square": 4, "root": 1, "sphere": 1}):
            case "root":
                sketch.row(f"rod_{index}", f"sqrt({square})")
            case "square":
                sketch.row(f"rod_{index}", square)
            case _:
                sketch.row(f"surface_{index}", " + ".join(f"{name}**2" for name in one))
    potential = [f"9.81*{names[-1]}" for names in points]
    if dice.chance(0.4):
        one = points[0]
        length = " + ".join(f"({a} - 3)**2" for a in one)
        potential.append(f"{sketch.parameter('k', dice.choice(('40', '1e4', '0')))}/2*(sqrt({length}) - 0.4)**2")
    sketch.blocks["potential_energy"] = Terms(tuple(potential))
    for k in range(1, dice.whole(0, 3) + 1):
        names = dice.choice(points)
        if dice.chance(0.5):
            column = {dice.choice(names): "1"}
        else:
            # a force towards a point far away
            length = "sqrt(" + " + ".join(f"({name} - 5)**2" for name in names) + ")"
            column = {name: f"(5 - {name})/{length}" for name in names}
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}
    return finish(sketch)


def _bracketed(text: str) -> str:
    return f"({text})" if text.startswith("-") else text


def gyroscope(dice: Dice) -> Description:
    """A rigid body in space about a fixed point, by Euler angles or by a quaternion, in its kinetic energy."""
    sketch = Sketch(dice, "gyroscope")
    moments = [sketch.parameter(f"J_{axis}", dice.number(0.1, 0.19, 2)) for axis in "xyz"]
    if dice.chance(0.5):
        psi, theta, phi = (
            sketch.coordinate(name, round(dice.uniform(0.3, 1.2), 2)) for name in ("psi", "theta", "phi")
        )
        spins = [
            f"{psi}_dot*sin({theta})*sin({phi}) + {theta}_dot*cos({phi})",
            f"{psi}_dot*sin({theta})*cos({phi}) - {theta}_dot*sin({phi})",
            f"{psi}_dot*cos({theta}) + {phi}_dot",
        ]
        height = f"cos({theta})"
        names = [psi, theta, phi]
        columns = [{psi: "1"}, {phi: "1"}, {theta: "1"}, {psi: f"cos({theta})", phi: "1"}]
        tilt = round(dice.uniform(0.4, 1.2), 2)
        sketch.block("ranges")[theta] = [decimal(tilt - 0.3, 3), decimal(tilt + 0.3, 3)]
        sketch.start[theta] = tilt
    else:
        half = dice.uniform(0.2, 1.2)
        axis = dice.choice(((1.0, 0.0, 0.0), (0.6, 0.8, 0.0), (0.0, 0.6, 0.8)))
        sketch.mark("quaternion")
        values = (math.cos(half), *(math.sin(half) * part for part in axis))
        names = w, x, y, z = [sketch.coordinate(f"e_{k}", value, "rad") for k, value in enumerate(values)]
        for name in names:
            sketch.block("coordinates")[name] = {}
        spins = [
            f"2*({w}*{x}_dot - {x}*{w}_dot - {y}*{z}_dot + {z}*{y}_dot)",
            f"2*({w}*{y}_dot + {x}*{z}_dot - {y}*{w}_dot - {z}*{x}_dot)",
            f"2*({w}*{z}_dot - {x}*{y}_dot + {y}*{x}_dot - {z}*{w}_dot)",
        ]
        height = f"({w}**2 - {x}**2 - {y}**2 + {z}**2)"
        sketch.block("constraints")["geometric"] = {
            sketch.name("unit_norm"): " + ".join(f"{n}**2" for n in names) + " - 1"
        }
        columns = [
            {w: f"-2*{x}", x: f"2*{w}", y: f"2*{z}", z: f"-2*{y}"},
            {w: f"-2*{y}", x: f"-2*{z}", y: f"2*{w}", z: f"2*{x}"},
        ]
        columns += [{w: f"-2*{z}", x: f"2*{y}", y: f"-2*{x}", z: f"2*{w}"}]
    named = [
        sketch.definition(f"w_{axis}", spin, always=dice.chance(0.6)) for axis, spin in zip("xyz", spins, strict=True)
    ]
    sketch.blocks["kinetic_energy"] = Terms(tuple(f"{J}/2*({w})**2" for J, w in zip(moments, named, strict=True)))
    sketch.blocks["potential_energy"] = Terms((f"{sketch.parameter('mgl', '4')}*{height}",))
    for k, column in enumerate(dice.sample(columns, dice.whole(1, 3)), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}
    return finish(sketch)
