"""Robots described by a URDF, and a model file around it that adds inputs, points, springs, a base that moves."""

from __future__ import annotations

from functools import partial
from typing import Any

from symgen.laboratory.zoo.dice import Dice, decimal
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.draw_closures import add_point, carried
from symgen.laboratory.zoo.draws.endings import finish
from symgen.laboratory.zoo.draws.sketch import Sketch

FILE = "robot.urdf"


def robot_files(dice: Dice) -> Description:
    """A tree of links in a URDF: revolute, continuous, prismatic and fixed joints, followers, limits, friction."""
    sketch = Sketch(dice, "robot_files")
    links, text = ["base"], [_link(dice, "base", dice.chance(0.5))]
    moving: list[str] = []
    turned = False
    for k in range(1, dice.whole(1, 9) + 1):
        link = sketch.name(f"link_{k}")
        parent = links[-1] if dice.chance(0.7) else dice.choice(links)
        kind = dice.weighted({"revolute": 5, "continuous": 2, "prismatic": 2, "fixed": 2})
        name = f"mount_{k}" if kind == "fixed" else sketch.name(f"joint_{k}")
        text.append(_link(dice, link, dice.chance(0.9)))
        if kind != "fixed":
            follows = moving[-1] if turned and kind == "revolute" and dice.chance(0.12) else ""
            turned = kind != "prismatic"
            start = 0.5 * sketch.start[follows] + 0.1 if follows else _start(dice, kind)
            sketch.start[name] = start
            moving.append(name)
            text.append(_joint(dice, name, kind, parent, link, start, follows))
        else:
            text.append(_joint(dice, name, kind, parent, link, 0.0, ""))
        links.append(link)
    if not moving:
        links.append(sketch.name("last"))
        moving.append(sketch.name("turn"))
        sketch.start[moving[0]] = 0.3
        text += [_link(dice, links[-1], True), _joint(dice, moving[0], "revolute", links[-2], links[-1], 0.3, "")]
    # the tip of a chain that moves has a mass
    text = [_link(dice, links[-1], True) if line == f'  <link name="{links[-1]}"/>' else line for line in text]
    sketch.files[FILE] = "\n".join(('<robot name="drawn">', *text, "</robot>")) + "\n"
    sketch.blocks["urdf"] = {"file": FILE, "friction_width": "0.01"}
    sketch.blocks["gravity"] = ["0", "0", "-9.81"]
    sketch.name.take(("world", "base"))
    if dice.chance(0.2):
        sketch.blocks["joints"] = {"free": {"type": "planar", "child": "base", "coordinates": ["x_b", "y_b", "turn_b"]}}
        sketch.start |= {"x_b": 0.1, "y_b": -0.2, "turn_b": 0.4}
    _around(sketch, links, moving)
    return finish(sketch)


def _around(sketch: Sketch, links: list[str], moving: list[str]) -> None:
    """What the model file adds to the robot."""
    dice = sketch.dice
    if dice.chance(0.4):
        tool = add_point(sketch, "tool", links[-1], ["0.1", "0", "0.05"])
        if len(moving) > 3 and dice.chance(0.6):
            sketch.that_moves(partial(_held, sketch, tool), oddly=0.05)
    if dice.chance(0.3):
        sketch.block("springs")[sketch.name("coil")] = {"joint": dice.choice(moving), "stiffness": "30"}
    for k, name in enumerate(dice.sample(moving, dice.whole(1, len(moving))), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": name}


def _held(sketch: Sketch, tool: str) -> int:
    wall = add_point(sketch, "wall", "world", carried(sketch, sketch.place(tool), "world"))
    sketch.block("loops")[sketch.name("held")] = {"type": "point", "between": [tool, wall]}
    sketch.mark("loop in space")
    return 3


def _start(dice: Dice, kind: str) -> float:
    return round(dice.uniform(0.1, 0.3), 2) if kind == "prismatic" else dice.angle()


def _link(dice: Dice, name: str, heavy: bool) -> str:
    if not heavy:
        return f'  <link name="{name}"/>'
    sides = [dice.uniform(0.05, 0.3) ** 2 for _ in range(3)]
    mass = dice.uniform(0.2, 5)
    tensor = {f"i{axis * 2}": (sum(sides) - side) * mass / 12 for axis, side in zip("xyz", sides, strict=True)}
    tensor |= {"ixy": 0.0, "ixz": 0.05 * min(tensor.values()) if dice.chance(0.3) else 0.0, "iyz": 0.0}
    written = " ".join(f'{key}="{decimal(value, 6)}"' for key, value in tensor.items())
    place = " ".join(decimal(dice.uniform(-0.2, 0.2), 3) for _ in range(3))
    turn = dice.choice(("", ' rpy="0 0 0.3"', ' rpy="1.5707963267949 0 0"', ' rpy="0.1 -0.2 0.3"'))
    inner = f'<origin xyz="{place}"{turn}/> <mass value="{decimal(mass, 3)}"/> <inertia {written}/>'
    return f'  <link name="{name}"> <inertial> {inner} </inertial> </link>'


def _joint(dice: Dice, name: str, kind: str, parent: str, child: str, start: float, follows: str) -> str:
    axis = dice.choice(("1 0 0", "0 1 0", "0 0 1", "0 -1 0", "0 0 1", "0.6 0 0.8", "1 2 -1"))
    place = " ".join(dice.choice(("0", "0.1", "0.35", "-0.2")) for _ in range(3))
    turn = dice.choice(("0 0 0", "0 0 0", "1.57079633 0 0", "0 -1.5708 0", "0.1 0.2 -0.3", "0 0 3.14159265359"))
    parts: list[Any] = [
        f'<parent link="{parent}"/>',
        f'<child link="{child}"/>',
        f'<origin xyz="{place}" rpy="{turn}"/>',
    ]
    if kind != "fixed":
        parts.append(f'<axis xyz="{axis}"/>')
        limit = f'lower="{decimal(start - 0.8, 4)}" upper="{decimal(start + 0.8, 4)}" ' if kind != "continuous" else ""
        if kind != "continuous" or dice.chance(0.4):
            parts.append(f'<limit {limit}velocity="3" effort="50"/>')
        if dice.chance(0.3):
            parts.append(f'<dynamics damping="{decimal(dice.uniform(0.01, 0.5), 2)}"/>')
        elif dice.chance(0.2):
            parts.append('<dynamics damping="0.1" friction="0.3"/>')
        if follows:
            parts.append(f'<mimic joint="{follows}" multiplier="0.5" offset="0.1"/>')
    return f'  <joint name="{name}" type="{kind}"> {" ".join(parts)} </joint>'
