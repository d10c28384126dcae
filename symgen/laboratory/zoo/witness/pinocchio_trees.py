"""Trees of bodies once more with Pinocchio, where it is installed: G and all other forces of the witness itself.

What Pinocchio does not know (springs, friction, force elements, rotors, energies) is taken out of the file first, and
so are rows and inputs. A URDF is read by Pinocchio itself. The rates v of its joints are T(q) times those of the file:
the angular velocity in body axes is 2 (e_0 e' - e_0' e - e x e') for a quaternion (e_0, e).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.fields import Floats
from symgen.laboratory.zoo.witness.frames import joint_coordinates, read_vector, unit_axis
from symgen.laboratory.zoo.witness.mechanics import equations
from symgen.laboratory.zoo.witness.reader import SystemReader
from symgen.laboratory.zoo.witness.urdf_file import expanded

ALONE = ("gravity", "parameters", "definitions", "frames", "joints", "bodies", "coordinates")
KINDS = ("revolute", "prismatic", "cylindrical", "planar", "spherical", "floating")
STATES = 5
# angles of a URDF that are rounded stand for quarter turns, for Pinocchio they do not
SAME, SAME_WITH_ROUNDED_ANGLES = 1e-10, 1e-6


def disagreement(
    blocks: Mapping[str, Any], parameters: Mapping[str, float], dice: Dice, files: Mapping[str, str] | None = None
) -> float | None:
    """The largest difference from Pinocchio relative to the largest entry; None where there is nothing to compare."""
    given = {name: blocks[name] for name in (*ALONE, "urdf") if name in blocks}
    if "urdf" in given:
        given = {name: given[name] for name in ("gravity", "parameters", "urdf") if name in given}
    elif not _is_tree(given):
        return None
    try:
        pinocchio = import_module("pinocchio")
    except ModuleNotFoundError:
        return None
    alone = {name: block for name, block in expanded(given, files or {}).items() if name in ALONE}
    system = SystemReader(alone)
    if len(system.coordinates) != sum(len(joint_coordinates(entry)) for entry in alone["joints"].values()):
        return None
    if "urdf" in given:
        tree = _robot(pinocchio, system, parameters, (files or {})[_file_of(given["urdf"])])
    else:
        tree = _Joints(pinocchio, system, parameters).tree
    worst = max(_apart(tree, system, parameters, dice) for _ in range(STATES))
    return worst * SAME / SAME_WITH_ROUNDED_ANGLES if "urdf" in given else worst


def _is_tree(blocks: Mapping[str, Any]) -> bool:
    """Joints of the kinds that are known here, with bodies on their frames."""
    joints = blocks.get("joints") or {}
    frames = {entry.get("child", name) for name, entry in joints.items()}
    carried = {(body or {}).get("frame", name) for name, body in (blocks.get("bodies") or {}).items()} <= frames
    places = {"world", *frames}
    known = all(entry["type"] in KINDS and entry.get("parent", "world") in places for entry in joints.values())
    return bool(joints) and carried and known


def _file_of(entry: Any) -> str:
    return str(entry if isinstance(entry, str) else entry["file"])


def _apart(tree: _Tree, system: SystemReader, parameters: Mapping[str, float], dice: Dice) -> float:
    """At one state."""
    n = len(system.coordinates)
    q, qd = (np.array([dice.uniform(-1.5, 1.5) for _ in range(n)]) for _ in range(2))
    for part in tree.parts:
        if part.quaternion:
            # where a quaternion has length 1 and keeps it, its second derivative does not enter T' q'
            places = list(part.quaternion)
            q[places] /= np.linalg.norm(q[places])
            qd[places] -= q[places] * (q[places] @ qd[places])
    values = {**parameters, **dict(zip(system.coordinates, q, strict=True))}
    values |= dict(zip(system.rate_names, qd, strict=True))
    found = equations(system)
    own_mass = np.array([system.tape.evaluate(row, values, Floats()) for row in found.mass])
    own_bias = np.array(system.tape.evaluate(found.bias, values, Floats()))
    mass, bias = tree.forces(q, qd)
    heaviest = float(np.abs(mass).max(initial=0.0))
    # forces of gravity cancel about a vertical axis
    largest = max(heaviest, float(np.abs(bias).max(initial=0.0))) or 1.0
    apart = np.abs(own_mass - mass).max(initial=0.0) / (heaviest or 1.0)
    return float(max(apart, np.abs(own_bias - bias).max(initial=0.0) / largest))


@dataclass(frozen=True)
class _Part:
    """A joint of Pinocchio's: places of its coordinates in the file's q, of its q and v in Pinocchio's."""

    single: tuple[int, ...]
    way: tuple[int, ...]
    quaternion: tuple[int, ...]
    in_q: int
    in_v: int
    wraps: bool = False


