"""Trees of bodies once more with Pinocchio, where it is installed: forces of a motion, accelerations under forces.

What Pinocchio does not know (springs, friction, force elements, rotors, energies) is taken out of the file first, and
so are rows and inputs. A URDF is read by Pinocchio itself, unless the file has joints or bodies beside it. The rates v
of its joints are T(q) times those of the file: the angular velocity in body axes is 2 (e_0 e' - e_0' e - e x e') for a
quaternion (e_0, e).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.kkt import EquationEvaluator
from symgen.laboratory.zoo.witness.numbers.fields import Floats
from symgen.laboratory.zoo.witness.numbers.tape import NodeProgram
from symgen.laboratory.zoo.witness.reading.frames import (
    BASE,
    Relative,
    joint_coordinates,
    read_frames,
    read_vector,
    unit_axis,
)
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.reading.urdf_file import exact_angles, expanded

ALONE = ("gravity", "parameters", "definitions", "frames", "joints", "bodies", "coordinates")
# what makes a robot of a file another one than Pinocchio reads there
BESIDE_A_FILE = ("frames", "joints", "bodies", "coordinates")
KINDS = ("revolute", "prismatic", "cylindrical", "planar", "spherical", "floating")
STATES = 20
SAME = 1e-10


def tree_of(
    blocks: Mapping[str, Any], parameters: Mapping[str, float], files: Mapping[str, str]
) -> tuple[PinocchioTree, SystemReader] | None:
    """The joints and bodies of a file as Pinocchio's, and alone as the zoo reads them; None where these are no tree."""
    alone = {name: block for name, block in expanded(blocks, files).items() if name in ALONE}
    system = SystemReader(alone)
    if not _is_tree(system):
        return None
    try:
        pinocchio = import_module("pinocchio")
    except ModuleNotFoundError:
        return None
    if "urdf" in blocks and not any(name in blocks for name in BESIDE_A_FILE):
        entry = blocks["urdf"]
        text = files[str(entry if isinstance(entry, str) else entry["file"])]
        return _robot(pinocchio, system, parameters, exact_angles(text)), system
    return _Joints(pinocchio, system, parameters).tree, system


def disagreement(tree: PinocchioTree, system: SystemReader, parameters: Mapping[str, float], dice: Dice) -> float:
    """The largest difference of G and of all other forces relative to the largest entry, at random states."""
    system_equations = equations(system)
    evaluate = EquationEvaluator(NodeProgram(system.tape, system_equations.flat), system_equations)
    return max(_apart(tree, system, evaluate, parameters, dice) for _ in range(STATES))


def _is_tree(system: SystemReader) -> bool:
    """Joints of the kinds that are known here; all that carries a joint or a body moves with one of them or not."""
    joints = system.blocks.get("joints") or {}
    if not joints or any(entry["type"] not in KINDS for entry in joints.values()):
        return False
    if len(system.coordinates) != sum(len(joint_coordinates(entry)) for entry in joints.values()):
        return False
    frames = read_frames(system.tape, system.blocks, system.read)
    names = system.blocks.get("frames") or {}
    carriers = {(body or {}).get("frame", name) for name, body in (system.blocks.get("bodies") or {}).items()}
    carriers |= {entry.get("parent", "world") for entry in joints.values()}
    while carriers:
        name = carriers.pop()
        if name not in names:
            continue
        if not is_fixed(system, frames[name]):
            return False
        carriers.add(frames[name].parent)
    return True


def is_fixed(system: SystemReader, frame: Relative) -> bool:
    """Whether a frame stands still on its parent."""
    turns = [node for axis, angle in frame.turns for node in (*axis, angle)]
    reached = system.tape.reached([*frame.translation, *turns, *(frame.quaternion or ())])
    return not {str(node.payload) for node in reached if node.op == "symbol"} & set(system.coordinates)


