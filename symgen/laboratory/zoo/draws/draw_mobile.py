"""Machines that roll, slide on edges, hang on cables or are geared: rows of rates, many inputs, allocations."""

from __future__ import annotations

import math
from typing import Any

from symgen.laboratory.zoo.dice import Dice, decimal
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.draws.endings import allocate, finish
from symgen.laboratory.zoo.draws.sketch import Sketch


def car_with_trailers(dice: Dice) -> Description:
    """A car, steered or not, with trailers: a row of rates for every axle, sometimes one that says nothing new."""
    sketch = Sketch(dice, "car_with_trailers")
    x, y = sketch.coordinate("x", 0.0, "m"), sketch.coordinate("y", 0.0, "m")
    heading = sketch.coordinate("theta", dice.angle())
    m, J = sketch.parameter("m", dice.mass()), sketch.parameter("J", dice.number(0.05, 2, 2))
    kinetic = [f"{m}/2*({x}_dot**2 + {y}_dot**2)", f"{J}/2*{heading}_dot**2"]
    rows = sketch.block("constraints").setdefault("nonholonomic", {})
    rows[sketch.name("axle")] = f"sin({heading})*{x}_dot - cos({heading})*{y}_dot"
    inputs: list[dict[str, str]] = [{x: f"cos({heading})", y: f"sin({heading})"}]
    if dice.chance(0.5):
        steer = sketch.coordinate("phi", round(dice.uniform(-0.6, 0.6), 2))
        length = sketch.parameter("L", dice.length())
        angle = f"{heading} + {steer}"
        rows[sketch.name("front")] = (
            f"sin({angle})*{x}_dot - cos({angle})*{y}_dot - {length}*cos({steer})*{heading}_dot"
        )
        if dice.chance(0.8):
            kinetic.append(f"{dice.number(0.01, 0.3, 2)}/2*{steer}_dot**2")
        inputs.append({steer: "1"})
    else:
        inputs.append({heading: "1"})
    hitch = (f"{x}_dot", f"{y}_dot")
    places: list[tuple[str, str]] = []
    for k in range(1, dice.whole(0, 3) + 1):
        angle = sketch.coordinate(f"trailer_{k}", round(sketch.start[heading] + dice.uniform(-0.6, 0.6), 2))
        d = sketch.parameter(f"d_{k}", dice.length())
        places.append((angle, d))
        vx, vy = hitch
        # the axle of the trailer is behind the one before
        vx, vy = f"{vx} + {d}*sin({angle})*{angle}_dot", f"{vy} - {d}*cos({angle})*{angle}_dot"
        rows[sketch.name(f"axle_{k}")] = f"sin({angle})*({vx}) - cos({angle})*({vy})"
        mass = sketch.parameter(f"m_{k}", dice.mass())
        kinetic.append(f"{mass}/2*(({vx})**2 + ({vy})**2)")
        if dice.chance(0.6):
            kinetic.append(f"{dice.number(0.01, 0.5, 2)}/2*{angle}_dot**2")
        if dice.chance(0.3):
            inputs.append({angle: "1", heading: "-1"})
        hitch = (vx, vy)
    if dice.chance(0.15):
        name = dice.choice(list(rows))
        rows[sketch.name("again")] = f"{dice.choice(('2', '1e-6', '-1'))}*({rows[name]})"
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    for k, column in enumerate(dice.sample(inputs, dice.whole(1, len(inputs))), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}
    return finish(sketch)


