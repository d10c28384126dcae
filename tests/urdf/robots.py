"""Robot descriptions written by hand, and ways to look at the models that come of them."""

from __future__ import annotations

import random
from pathlib import Path

from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator

LIMIT = '<limit lower="-2" upper="2" velocity="3" effort="50"/>'
ARM = f"""\
<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0.25 0 0"/>
      <mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/>
    </inertial>
  </link>
  <link name="lower">
    <inertial>
      <origin xyz="0.2 0 0.01" rpy="0 0 0"/>
      <mass value="1.5"/>
      <inertia ixx="0.008" ixy="0.001" ixz="0" iyy="0.04" iyz="0" izz="0.04"/>
    </inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <origin xyz="0 0 0.3" rpy="1.5707963267948966 0 0"/>
    <axis xyz="0 0 1"/>
    {LIMIT}
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/>
    <child link="lower"/>
    <origin xyz="0.5 0 0"/>
    <axis xyz="0 0 1"/>
    <dynamics damping="0.1"/>
  </joint>
</robot>
"""
HEAD = "model: robot\nurdf: robot.urdf\ngravity: [0, 0, -9.81]\n"


def load(folder: Path, robot: str, model: str = HEAD) -> Model:
    """The model with that robot description beside it."""
    (folder / "robot.urdf").write_text(robot, encoding="utf-8")
    return load_text(model, str(folder / "robot.yaml"))


def link(name: str, mass: float = 1, inertia: float = 0.02, origin: str = "") -> str:
    """A link with a round tensor, or without mass."""
    if not mass:
        return f'<link name="{name}"/>\n'
    tensor = f'<inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/>'
    return f'<link name="{name}"><inertial>{origin}<mass value="{mass}"/>{tensor}</inertial></link>\n'


def joint(name: str, kind: str, parent: str, child: str, parts: str = "") -> str:
    """A joint between two links."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{parts}</joint>\n'
    )


def robot(*parts: str) -> str:
    """A robot of these links and joints."""
    return f'<robot name="robot">\n{"".join(parts)}</robot>\n'


def state_of(model: Model, seed: int) -> dict[str, float]:
    """Any state, by the names of the coordinates, rates and accelerations."""
    source = random.Random(seed)
    names = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    return {name: source.uniform(-1, 1) for name in names}


def balance(model: Model, state: dict[str, float]) -> dict[str, float]:
    """The generalized forces that a motion needs, by coordinates."""
    defaults = {p.name: 1.0 for p in model.parameters}
    forces = Evaluator(System(model).balance)({**defaults, **state})
    return dict(zip((c.name for c in model.coordinates), forces, strict=True))


def mass_matrix(model: Model, state: dict[str, float]) -> list[float]:
    """The mass matrix, row after row."""
    return Evaluator([x for row in System(model).mass_matrix for x in row])(state)