def _apart(
    tree: PinocchioTree, system: SystemReader, evaluate: EquationEvaluator, parameters: Mapping[str, float], dice: Dice
) -> float:
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
    own = evaluate(values, Floats())
    mass, bias = tree.forces(q, qd)
    heaviest = float(np.abs(mass).max(initial=0.0))
    # forces of gravity cancel about a vertical axis
    largest = max(heaviest, float(np.abs(bias).max(initial=0.0))) or 1.0
    apart = np.abs(np.array(own.mass) - mass).max(initial=0.0) / (heaviest or 1.0)
    return float(max(apart, np.abs(np.array(own.bias) - bias).max(initial=0.0) / largest))


@dataclass(frozen=True)
class _PinocchioJoint:
    """A joint of Pinocchio's: places of its coordinates in the file's q, of its q and v in Pinocchio's."""

    single: tuple[int, ...]
    way: tuple[int, ...]
    quaternion: tuple[int, ...]
    in_q: int
    in_v: int
    wraps: bool = False


@dataclass(frozen=True)
class _PinocchioState:
    """Pinocchio's q and v at a state of the file: v = rates q', v' = rates q'' + drift."""

    place: Any
    rates: Any
    drift: Any


class PinocchioTree:
    """A model of Pinocchio's with the coordinates of a file."""

    def __init__(self, pinocchio: Any, model: Any, parts: list[_PinocchioJoint], gravity: Any) -> None:
        self._pin, self._model, self.parts = pinocchio, model, parts
        model.gravity = pinocchio.Motion(gravity, np.zeros(3))
        self._data = model.createData()

    def forces(self, q: Any, qd: Any) -> tuple[Any, Any]:
        """G and all other forces, in the order of the file's coordinates."""
        at = self._kinematics(q, qd)
        mass = self._pin.crba(self._model, self._data, at.place)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = self._pin.nonLinearEffects(self._model, self._data, at.place, at.rates @ qd)
        return at.rates.T @ mass @ at.rates, at.rates.T @ (bias + mass @ at.drift)

    @property
    def weight(self) -> float:
        """Of all bodies together."""
        return float(sum(body.mass for body in self._model.inertias) * np.linalg.norm(self._model.gravity.linear))

    def load(self, q: Any, qd: Any, qdd: Any) -> Any:
        """The forces that a motion takes, by the recursion of Newton's and Euler's equations (RNEA)."""
        at = self._kinematics(q, qd)
        accelerations = at.rates @ qdd + at.drift
        return at.rates.T @ self._pin.rnea(self._model, self._data, at.place, at.rates @ qd, accelerations)

    def takes(self, rotors: Any) -> bool:
        """Whether such masses are rotors of single coordinates, all that Pinocchio knows beside its bodies."""
        single = [index for part in self.parts for index in part.single]
        others = np.array(rotors, dtype=float)
        others[single, single] = 0
        return not others.any()

    def accelerations(self, q: Any, qd: Any, forces: Any, rotors: Any) -> Any:
        """What a tree does under forces, by the algorithm of articulated bodies (ABA)."""
        at = self._kinematics(q, qd)
        # columns of a quaternion are at right angles
        back = (at.rates / np.square(at.rates).sum(axis=1)[:, None]).T
        armature = np.zeros(self._model.nv)
        for part in self.parts:
            armature[part.in_v] = rotors[part.single[0]][part.single[0]] if part.single else 0.0
        still = np.array(self._model.armature)
        self._model.armature = armature
        tree_accelerations = self._pin.aba(self._model, self._data, at.place, at.rates @ qd, back.T @ forces)
        self._model.armature = still
        accelerations = back @ (tree_accelerations - at.drift)
        for part in self.parts:
            if part.quaternion:
                places = list(part.quaternion)
                accelerations[places] -= q[places] * (qd[places] @ qd[places])
        return accelerations

    def _kinematics(self, q: Any, qd: Any) -> _PinocchioState:
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
        return _PinocchioState(here, rates, drift)


def _robot(pinocchio: Any, system: SystemReader, parameters: Mapping[str, float], text: str) -> PinocchioTree:
    """A URDF as Pinocchio reads it."""
    model = pinocchio.buildModelFromXML(text)
    names = system.coordinates
    parts = []
    for joint, name in zip(list(model.joints)[1:], list(model.names)[1:], strict=True):
        parts.append(_PinocchioJoint((names.index(name),), (), (), joint.idx_q, joint.idx_v, joint.nq == 2))
    read = read_vector(system.tape, system.blocks.get("gravity"), system.read)
    gravity = np.array(system.tape.evaluate(read, parameters, Floats()), dtype=float)
    return PinocchioTree(pinocchio, model, parts, gravity)