def wheeled_bodies(dice: Dice) -> Description:
    """A platform that moves in the plane on wheels: two or three of them drive, casters may steer."""
    sketch = Sketch(dice, "wheeled_bodies")
    x, y, theta = (sketch.name(name) for name in ("x", "y", "theta"))
    sketch.start |= {x: 0.0, y: 0.0, theta: dice.angle()}
    radius = dice.number(0.05, 0.4, 2)
    r = sketch.parameter("R", radius)
    # wheels start to roll where the platform is as high as their axles
    platform = sketch.name("platform")
    sketch.block("joints")[platform] = {"type": "planar", "at": ["0", "0", r], "coordinates": [x, y, theta]}
    body: dict[str, Any] = {"mass": sketch.parameter("m", dice.mass()), "inertia": {"zz": "0.3"}}
    if dice.chance(0.5):
        body["com"] = ["0.1", "0", "0.05"]
    sketch.block("bodies")[platform] = body
    if dice.chance(0.7):
        sketch.blocks["gravity"] = ["0", "0", "-9.81"]
    w = sketch.parameter("w", dice.length())
    wheels = [("left", ["0", w, "0"], False), ("right", ["0", f"-{w}", "0"], False)]
    if dice.chance(0.5):
        wheels.append(("front", [dice.number(0.3, 1, 2), "0", "0"], True))
    for k, (plain, at, steered) in enumerate(wheels):
        parent = platform
        if steered:
            fork, angle = sketch.name("fork"), sketch.name("steer")
            sketch.start[angle] = 0.3
            sketch.block("joints")[fork] = {
                "type": "revolute",
                "axis": "z",
                "parent": platform,
                "at": at,
                "coordinate": angle,
            }
            parent, at = fork, ["0", "0", "0"]
            sketch.block("inputs")[sketch.name("turn")] = {"joint": angle}
        wheel, spin = sketch.name(plain), sketch.name(f"spin_{k}")
        sketch.start[spin] = 0.0
        sketch.block("joints")[wheel] = {
            "type": "revolute",
            "axis": "y",
            "parent": parent,
            "at": at,
            "coordinate": spin,
        }
        inertia = {"xx": "0.01", "yy": "0.02", "zz": "0.01"}
        sketch.block("bodies")[wheel] = {"mass": dice.number(0.2, 2, 2), "inertia": inertia}
        sketch.block("rolling")[sketch.name(f"ground_{k}")] = {"frame": wheel, "radius": r}
        if dice.chance(0.8):
            sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": spin}
    return finish(sketch)


def disc(dice: Dice) -> Description:
    """A disc that leans and rolls, and carries a pendulum or nothing."""
    sketch = Sketch(dice, "disc")
    names = {plain: sketch.coordinate(plain, value, "m") for plain, value in (("x", 0.0), ("y", 0.0))}
    lean = round(dice.uniform(-0.6, 0.6), 2)
    radius = dice.number(0.2, 0.6, 2)
    z = sketch.coordinate("z", float(radius) * math.cos(lean), "m")
    heading, tilt, spin = (
        sketch.coordinate(plain, value) for plain, value in (("heading", dice.angle()), ("lean", lean), ("spin", 0.0))
    )
    r, m = sketch.parameter("R", radius), sketch.parameter("m", dice.mass())
    fork, wheel = sketch.name("fork"), sketch.name("disc")
    sketch.blocks["frames"] = {
        fork: {"translation": [names["x"], names["y"], z], "rotation": [["z", heading], ["x", tilt]]},
        wheel: {"parent": fork, "rotation": [["y", spin]]},
    }
    sketch.blocks["gravity"] = ["0", "0", "-9.81"]
    sketch.block("bodies")[wheel] = {
        "mass": m,
        "inertia": {"xx": f"{m}*{r}**2/4", "yy": f"{m}*{r}**2/2", "zz": f"{m}*{r}**2/4"},
    }
    if dice.chance(0.4):
        arm, swing = sketch.name("arm"), sketch.name("swing")
        sketch.start[swing] = 0.2
        sketch.block("joints")[arm] = {"type": "revolute", "axis": "y", "parent": fork, "coordinate": swing}
        sketch.block("bodies")[arm] = {
            "mass": "0.7",
            "com": ["0", "0", "-0.1"],
            "inertia": dict.fromkeys(("xx", "yy", "zz"), "0.01"),
        }
    sketch.block("rolling")[sketch.name("ground")] = {"frame": wheel, "radius": r}
    torques = [(direction, axes) for direction, axes in (("y", fork), ("z", ""), ("x", fork)) if dice.chance(0.7)]
    for k, (direction, axes) in enumerate(torques, 1):
        entry: dict[str, Any] = {"torque_on": wheel, "direction": ["1" if axis == direction else "0" for axis in "xyz"]}
        if axes:
            entry["axes"] = axes
        sketch.block("inputs")[sketch.name(f"u_{k}")] = entry
    return finish(sketch)


