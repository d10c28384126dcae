"""Frames, points and what they do, for the witness: rotation matrices multiplied out, positions differentiated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from symgen.laboratory.zoo.witness.numbers.tape import Node, NodeTape
from symgen.laboratory.zoo.witness.reading.expressions import NotReadError

Vector = tuple[Node, Node, Node]
Matrix = tuple[Vector, Vector, Vector]
Read = Callable[[str], Node]
# no name of a file has a space in it
BASE = " base"


@dataclass(frozen=True)
class Pose:
    """Axes of a frame as columns in the world, its origin, its angular velocity in the world."""

    axes: Matrix
    origin: Vector
    turning: Vector


@dataclass(frozen=True)
class Relative:
    """A frame as the file places it: parent, translation, then turns (axis, angle) or a quaternion."""

    parent: str
    translation: Vector
    turns: tuple[tuple[Vector, Node], ...]
    quaternion: tuple[Node, Node, Node, Node] | None = None


def dot(a: Vector, b: Vector) -> Node:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scaled(factor: Node, a: Vector) -> Vector:
    """factor a."""
    return factor * a[0], factor * a[1], factor * a[2]


def turned(axes: Matrix, a: Vector) -> Vector:
    """axes a, the rows of `axes` being those of the matrix."""
    return dot(axes[0], a), dot(axes[1], a), dot(axes[2], a)


def transposed(a: Matrix) -> Matrix:
    """The transpose."""
    return tuple((a[0][i], a[1][i], a[2][i]) for i in range(3))  # type: ignore[return-value]


def product(a: Matrix, b: Matrix) -> Matrix:
    """a b."""
    columns = transposed(b)
    return tuple((dot(row, columns[0]), dot(row, columns[1]), dot(row, columns[2])) for row in a)  # type: ignore[return-value]


class FramePoses:
    """Poses of the frames of a file, worked out as they are asked for; `rate` differentiates along the motion."""

    def __init__(self, tape: NodeTape, relative: Mapping[str, Relative], rate: Callable[[Node], Node]) -> None:
        self._tape, self._relative, self._rate = tape, relative, rate
        zero, one = tape.zero, tape.one
        self.still: Vector = (zero, zero, zero)
        self._identity: Matrix = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
        self._poses = {"world": Pose(self._identity, self.still, self.still)}

    def __contains__(self, name: str) -> bool:
        return name == "world" or name in self._relative

    def pose(self, name: str) -> Pose:
        """Where a frame stands and how it turns."""
        chain = []
        current = name
        while current not in self._poses:
            chain.append(current)
            current = self._relative[current].parent
        for each in reversed(chain):
            self._poses[each] = self._placed(self._relative[each])
        return self._poses[name]

    def carrier(self, name: str) -> str:
        """The frame of the file that a frame moves on."""
        parent = self._relative[name].parent
        return self._relative[parent].parent if parent.endswith(BASE) else parent

    def meeting(self, one: str, other: str) -> str:
        """The nearest frame that both hang on."""
        line = self._line(other)
        return next(frame for frame in self._line(one) if frame in line)

    def _line(self, frame: str) -> list[str]:
        line = [frame]
        while line[-1] != "world":
            line.append(self._relative[line[-1]].parent)
        return line

    def place(self, frame: str, at: Vector) -> Vector:
        """A point of a frame in the world."""
        pose = self.pose(frame)
        return plus(pose.origin, turned(pose.axes, at))

    def rates(self, vector: Vector) -> Vector:
        """The derivative of a vector along the motion."""
        return self._rate(vector[0]), self._rate(vector[1]), self._rate(vector[2])

    def _placed(self, relative: Relative) -> Pose:
        parent = self.pose(relative.parent)
        origin = plus(parent.origin, turned(parent.axes, relative.translation))
        if relative.quaternion is not None:
            inner = self._attitude(relative.quaternion)
            # the rate of a rotation times its transpose is the cross product with the angular velocity
            change = product(tuple(self.rates(row) for row in inner), transposed(inner))  # type: ignore[arg-type]
            spin = (change[2][1], change[0][2], change[1][0])
            return Pose(product(parent.axes, inner), origin, plus(parent.turning, turned(parent.axes, spin)))
        axes, turning = parent.axes, parent.turning
        for axis, angle in relative.turns:
            turning = plus(turning, scaled(self._rate(angle), turned(axes, axis)))
            axes = product(axes, self._about(axis, angle))
        return Pose(axes, origin, turning)

    def _about(self, axis: Vector, angle: Node) -> Matrix:
        """1 + sin K + (1 - cos) K K, K the cross product with the unit axis."""
        tape = self._tape
        sine, versed = tape.call("sin", angle), tape.one - tape.call("cos", angle)
        x, y, z = axis
        zero = tape.zero
        k: Matrix = ((zero, -z, y), (z, zero, -x), (-y, x, zero))
        square = product(k, k)
        return tuple(plus(plus(self._identity[i], scaled(sine, k[i])), scaled(versed, square[i])) for i in range(3))  # type: ignore[return-value]

    def _attitude(self, parts: tuple[Node, Node, Node, Node]) -> Matrix:
        tape = self._tape
        w, x, y, z = parts
        size = w * w + x * x + y * y + z * z
        two = tape.number(2)

        def entry(value: Node) -> Node:
            return value / size

        return (
            (entry(w * w + x * x - y * y - z * z), entry(two * (x * y - w * z)), entry(two * (x * z + w * y))),
            (entry(two * (x * y + w * z)), entry(w * w - x * x + y * y - z * z), entry(two * (y * z - w * x))),
            (entry(two * (x * z - w * y)), entry(two * (y * z + w * x)), entry(w * w - x * x - y * y + z * z)),
        )


def read_frames(tape: NodeTape, blocks: Mapping[str, Any], read: Read) -> dict[str, Relative]:
    """The frames of the blocks `frames` and `joints`."""
    by_name: dict[str, Relative] = {}
    for name, entry in (blocks.get("frames") or {}).items():
        given = entry or {}
        rotation = given.get("rotation") or []
        translation = read_vector(tape, given.get("translation"), read)
        parent = given.get("parent", "world")
        if isinstance(rotation, Mapping):
            w, x, y, z = (read(part) for part in rotation["quaternion"])
            by_name[name] = Relative(parent, translation, (), (w, x, y, z))
        else:
            turns = tuple((unit_axis(tape, axis, read), read(angle)) for axis, angle in rotation)
            by_name[name] = Relative(parent, translation, turns)
    for name, entry in (blocks.get("joints") or {}).items():
        child = entry.get("child", name)
        base, moved = _joint(tape, entry, read)
        by_name[child + BASE] = base
        by_name[child] = replace(moved, parent=child + BASE)
    return by_name


def joint_coordinates(entry: Mapping[str, Any]) -> list[str]:
    """The coordinates of a joint, in its order."""
    return [entry["coordinate"]] if "coordinate" in entry else list(entry.get("coordinates", ()))


def _joint(tape: NodeTape, entry: Mapping[str, Any], read: Read) -> tuple[Relative, Relative]:
    """The frame that the fixed turns of a joint lead to, and what moves on it."""
    kind = entry["type"]
    at = read_vector(tape, entry.get("at"), read)
    turns = tuple((unit_axis(tape, axis, read), read(angle)) for axis, angle in entry.get("rotation") or [])
    base = Relative(entry.get("parent", "world"), at, turns)
    axis = unit_axis(tape, entry.get("axis", "z"), read)
    still = (tape.zero, tape.zero, tape.zero)
    q = [read(name) for name in joint_coordinates(entry)]
    if kind == "revolute":
        return base, Relative("", still, ((axis, q[0]),))
    if kind == "prismatic":
        return base, Relative("", scaled(q[0], axis), ())
    if kind == "cylindrical":
        return base, Relative("", scaled(q[0], axis), ((axis, q[1]),))
    if kind == "planar":
        return base, Relative("", (q[0], q[1], tape.zero), ((unit_axis(tape, "z", read), q[2]),))
    if kind == "spherical":
        return base, Relative("", still, (), (q[0], q[1], q[2], q[3]))
    if kind == "floating":
        return base, Relative("", (q[0], q[1], q[2]), (), (q[3], q[4], q[5], q[6]))
    raise NotReadError(f"a joint of type {kind}")


def read_vector(tape: NodeTape, given: Sequence[str] | None, read: Read) -> Vector:
    """Three expressions; zero where there are none."""
    if given is None:
        return tape.zero, tape.zero, tape.zero
    x, y, z = (read(str(part)) for part in given)
    return x, y, z


def unit_axis(tape: NodeTape, given: Any, read: Read) -> Vector:
    """x, y, z or three expressions, with length 1."""
    zero, one = tape.zero, tape.one
    if isinstance(given, str):
        return {"x": (one, zero, zero), "y": (zero, one, zero), "z": (zero, zero, one)}[given]
    axis = read_vector(tape, given, read)
    size = tape.call("sqrt", dot(axis, axis))
    return axis[0] / size, axis[1] / size, axis[2] / size
