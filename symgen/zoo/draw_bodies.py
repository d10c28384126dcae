"""Mechanisms drawn as they are built: trees of joints in the plane and in space, loops closed where the tips stand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

from symgen.zoo.describe import Description
from symgen.zoo.dice import Dice, decimal, exact
from symgen.zoo.endings import finish
from symgen.zoo.sketch import Sketch

MAIN_AXES = ("x", "y", "z")
DIMENSIONS = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "planar": 3, "spherical": 4, "floating": 7}
ROWS = {"distance": 1, "point": 3, "spherical": 3, "planar": 3, "cylindrical": 4, "revolute": 5, "prismatic": 5}
Numbers = list[float]


@dataclass(frozen=True)
class Part:
    """A moving frame: its joint's type and coordinates, its parent and where its tip is on it."""

    frame: str
    kind: str
    coordinates: tuple[str, ...]
    parent: int
    tip: tuple[str, str, str]


@dataclass(frozen=True)
class Style:
    """What all parts of a draw have in common."""

    plane: str = ""
    skew: float = 0.2
    kinds: tuple[str, ...] = ("revolute",)
    branching: float = 0.25
    massless: float = 0.0
    sparse: bool = False


def tree_bodies(dice: Dice) -> Description:
    """A tree of bodies, fixed to the ground or floating."""
    sketch = Sketch(dice, "tree_bodies")
    kinds = dice.choice(
        (("revolute",), ("revolute", "revolute", "prismatic"), ("revolute", "cylindrical", "prismatic", "spherical"))
    )
    style = Style(
        plane=dice.choice(("", "", "z", "y")), skew=dice.choice((0, 0.3, 0.8)), kinds=kinds,
        massless=dice.choice((0, 0, 0, 0.3)), sparse=dice.chance(0.5),
    )  # fmt: skip
    first = dice.weighted({"": 6, "floating": 1.5, "planar": 1})
    parts = grown(sketch, style, dice.choice((2, 4, 6, 9, 12)), first)
    elements(sketch, parts, style.plane)
    inputs(sketch, parts, sum(len(part.coordinates) for part in parts) - norms(parts))
    return finish(dice, sketch.family, sketch.blocks, sketch.start)


def planar_bodies(dice: Dice) -> Description:
    """Links about parallel axes with one to four loops."""
    sketch = Sketch(dice, "planar_bodies")
    plane = dice.choice(MAIN_AXES)
    style = Style(plane=plane, kinds=("revolute",) * 5 + ("prismatic",), branching=0.3, sparse=True)
    loops = dice.weighted({1: 5, 2: 3, 3: 1, 4: 0.6})
    parts = grown(sketch, style, min(11, dice.whole(2 * loops + 1, 2 * loops + 3)), "")
    rows = 0
    for index in range(loops):
        room = len(sketch.start) - rows - 1
        if room < 1:
            break
        rows += sketch.that_moves(partial(_planar_loop, sketch, parts, index, room), oddly=0.1)
    if rows and dice.chance(0.15):
        _surplus(sketch)
    elements(sketch, parts, plane)
    inputs(sketch, parts, len(sketch.start) - rows)
    return finish(dice, sketch.family, sketch.blocks, sketch.start)


def spatial_bodies(dice: Dice) -> Description:
    """Chains in space with one to four loops of any joint."""
    sketch = Sketch(dice, "spatial_bodies")
    kinds = dice.choice(
        (("revolute",), ("revolute", "revolute", "prismatic", "spherical"), ("revolute", "cylindrical"))
    )
    style = Style(skew=dice.choice((0, 0.3, 0.8)), kinds=kinds, branching=0.3, sparse=dice.chance(0.6))
    first = dice.weighted({"": 6, "floating": 1})
    parts = grown(sketch, style, dice.whole(4, 11), first)
    free = len(sketch.start) - norms(parts)
    for index in range(dice.weighted({1: 6, 2: 3, 3: 1, 4: 0.5})):
        free -= sketch.that_moves(partial(_spatial_loop, sketch, parts, index, free), oddly=0.02)
    elements(sketch, parts, "")
    inputs(sketch, parts, free)
    return finish(dice, sketch.family, sketch.blocks, sketch.start)


