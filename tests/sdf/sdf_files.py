"""Machines written twice: as an SDF with its poses relative to this and that, and as MJCF from places in the world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator

HEAD = "model: robot\nsdf: {file: robot.sdf, friction_width: 0.01}\ngravity: [0.3, -0.2, -9.5]\n"


def load(folder: Path, robot: str, model: str = HEAD) -> Model:
    """The model with that SDF beside it."""
    (folder / "robot.sdf").write_text(robot, encoding="utf-8")
    return load_text(model, str(folder / "robot.yaml"))


def link(name: str, pose: str = "", parts: str = "", mass: float = 1) -> str:
    """A link with a round tensor."""
    moments = "".join(f"<{key}>{0.02 * mass}</{key}>" for key in ("ixx", "iyy", "izz"))
    inertial = f"<inertial><mass>{mass}</mass><inertia>{moments}</inertia></inertial>"
    return f'<link name="{name}">{pose}{inertial}{parts}</link>\n'


def joint(name: str, kind: str, parent: str, child: str, axis: str = "0 0 1", parts: str = "") -> str:
    """A joint between two links."""
    turning = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<joint name="{name}" type="{kind}">{ends}{turning}{parts}</joint>\n'


def robot(*parts: str) -> str:
    """A model of these links and joints."""
    return f'<sdf version="1.9">\n<model name="robot">\n{"".join(parts)}</model>\n</sdf>\n'


def placed(numbers: Sequence[float]) -> Any:
    """The matrix (4, 4) of a pose x y z roll pitch yaw."""
    x, y, z, roll, pitch, yaw = numbers
    c, s = np.cos, np.sin
    about_x = np.array([[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]])
    about_y = np.array([[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]])
    about_z = np.array([[c(yaw), -s(yaw), 0], [s(yaw), c(yaw), 0], [0, 0, 1]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = about_z @ about_y @ about_x, (x, y, z)
    return matrix


@dataclass(frozen=True)
class Part:
    """A link for MuJoCo: its place in the world, its parent there, and joints (type, anchor, axis in the world)."""

    name: str
    place: Any
    parent: str
    joints: tuple[tuple[str, str, Any, Any, str], ...]


def mjcf(parts: Sequence[Part]) -> str:
    """The same machine for MuJoCo."""
    places = {"world": np.eye(4), **{part.name: part.place for part in parts}}

    def body(part: Part) -> str:
        back = np.linalg.inv(part.place)
        own = np.linalg.inv(places[part.parent]) @ part.place
        text = f'<body name="{part.name}" pos="{numbers(own[:3, 3])}" xyaxes="{numbers([*own[:3, 0], *own[:3, 1]])}">'
        text += '<inertial mass="1" pos="0 0 0" diaginertia="0.02 0.02 0.02"/>'
        for name, kind, anchor, axis, more in part.joints:
            at = back @ [*anchor, 1]
            along = back[:3, :3] @ axis
            text += f'<joint name="{name}" type="{kind}" pos="{numbers(at[:3])}" axis="{numbers(along)}" {more}/>'
        return text + "".join(body(other) for other in parts if other.parent == part.name) + "</body>"

    bodies = "".join(body(part) for part in parts if part.parent == "world")
    head = '<mujoco><compiler angle="radian"/><option gravity="0.3 -0.2 -9.5"/>'
    return f"{head}<worldbody>{bodies}</worldbody></mujoco>"


def numbers(values: Any) -> str:
    """With all digits."""
    return " ".join(repr(float(value)) for value in values)


def rows(model: Model, state: dict[str, float]) -> Any:
    """The Jacobian of all rows."""
    jacobian = [entry for row in System(model).constraint_jacobian for entry in row]
    return np.array(Evaluator(jacobian)(state)).reshape(-1, len(model.coordinates))