class _Joints:
    """The joints of a file as Pinocchio's: one for each coordinate, or for each quaternion."""

    def __init__(self, pinocchio: Any, system: SystemReader, parameters: Mapping[str, float]) -> None:
        self._pin, self._system, self._parameters = pinocchio, system, parameters
        self._model = pinocchio.Model()
        self._parts: list[_PinocchioJoint] = []
        self._frames = read_frames(system.tape, system.blocks, system.read)
        # the joint that a frame moves with, and where it stands on that
        self._known: dict[str, tuple[int, Any]] = {"world": (0, pinocchio.SE3.Identity())}
        joints = {entry.get("child", name): (name, entry) for name, entry in system.blocks["joints"].items()}
        # branch after branch: Pinocchio counts on the joints of a branch being next to each other
        waiting = ["world"]
        while waiting:
            carrier = waiting.pop()
            if carrier in joints:
                self._add(*joints[carrier])
            waiting += self._carried(carrier)
        for name, body in (system.blocks.get("bodies") or {}).items():
            self._load(name, body or {})
        self.tree = PinocchioTree(pinocchio, self._model, self._parts, self._vector(system.blocks.get("gravity")))

    def _vector(self, given: Any) -> Any:
        return self._numbers(read_vector(self._system.tape, given, self._system.read))

    def _numbers(self, nodes: Any) -> Any:
        return np.array(self._system.tape.evaluate(nodes, self._parameters, Floats()), dtype=float)

    def _axis(self, given: Any) -> Any:
        return self._numbers(unit_axis(self._system.tape, given, self._system.read))

    def _carried(self, carrier: str) -> list[str]:
        """Places the fixed frames that stand on a frame; them and the joints there."""
        blocks = self._system.blocks
        children = []
        for name in blocks.get("frames") or {}:
            frame = self._frames[name]
            if frame.parent == carrier and is_fixed(self._system, frame):
                joint, place = self._known[carrier]
                self._known[name] = joint, place * self._placed(frame)
                children.append(name)
        for name, entry in blocks["joints"].items():
            if entry.get("parent", "world") == carrier:
                children.append(entry.get("child", name))
        return children

    def _placed(self, frame: Relative) -> Any:
        """Where a frame that stands still is on its parent."""
        rotation = np.eye(3)
        for axis, angle in frame.turns:
            rotation = rotation @ self._pin.exp3(self._numbers(axis) * self._numbers([angle])[0])
        if frame.quaternion is not None:
            rotation = self._pin.Quaternion(*map(float, self._numbers(frame.quaternion))).toRotationMatrix()
        return self._pin.SE3(rotation, self._numbers(frame.translation))

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
        child = entry.get("child", name)
        parent, placement = self._known[entry.get("parent", "world")]
        placement = placement * self._placed(self._frames[child + BASE])
        places = [self._system.coordinates.index(each) for each in joint_coordinates(entry)]
        if entry["type"] in singles:
            for place, kind in zip(places, singles[entry["type"]], strict=True):
                parent = self._joint(parent, kind, placement, f"{name} {place}", ((place,), (), ()))
                placement = pin.SE3.Identity()
        else:
            kind = pin.JointModelSpherical() if len(places) == 4 else pin.JointModelFreeFlyer()
            parent = self._joint(parent, kind, placement, name, ((), tuple(places[:-4]), tuple(places[-4:])))
        self._known[child] = parent, pin.SE3.Identity()

    def _joint(self, parent: int, kind: Any, placement: Any, name: str, places: tuple[Any, Any, Any]) -> int:
        index: int = self._model.addJoint(parent, kind, placement, name)
        joint = self._model.joints[index]
        self._parts.append(_PinocchioJoint(*places, joint.idx_q, joint.idx_v))
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
        joint, place = self._known[body.get("frame", name)]
        self._model.appendBodyToJoint(joint, weight, place)
