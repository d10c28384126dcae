"""Loops closed where the tips of a drawn tree stand: points that meet, rods, joints of every kind."""

from __future__ import annotations

import math
from typing import Any

from symgen.laboratory.zoo.dice import exact
from symgen.laboratory.zoo.draws.draw_parts import MAIN_AXES, DrawnPart, Numbers, chain_of, depth
from symgen.laboratory.zoo.draws.sketch import Sketch

ROWS = {"distance": 1, "point": 3, "spherical": 3, "planar": 3, "cylindrical": 4, "revolute": 5, "prismatic": 5}


def closed_at(sketch: Sketch, parts: list[DrawnPart]) -> set[int]:
    """The parts of which a loop holds a point or a direction."""
    ends = {end for loop in sketch.block("loops").values() for end in loop["between"]}
    frames = {sketch.block("points").get(end, {}).get("frame", end) for end in ends}
    frames |= {(sketch.blocks.get("frames") or {}).get(end, {}).get("parent", end) for end in ends}
    return {k for k, part in enumerate(parts) if part.frame in frames}


def surplus(sketch: Sketch) -> None:
    """A loop that is closed twice, or held once more by a row of its own in other units."""
    dice = sketch.dice
    name, entry = dice.choice(list(sketch.block("loops").items()))
    if dice.chance(0.5) or entry["type"] == "distance":
        sketch.block("loops")[sketch.name(f"{name}_again")] = dict(entry)
        return
    one, other = entry["between"]
    axis = dice.choice([axis for axis in MAIN_AXES if not flat(sketch, axis)])
    scale = dice.choice(("1e-6", "1e6", "2"))
    rows = sketch.block("constraints").setdefault("geometric", {})
    rows[sketch.name("held")] = f"{scale}*({one}.{axis} - {other}.{axis})"


def add_point(sketch: Sketch, plain: str, frame: str, at: list[str]) -> str:
    """A point at `at` (lengths in the axes of the frame) under a free name near the plain one, which is returned."""
    name = sketch.name(plain)
    sketch.block("points")[name] = {"at": at} if frame == "world" else {"frame": frame, "at": at}
    return name


def carried(sketch: Sketch, place: Numbers, frame: str) -> list[str]:
    """A place of the world in the axes of a frame, as it stands at the start."""
    if frame == "world":
        return [exact(part) for part in place]
    axes, origin = sketch.axes(frame), sketch.place(frame)
    arm = [a - b for a, b in zip(place, origin, strict=True)]
    parts = [sum(axes[row][column] * arm[row] for row in range(3)) for column in range(3)]
    return [exact(0.0 if abs(part) < 1e-15 else part) for part in parts]


def planar_loop(sketch: Sketch, parts: list[DrawnPart], index: int, room: int) -> int:
    """The tip of a chain held by a rod (1 row) or, where `room` for 2 rows is left, mostly in a point; the rows."""
    dice = sketch.dice
    deep = [k for k in range(len(parts)) if depth(parts, k) >= 3] or [len(parts) - 1]
    leaf = dice.choice(deep)
    tip = add_point(sketch, f"tip_{index}", parts[leaf].frame, list(parts[leaf].tip))
    chain = chain_of(parts, leaf)
    others = [k for k in range(len(parts)) if k not in chain]
    other = parts[dice.choice(others)].frame if others and dice.chance(0.5) else "world"
    place = sketch.place(tip)
    name = sketch.name(f"loop_{index}")
    sketch.mark("loop in the plane")
    if room < 2 or dice.chance(0.2):
        plane = next((axis for axis in MAIN_AXES if flat(sketch, axis)), "z")
        off = [0.0 if axis == plane else dice.uniform(-0.7, 0.7) for axis in MAIN_AXES]
        far = [a + b for a, b in zip(place, off, strict=True)]
        anchor = add_point(sketch, f"anchor_{index}", other, carried(sketch, far, other))
        length = sketch.parameter(f"rod_{index}", exact(math.dist(place, sketch.place(anchor))))
        sketch.block("loops")[name] = {"type": "distance", "between": [tip, anchor], "length": length}
        return 1
    anchor = add_point(sketch, f"anchor_{index}", other, carried(sketch, place, other))
    sketch.block("loops")[name] = {"type": "point", "between": [tip, anchor]}
    return 2


def flat(sketch: Sketch, axis: str) -> bool:
    """Whether the joints turn about this axis."""
    return any(entry.get("axis") == axis and entry["type"] == "revolute" for entry in sketch.block("joints").values())


def spatial_loop(sketch: Sketch, parts: list[DrawnPart], index: int, free: int) -> int:
    """A loop of any kind that leaves at least one of `free` degrees of freedom; how many rows it has."""
    dice = sketch.dice
    fitting = [kind for kind, rows in ROWS.items() if rows < free]
    if not fitting:
        return 0
    kind = dice.choice(fitting)
    leaf = max((dice.whole(0, len(parts) - 1) for _ in range(2)), key=lambda k: depth(parts, k))
    chain = chain_of(parts, leaf)
    others = [k for k in range(len(parts)) if k not in chain]
    other = parts[dice.choice(others)].frame if others and dice.chance(0.5) else "world"
    frame = parts[leaf].frame
    name = sketch.name(f"loop_{index}")
    sketch.mark("loop in space")
    if kind in ("point", "distance"):
        tip = add_point(sketch, f"tip_{index}", frame, list(parts[leaf].tip))
        place = sketch.place(tip)
        if kind == "distance":
            place = [part + dice.uniform(-0.6, 0.6) for part in place]
        anchor = add_point(sketch, f"anchor_{index}", other, carried(sketch, place, other))
        entry: dict[str, Any] = {"type": kind, "between": [tip, anchor]}
        if kind == "distance":
            entry["length"] = sketch.parameter(
                f"rod_{index}", exact(math.dist(sketch.place(tip), sketch.place(anchor)))
            )
        sketch.block("loops")[name] = entry
        return ROWS[kind]
    dock = sketch.name(f"dock_{index}")
    sketch.block("frames")[dock] = docked(sketch, frame, other)
    sketch.block("loops")[name] = {"type": kind, "between": [frame, dock]}
    if kind != "spherical" and dice.chance(0.6):
        sketch.block("loops")[name]["axis"] = dice.choice(MAIN_AXES)
    return ROWS[kind]


def docked(sketch: Sketch, frame: str, other: str) -> dict[str, Any]:
    """A frame on another one that stands where `frame` stands at the start."""
    entry: dict[str, Any] = {} if other == "world" else {"parent": other}
    entry["translation"] = carried(sketch, sketch.place(frame), other)
    here, there = sketch.axes(frame), sketch.axes(other)
    turn = [[sum(there[k][i] * here[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    axis, angle = axis_and_angle(turn)
    if angle:
        entry["rotation"] = [[[exact(part) for part in axis], exact(angle)]]
    return entry


def axis_and_angle(turn: list[Numbers]) -> tuple[Numbers, float]:
    """The axis and the angle of a rotation matrix."""
    skew = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]]
    sine, cosine = math.hypot(*skew) / 2, (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2
    angle = math.atan2(sine, cosine)
    if sine > 1e-9:
        return [0.0 if abs(part) < 1e-16 else part / (2 * sine) for part in skew], angle
    if cosine > 0:
        return [0.0, 0.0, 1.0], 0.0
    # a half turn: the largest column of (R + 1)/2 is along the axis
    columns = [[(turn[i][j] + (i == j)) / 2 for i in range(3)] for j in range(3)]
    return max(columns, key=lambda column: math.hypot(*column)), math.pi