def _surplus(sketch: Sketch) -> None:
    """A loop that is closed twice, or held once more by a row of its own in other units."""
    dice = sketch.dice
    name, entry = dice.choice(list(sketch.block("loops").items()))
    if dice.chance(0.5) or entry["type"] == "distance":
        sketch.block("loops")[sketch.name(f"{name}_again")] = dict(entry)
        return
    one, other = entry["between"]
    axis = dice.choice([axis for axis in MAIN_AXES if not _flat(sketch, axis)])
    scale = dice.choice(("1e-6", "1e6", "2"))
    rows = sketch.block("constraints").setdefault("geometric", {})
    rows[sketch.name("held")] = f"{scale}*({one}.{axis} - {other}.{axis})"


def norms(parts: list[Part]) -> int:
    """How many rows hold quaternions."""
    return sum(part.kind in ("spherical", "floating") for part in parts)


def grown(sketch: Sketch, style: Style, coordinates: int, first: str) -> list[Part]:
    """Joints and bodies until there are so many coordinates."""
    dice = sketch.dice
    sketch.name.take(("world",))
    sketch.block("joints")
    direction = "z" if style.plane == "y" else "y"
    sign = dice.choice(("-", "-", ""))
    down = f"{sign}{sketch.parameter('g', '9.81')}"
    if not dice.chance(0.1):
        sketch.blocks["gravity"] = [down if axis == direction else "0" for axis in MAIN_AXES]
    parts: list[Part] = []
    while (have := sum(len(part.coordinates) for part in parts)) < coordinates:
        fitting = [kind for kind in style.kinds if have + DIMENSIONS[kind] <= max(coordinates, DIMENSIONS[kind])]
        kind = first if first and not parts else dice.choice(fitting)
        if style.plane and kind not in ("revolute", "prismatic"):
            kind = "revolute"
        parent = -1
        if parts and not dice.chance(0.1 if not first else 0):
            parent = len(parts) - 1 if not dice.chance(style.branching) else dice.whole(0, len(parts) - 1)
        parts.append(_part(sketch, style, parts, parent, kind))
    # a massless end moves without effort, which is refused, and rightly; massless parts between bodies are usual
    carriers = {part.parent for part in parts}
    for k, part in enumerate(parts):
        if k not in carriers and part.frame not in sketch.block("bodies") and not dice.chance(0.1):
            sketch.block("bodies")[part.frame] = _body(sketch, style, k + 1, part.tip)
    return parts


def _part(sketch: Sketch, style: Style, parts: list[Part], parent: int, kind: str) -> Part:
    dice = sketch.dice
    k = len(parts) + 1
    entry: dict[str, Any] = {"type": kind}
    if parent >= 0:
        entry["parent"] = parts[parent].frame
        entry["at"] = list(parts[parent].tip)
    elif parts:
        entry["at"] = [decimal(dice.uniform(-1, 1), 2) if axis != style.plane else "0" for axis in MAIN_AXES]
    if kind in ("revolute", "prismatic", "cylindrical"):
        entry["axis"] = _axis(dice, style, kind)
    if kind == "revolute" and not style.plane and dice.chance(0.12):
        entry["rotation"] = [[dice.choice(MAIN_AXES), dice.choice(("pi/2", "-pi/2", "pi/4", "0.3"))]]
    joint = sketch.name(f"j_{k}")
    frame = joint
    if dice.chance(0.3):
        frame = entry["child"] = sketch.name(f"link_{k}")
    values = _values(dice, kind)
    letters = {"revolute": "a", "prismatic": "s", "cylindrical": "sa", "planar": "xya"}.get(
        kind, "xyz"[: len(values) - 4]
    )
    letters = letters if kind in ("revolute", "prismatic", "cylindrical", "planar", "floating") else ""
    plain = [f"{letter}_{k}" for letter in letters] + [f"e{i}_{k}" for i in range(len(values) - len(letters))]
    names = tuple(sketch.name(name) for name in plain)
    sketch.start |= dict(zip(names, values, strict=True))
    entry |= {"coordinate": names[0]} if len(names) == 1 else {"coordinates": list(names)}
    sketch.block("joints")[joint] = entry
    if kind in ("spherical", "floating"):
        sketch.name.take((f"{joint}_norm",))
    tip = _tip(sketch, style, k)
    if not dice.chance(style.massless) or not parts:
        sketch.block("bodies")[frame] = _body(sketch, style, k, tip)
    return Part(frame, kind, names, parent, tip)


