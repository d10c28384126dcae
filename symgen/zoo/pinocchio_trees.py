"""Trees of bodies once more with Pinocchio, where it is installed: G and all other forces of the witness itself.

What Pinocchio does not know (springs, friction, force elements, rotors, energies) is taken out of the file first, and
so are rows and inputs. Trees with quaternions are left to the witness alone: Pinocchio has no rates of quaternions.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import numpy as np

from symgen.zoo.dice import Dice
from symgen.zoo.fields import Floats
from symgen.zoo.frames import joint_coordinates, read_vector, unit_axis
from symgen.zoo.mechanics import equations
from symgen.zoo.reader import System

ALONE = ("gravity", "parameters", "definitions", "joints", "bodies", "coordinates")
KINDS = ("revolute", "prismatic", "cylindrical", "planar")
STATES = 5
SAME = 1e-10


def disagreement(blocks: Mapping[str, Any], parameters: Mapping[str, float], dice: Dice) -> float | None:
    """The largest difference from Pinocchio relative to the largest entry; None where there is nothing to compare."""
    joints = blocks.get("joints") or {}
    bodies = blocks.get("bodies") or {}
    frames = {entry.get("child", name) for name, entry in joints.items()}
    carried = {(body or {}).get("frame", name) for name, body in bodies.items()} <= frames
    if (
        not joints
        or not carried
        or any(entry["type"] not in KINDS for entry in joints.values())
        or blocks.get("frames")
    ):
        return None
    try:
        pinocchio = import_module("pinocchio")
    except ModuleNotFoundError:
        return None
    system = System({name: blocks[name] for name in ALONE if name in blocks})
    if len(system.coordinates) != sum(len(joint_coordinates(entry)) for entry in joints.values()):
        return None
    tree = _Tree(pinocchio, system, parameters)
    found = equations(system)
    worst = 0.0
    n = len(system.coordinates)
    for _ in range(STATES):
        q, qd = (np.array([dice.uniform(-1.5, 1.5) for _ in range(n)]) for _ in range(2))
        values = {**parameters, **dict(zip(system.coordinates, q, strict=True))}
        values |= dict(zip(system.rate_names, qd, strict=True))
        flat = np.array(system.tape.evaluate(found.flat, values, Floats()))
        mass, bias = tree.forces(q, qd)
        # what the rates do may cancel in every entry: rounding is that of masses times squares of rates
        heavy = np.abs(mass).max(initial=0.0)
        moving = heavy * np.abs(qd).max(initial=0.0) ** 2
        pairs = ((flat[: n * n], mass.reshape(-1), heavy), (flat[n * n : n * n + n], bias, moving))
        for one, other, least in pairs:
            scale = max(float(np.abs(other).max(initial=0.0)), float(least)) or 1.0
            worst = max(worst, float(np.abs(one - other).max()) / scale)
    return worst


class _Tree:
    """The joints of a file as Pinocchio's, one for each coordinate."""

    def __init__(self, pinocchio: Any, system: System, parameters: Mapping[str, float]) -> None:
        self._pin, self._system, self._parameters = pinocchio, system, parameters
        self._model = pinocchio.Model()
        gravity = self._vector(system.blocks.get("gravity"))
        self._model.gravity = pinocchio.Motion(gravity, np.zeros(3))
        self._order: list[str] = []
        joints = {entry.get("child", name): (name, entry) for name, entry in system.blocks["joints"].items()}
        self._known: dict[str, int] = {"world": 0}
        # branch after branch: Pinocchio counts on the joints of a branch being next to each other
        waiting = ["world"]
        while waiting:
            carrier = waiting.pop()
            for name, entry in system.blocks["joints"].items():
                if entry.get("parent", "world") == carrier:
                    waiting.append(entry.get("child", name))
            if carrier != "world":
                self._add(*joints[carrier])
        for name, body in (system.blocks.get("bodies") or {}).items():
            self._load(name, body or {})
        self._data = self._model.createData()

    def forces(self, q: Any, qd: Any) -> tuple[Any, Any]:
        """G and all other forces, in the order of the file's coordinates."""
        names = self._system.coordinates
        place = [names.index(name) for name in self._order]
        mass = self._pin.crba(self._model, self._data, q[place])
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = self._pin.nonLinearEffects(self._model, self._data, q[place], qd[place])
        back = [self._order.index(name) for name in names]
        return mass[np.ix_(back, back)], bias[back]

    def _vector(self, given: Any) -> Any:
        return self._numbers(read_vector(self._system.tape, given, self._system.read))

    def _numbers(self, nodes: Any) -> Any:
        return np.array(self._system.tape.evaluate(nodes, self._parameters, Floats()), dtype=float)

    def _axis(self, given: Any) -> Any:
        return self._numbers(unit_axis(self._system.tape, given, self._system.read))

    def _add(self, name: str, entry: Mapping[str, Any]) -> None:
        pin = self._pin
        axis = self._axis(entry.get("axis", "z"))
        turn, slide = pin.JointModelRevoluteUnaligned, pin.JointModelPrismaticUnaligned
        x, y, z = np.eye(3)
        models = {
            "revolute": [(turn, axis)],
            "prismatic": [(slide, axis)],
            "cylindrical": [(slide, axis), (turn, axis)],
            "planar": [(slide, x), (slide, y), (turn, z)],
        }[entry["type"]]
        rotation = np.eye(3)
        for about, angle in entry.get("rotation") or []:
            turned = self._axis(about) * self._numbers([self._system.read(angle)])[0]
            rotation = rotation @ pin.exp3(turned)
        placement = pin.SE3(rotation, self._vector(entry.get("at")))
        parent = self._known[entry.get("parent", "world")]
        for coordinate, (kind, along) in zip(joint_coordinates(entry), models, strict=True):
            parent = self._model.addJoint(parent, kind(along), placement, coordinate)
            placement = pin.SE3.Identity()
            self._order.append(coordinate)
        self._known[entry.get("child", name)] = parent

    def _load(self, name: str, body: Mapping[str, Any]) -> None:
        tensor = {
            key: float(self._numbers([self._system.read(text)])[0]) for key, text in (body.get("inertia") or {}).items()
        }
        xx, yy, zz, xy, xz, yz = (tensor.get(key, 0.0) for key in ("xx", "yy", "zz", "xy", "xz", "yz"))
        mass = float(self._numbers([self._system.read(body.get("mass", "0"))])[0])
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        # as force and torque of a rigid body, also where the tensor is none that a body can have
        weight = self._pin.Inertia(mass, self._vector(body.get("com")), inertia)
        self._model.appendBodyToJoint(self._known[body.get("frame", name)], weight, self._pin.SE3.Identity())