class _Tree:
    """A model of Pinocchio's with the coordinates of a file."""

    def __init__(self, pinocchio: Any, model: Any, parts: list[_Part], gravity: Any) -> None:
        self._pin, self._model, self.parts = pinocchio, model, parts
        model.gravity = pinocchio.Motion(gravity, np.zeros(3))
        self._data = model.createData()

    def forces(self, q: Any, qd: Any) -> tuple[Any, Any]:
        """G and all other forces, in the order of the file's coordinates."""
        here = self._pin.neutral(self._model)
        rates = np.zeros((self._model.nv, len(q)))
        drift = np.zeros(self._model.nv)
        for part in self.parts:
            at = part.in_v
            if part.single:
                (index,) = part.single
                rates[at, index] = 1
                here[part.in_q : part.in_q + 1 + part.wraps] = (
                    (np.cos(q[index]), np.sin(q[index])) if part.wraps else q[index]
                )
                continue
            w, x, y, z = (float(q[k]) for k in part.quaternion)
            spin = 2 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
            if part.way:
                axes = self._pin.Quaternion(w, x, y, z).toRotationMatrix()
                rates[at : at + 3, list(part.way)] = axes.T
                here[part.in_q : part.in_q + 3] = q[list(part.way)]
                turning = spin @ qd[list(part.quaternion)]
                drift[at : at + 3] = -np.cross(turning, axes.T @ qd[list(part.way)])
                at += 3
            rates[at : at + 3, list(part.quaternion)] = spin
            here[part.in_q + len(part.way) : part.in_q + len(part.way) + 4] = (x, y, z, w)
        mass = self._pin.crba(self._model, self._data, here)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = self._pin.nonLinearEffects(self._model, self._data, here, rates @ qd)
        return rates.T @ mass @ rates, rates.T @ (bias + mass @ drift)


def _robot(pinocchio: Any, system: SystemReader, parameters: Mapping[str, float], text: str) -> _Tree:
    """A URDF as Pinocchio reads it."""
    model = pinocchio.buildModelFromXML(text)
    names = system.coordinates
    parts = []
    for joint, name in zip(list(model.joints)[1:], list(model.names)[1:], strict=True):
        parts.append(_Part((names.index(name),), (), (), joint.idx_q, joint.idx_v, joint.nq == 2))
    read = read_vector(system.tape, system.blocks.get("gravity"), system.read)
    return _Tree(pinocchio, model, parts, np.array(system.tape.evaluate(read, parameters, Floats()), dtype=float))


class _Joints:
    """The joints of a file as Pinocchio's: one for each coordinate, or for each quaternion."""

    def __init__(self, pinocchio: Any, system: SystemReader, parameters: Mapping[str, float]) -> None:
        self._pin, self._system, self._parameters = pinocchio, system, parameters
        self._model = pinocchio.Model()
        self._parts: list[_Part] = []
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
        self.tree = _Tree(pinocchio, self._model, self._parts, self._vector(system.blocks.get("gravity")))

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
        singles = {
            "revolute": [turn(axis)],
            "prismatic": [slide(axis)],
            "cylindrical": [slide(axis), turn(axis)],
            "planar": [slide(x), slide(y), turn(z)],
        }
        rotation = np.eye(3)
        for about, angle in entry.get("rotation") or []:
            turned = self._axis(about) * self._numbers([self._system.read(angle)])[0]
            rotation = rotation @ pin.exp3(turned)
        placement = pin.SE3(rotation, self._vector(entry.get("at")))
        parent = self._known[entry.get("parent", "world")]
        places = [self._system.coordinates.index(each) for each in joint_coordinates(entry)]
        if entry["type"] in singles:
            for place, kind in zip(places, singles[entry["type"]], strict=True):
                parent = self._joint(parent, kind, placement, f"{name} {place}", ((place,), (), ()))
                placement = pin.SE3.Identity()
        else:
            kind = pin.JointModelSpherical() if len(places) == 4 else pin.JointModelFreeFlyer()
            parent = self._joint(parent, kind, placement, name, ((), tuple(places[:-4]), tuple(places[-4:])))
        self._known[entry.get("child", name)] = parent

    def _joint(self, parent: int, kind: Any, placement: Any, name: str, places: tuple[Any, Any, Any]) -> int:
        index: int = self._model.addJoint(parent, kind, placement, name)
        joint = self._model.joints[index]
        self._parts.append(_Part(*places, joint.idx_q, joint.idx_v))
        return index

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