def _axis(dice: Dice, style: Style, kind: str) -> Any:
    if style.plane:
        if kind == "revolute":
            return style.plane if dice.chance(0.9) else ["-1" if axis == style.plane else "0" for axis in MAIN_AXES]
        return dice.choice([axis for axis in MAIN_AXES if axis != style.plane])
    if dice.chance(style.skew):
        return dice.choice(
            (["1", "1", "0"], ["0", "1", "1"], ["1", "0", "-1"], ["1", "2", "3"], ["0.3", "-0.5", "0.8"])
        )
    return dice.choice(MAIN_AXES)


def _values(dice: Dice, kind: str) -> Numbers:
    way = round(dice.uniform(0.2, 0.8), 2)
    if kind in ("revolute", "prismatic"):
        return [dice.angle() if kind == "revolute" else way]
    if kind == "cylindrical":
        return [way, dice.angle()]
    if kind == "planar":
        return [way, round(dice.uniform(-1, 1), 2), dice.angle()]
    # a quaternion of rationals, so that its length is 1 to the last bit or nearly
    parts = dice.choice(([1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.5, 0.5], [0.8, 0.6, 0.0, 0.0], [0.8, 0.0, 0.36, 0.48]))
    return ([round(dice.uniform(-1, 1), 2) for _ in range(3)] if kind == "floating" else []) + parts


def _tip(sketch: Sketch, style: Style, k: int) -> tuple[str, str, str]:
    """Where the next joint is: along one axis, or anywhere."""
    dice = sketch.dice
    length = sketch.parameter(f"l_{k}", dice.length())
    free = [index for index, axis in enumerate(MAIN_AXES) if axis != style.plane]
    tip = ["0", "0", "0"]
    tip[dice.choice(free)] = length
    if dice.chance(0.2):
        tip[dice.choice(free)] = dice.number(-0.4, 0.4, 2)
    if dice.chance(0.06):
        # an offset that this machine does not have
        name = sketch.name(f"h_{k}")
        sketch.block("parameters")[name] = {"value": "0"}
        index = dice.choice(free)
        tip[index] = name if tip[index] == "0" else f"{tip[index]} + {name}"
    return tip[0], tip[1], tip[2]


def _body(sketch: Sketch, style: Style, k: int, tip: tuple[str, str, str]) -> dict[str, Any]:
    dice = sketch.dice
    body: dict[str, Any] = {"mass": sketch.parameter(f"m_{k}", dice.mass(dice.chance(0.04)))}
    if dice.chance(0.85):
        body["com"] = [f"({part})/2" if "+" in part else f"{part}/2" if part != "0" else "0" for part in tip]
    if style.sparse and "com" in body and dice.chance(0.3):
        return body
    if style.plane:
        body["inertia"] = {f"{style.plane * 2}": sketch.parameter(f"J_{k}", dice.number(0.001, 0.3, 2))}
        return body
    # of a cuboid, so that it is a tensor that a body can have
    sides = [dice.uniform(0.05, 0.4) for _ in range(3)]
    squares = [side**2 for side in sides]
    moments = [decimal((sum(squares) - square) * dice.uniform(0.99, 1.01) / 3, 4) for square in squares]
    body["inertia"] = dict(zip(("xx", "yy", "zz"), moments, strict=True))
    if dice.chance(0.2):
        body["inertia"][dice.choice(("xy", "xz", "yz"))] = decimal(0.05 * min(map(float, moments)), 2)
    return body


def _point(sketch: Sketch, plain: str, frame: str, at: list[str]) -> str:
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


