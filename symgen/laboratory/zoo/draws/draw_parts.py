"""Joints and bodies drawn one after the other, in the plane and in space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from symgen.laboratory.zoo.dice import Dice, decimal
from symgen.laboratory.zoo.draws.sketch import Sketch

MAIN_AXES = ("x", "y", "z")
DIMENSIONS = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "planar": 3, "spherical": 4, "floating": 7}
Numbers = list[float]


@dataclass(frozen=True)
class DrawnPart:
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


def norms(parts: list[DrawnPart]) -> int:
    """How many rows hold quaternions."""
    return sum(part.kind in ("spherical", "floating") for part in parts)


def grown(sketch: Sketch, style: Style, coordinates: int, first: str) -> list[DrawnPart]:
    """Joints and bodies until there are so many coordinates."""
    dice = sketch.dice
    sketch.name.take(("world",))
    sketch.block("joints")
    direction = "z" if style.plane == "y" else "y"
    sign = dice.choice(("-", "-", ""))
    down = f"{sign}{sketch.parameter('g', '9.81')}"
    if not dice.chance(0.1):
        sketch.blocks["gravity"] = [down if axis == direction else "0" for axis in MAIN_AXES]
    parts: list[DrawnPart] = []
    while (have := sum(len(part.coordinates) for part in parts)) < coordinates:
        fitting = [kind for kind in style.kinds if have + DIMENSIONS[kind] <= max(coordinates, DIMENSIONS[kind])]
        kind = first if first and not parts else dice.choice(fitting)
        if style.plane and kind not in ("revolute", "prismatic"):
            kind = "revolute"
        parent = -1
        if parts and not dice.chance(0.1 if not first else 0):
            parent = len(parts) - 1 if not dice.chance(style.branching) else dice.whole(0, len(parts) - 1)
        parts.append(_part(sketch, style, parts, parent, kind))
    return parts


def weighted(sketch: Sketch, style: Style, parts: list[DrawnPart], held: set[int]) -> None:
    """Bodies for most ends that have none; `held` are parts of which a loop holds a point.

    A free end without mass moves without effort, which is refused, and rightly; rods without mass close loops often.
    """
    dice = sketch.dice
    carriers = {part.parent for part in parts}
    for k, part in enumerate(parts):
        bare = part.frame not in sketch.block("bodies")
        if k not in carriers and bare and not dice.chance(0.7 if k in held else 0.15):
            sketch.block("bodies")[part.frame] = _body(sketch, style, k + 1, part.tip)


def carried_along(sketch: Sketch) -> DrawnPart | None:
    """Now and then, all that is drawn stands on a frame that moves itself, as the arm of an excavator does.

    The other draws stay what they were: what this needs is thrown with dice of its own.
    """
    dice = Dice("carried along", *sketch.start.items())
    if not dice.chance(0.2) or len(sketch.start) > 11:
        return None
    kind = dice.choice(("revolute", "revolute", "prismatic"))
    joint, coordinate = sketch.name("carriage"), sketch.name("turn" if kind == "revolute" else "way")
    for entry in sketch.block("joints").values():
        entry.setdefault("parent", joint)
    for entry in sketch.block("points").values():
        entry.setdefault("frame", joint)
    sketch.block("joints")[joint] = {"type": kind, "axis": dice.choice(MAIN_AXES), "coordinate": coordinate}
    sketch.start[coordinate] = round(dice.uniform(0.2, 0.8), 2)
    sketch.block("bodies")[joint] = {"mass": "12", "inertia": dict.fromkeys(("xx", "yy", "zz"), "0.8")}
    sketch.mark("loop on a frame that moves")
    return DrawnPart(joint, kind, (coordinate,), -1, ("0", "0", "0"))


def _part(sketch: Sketch, style: Style, parts: list[DrawnPart], parent: int, kind: str) -> DrawnPart:
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
    if not style.plane and dice.chance(0.15):
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
    return DrawnPart(frame, kind, names, parent, tip)


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


def depth(parts: list[DrawnPart], index: int) -> int:
    """How many coordinates move a part: its own and those of the parts that carry it."""
    return 0 if index < 0 else len(parts[index].coordinates) + depth(parts, parts[index].parent)


def chain_of(parts: list[DrawnPart], index: int) -> set[int]:
    """A part and all that carry it, by their indices."""
    chain = set()
    while index >= 0:
        chain.add(index)
        index = parts[index].parent
    return chain