def cable_robot(dice: Dice) -> Description:
    """A platform in the plane or in space on cables, more than it needs, sometimes with weights and a preload."""
    sketch = Sketch(dice, "cable_robot")
    spatial = dice.chance(0.4)
    platform = sketch.name("platform")
    if spatial:
        names = [sketch.name(plain) for plain in ("x", "y", "z", "e_0", "e_1", "e_2", "e_3")]
        sketch.start |= dict(zip(names, (0.1, -0.1, 0.4, 1.0, 0.0, 0.0, 0.0), strict=True))
        sketch.block("joints")[platform] = {"type": "floating", "coordinates": names}
        sketch.name.take((f"{platform}_norm",))
    else:
        names = [sketch.name(plain) for plain in ("x", "y", "phi")]
        sketch.start |= dict(zip(names, (0.1, 0.2, 0.15), strict=True))
        sketch.block("joints")[platform] = {"type": "planar", "coordinates": names}
    sketch.blocks["gravity"] = ["0", "0", "-9.81"] if spatial else ["0", "-9.81", "0"]
    inertia = {"xx": "0.2", "yy": "0.3", "zz": "0.25"} if spatial else {"zz": "0.2"}
    sketch.block("bodies")[platform] = {"mass": sketch.parameter("m", dice.mass()), "inertia": inertia}
    freedom = 6 if spatial else 3
    count = max(1, freedom + dice.weighted({-2: 1, 0: 2, 1: 4, 2: 2, 3: 1}))
    for k in range(count):
        turn = 2 * math.pi * k / count
        height = (1.5 if k % 2 else -1.2) if spatial else 0
        pulley, hook = sketch.name(f"pulley_{k}"), sketch.name(f"hook_{k}")
        far = [decimal(2 * math.cos(turn), 2), decimal(2 * math.sin(turn), 2), decimal(height, 2)]
        near = [decimal(dice.uniform(-0.3, 0.3), 2) for _ in range(3 if spatial else 2)] + ([] if spatial else ["0"])
        sketch.block("points")[pulley] = {"at": far}
        sketch.block("points")[hook] = {"frame": platform, "at": near}
        sketch.block("inputs")[sketch.name(f"cable_{k}")] = {"unit": "N", "cable": dice.shuffled([pulley, hook])}
    if count > freedom and dice.chance(0.5):
        allocate(sketch)
    return finish(sketch)


def geared(dice: Dice) -> Description:
    """Shafts and slides with linear couplings between coordinates or between rates, some without any mass."""
    sketch = Sketch(dice, "geared")
    count = dice.whole(2, 8)
    names = [sketch.coordinate(f"s_{k}", 0.0, "rad") for k in range(1, count + 1)]
    kinetic = []
    for name in names:
        if dice.chance(0.8):
            inertia = dice.choice(("1", "1e-9", "1e3")) if dice.chance(0.1) else dice.number(0.01, 3, 2)
            kinetic.append(f"{inertia}/2*{name}_dot**2")
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic or [f"{names[0]}_dot**2/2"]))
    if dice.chance(0.5):
        sketch.blocks["potential_energy"] = Terms(tuple(f"{dice.mass()}*cos({name})" for name in dice.sample(names, 2)))
    for k in range(dice.whole(1, count - 1)):
        sketch.mark("coupling")
        terms = [
            f"{dice.choice(('1', '-1', '2', '0.5', '-3'))}*{{{j}}}" for j in range(dice.weighted({2: 4, 3: 2, 4: 1}))
        ]
        chosen = dice.sample(names, len(terms))
        kind = dice.choice(("geometric", "nonholonomic"))
        suffix = "_dot" if kind == "nonholonomic" else ""
        text = " + ".join(terms[: len(chosen)]).format(*(name + suffix for name in chosen))
        scale = dice.choice(("1e-6", "1e6")) if dice.chance(0.1) else ""
        sketch.block("constraints").setdefault(kind, {})[sketch.name(f"gear_{k}")] = (
            f"{scale}*({text})" if scale else text
        )
    for k in range(dice.whole(1, count)):
        column = {name: dice.choice(("1", "-1", "2")) for name in dice.sample(names, dice.whole(1, 2))}
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}
    return finish(sketch)