def _depth(parts: list[Part], index: int) -> int:
    return 0 if index < 0 else len(parts[index].coordinates) + _depth(parts, parts[index].parent)


def _planar_loop(sketch: Sketch, parts: list[Part], index: int, room: int) -> int:
    dice = sketch.dice
    deep = [k for k in range(len(parts)) if _depth(parts, k) >= 3] or [len(parts) - 1]
    leaf = dice.choice(deep)
    tip = _point(sketch, f"tip_{index}", parts[leaf].frame, list(parts[leaf].tip))
    chain = _chain(parts, leaf)
    others = [k for k in range(len(parts)) if k not in chain]
    other = parts[dice.choice(others)].frame if others and dice.chance(0.5) else "world"
    place = sketch.place(tip)
    name = sketch.name(f"loop_{index}")
    if room < 2 or dice.chance(0.2):
        plane = next((axis for axis in MAIN_AXES if _flat(sketch, axis)), "z")
        off = [0.0 if axis == plane else dice.uniform(-0.7, 0.7) for axis in MAIN_AXES]
        far = [a + b for a, b in zip(place, off, strict=True)]
        anchor = _point(sketch, f"anchor_{index}", other, carried(sketch, far, other))
        length = sketch.parameter(f"rod_{index}", exact(math.dist(place, sketch.place(anchor))))
        sketch.block("loops")[name] = {"type": "distance", "between": [tip, anchor], "length": length}
        return 1
    anchor = _point(sketch, f"anchor_{index}", other, carried(sketch, place, other))
    sketch.block("loops")[name] = {"type": "point", "between": [tip, anchor]}
    return 2


def _flat(sketch: Sketch, axis: str) -> bool:
    """Whether the joints turn about this axis."""
    return any(entry.get("axis") == axis and entry["type"] == "revolute" for entry in sketch.block("joints").values())


def _chain(parts: list[Part], index: int) -> set[int]:
    found = set()
    while index >= 0:
        found.add(index)
        index = parts[index].parent
    return found


def _spatial_loop(sketch: Sketch, parts: list[Part], index: int, free: int) -> int:
    """A loop of any kind that leaves at least one of `free` degrees of freedom; how many rows it has."""
    dice = sketch.dice
    fitting = [kind for kind, rows in ROWS.items() if rows < free]
    if not fitting:
        return 0
    kind = dice.choice(fitting)
    leaf = max((dice.whole(0, len(parts) - 1) for _ in range(2)), key=lambda k: _depth(parts, k))
    chain = _chain(parts, leaf)
    others = [k for k in range(len(parts)) if k not in chain]
    other = parts[dice.choice(others)].frame if others and dice.chance(0.5) else "world"
    frame = parts[leaf].frame
    name = sketch.name(f"loop_{index}")
    if kind in ("point", "distance"):
        tip = _point(sketch, f"tip_{index}", frame, list(parts[leaf].tip))
        place = sketch.place(tip)
        if kind == "distance":
            place = [part + dice.uniform(-0.6, 0.6) for part in place]
        anchor = _point(sketch, f"anchor_{index}", other, carried(sketch, place, other))
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


def elements(sketch: Sketch, parts: list[Part], plane: str) -> None:
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
        hook = _point(sketch, "hook", "world", far)
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


def inputs(sketch: Sketch, parts: list[Part], freedom: int) -> None:
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


def _force(sketch: Sketch, parts: list[Part], k: int) -> dict[str, Any]:
    dice = sketch.dice
    part = dice.choice(parts)
    direction = ["0", "0", "0"]
    direction[dice.whole(0, 2)] = "1"
    match dice.choice(("point", "torque", "cable", "coordinate")):
        case "point":
            point = _point(sketch, f"push_{k}", part.frame, list(part.tip))
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
            tip = _point(sketch, f"end_{k}", part.frame, list(part.tip))
            far = [decimal(dice.uniform(2, 3) * dice.choice((-1, 1)), 2) for _ in MAIN_AXES]
            pulley = _point(sketch, f"pulley_{k}", "world", far)
            return {"cable": [tip, pulley]}
    return {"acts_on": {dice.choice(part.coordinates): "1"}}
