"""Random trees and loops, joints of all kinds about random axes, beside rotation matrices and Newton-Euler in NumPy."""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from symgen.ir.interpret import Interpreter
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities

QUANTITIES = (
    "point_position",
    "point_jacobian",
    "mass_matrix",
    "coriolis_matrix",
    "potential_force",
    "control_matrix",
    "nullspace_projector",
    "forward_dynamics",
)
GRAVITY = (0.7, -1.9, -9.3)
AXES = ((1, 1, 0), (1, -2, 2), (0.6, 0, 0.8), (1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 2), (0.3, 0.4, -1.2), (1, 1, 1))
FLAT = ((0, 1, 0), (1, -2, 0), (1, 1, 0))
# of fixed turns: what has a short sine and what has none
TILT = 0.7
TURNS = {
    "pi/2": np.pi / 2,
    "-pi/2": -np.pi / 2,
    "pi": np.pi,
    "pi/3": np.pi / 3,
    "-pi/4": -np.pi / 4,
    "pi/6": np.pi / 6,
    "0.3": 0.3,
    "-1.25": -1.25,
    "pi/5": np.pi / 5,
    "tilt": TILT,
    "2*tilt - pi/3": 2 * TILT - np.pi / 3,
}
# ways and angles of each kind, by axes of the joint where they are not its own
KINDS = {
    "revolute": ("angle",),
    "prismatic": ("way",),
    "cylindrical": ("way", "angle"),
    "planar": ("way x", "way y", "angle z"),
    "spherical": ("quaternion",),
    "floating": ("way x", "way y", "way z", "quaternion"),
}
MAIN = {"x": np.eye(3)[0], "y": np.eye(3)[1], "z": np.eye(3)[2]}


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def attitude(e: np.ndarray) -> np.ndarray:
    """The matrix of a quaternion, scalar first."""
    w, (x, y, z) = e[0], e[1:]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + (2 * w * cross + 2 * cross @ cross) / (e @ e)


def spin(e: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """2 conj(e) rate / |e|^2: an angular velocity in the turned axes."""
    return 2 * (e[0] * rate[1:] - rate[0] * e[1:] - np.cross(e[1:], rate[1:])) / (e @ e)


@dataclass(frozen=True)
class Moving:
    """A frame: attitude, place, and its velocities and accelerations, all in world axes."""

    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    place: np.ndarray = field(default_factory=lambda: np.zeros(3))
    w: np.ndarray = field(default_factory=lambda: np.zeros(3))
    v: np.ndarray = field(default_factory=lambda: np.zeros(3))
    dw: np.ndarray = field(default_factory=lambda: np.zeros(3))
    a: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def moved(self, way: np.ndarray, rate: np.ndarray | float = 0.0, change: np.ndarray | float = 0.0) -> Moving:
        """Another point of it, along its own axes."""
        r = self.turn @ way
        u, c = (np.zeros(3) + self.turn @ (np.zeros(3) + x) for x in (rate, change))
        v = self.v + np.cross(self.w, r) + u
        a = self.a + np.cross(self.dw, r) + np.cross(self.w, np.cross(self.w, r)) + 2 * np.cross(self.w, u) + c
        return replace(self, place=self.place + r, v=v, a=a)

    def turned(self, by: np.ndarray, rate: np.ndarray | float = 0.0, change: np.ndarray | float = 0.0) -> Moving:
        """A frame that turns in it; `rate` and `change` in the axes of the new one."""
        turn = self.turn @ by
        n, c = (turn @ (np.zeros(3) + x) for x in (rate, change))
        return replace(self, turn=turn, w=self.w + n, dw=self.dw + c + np.cross(self.w, n))


@dataclass(frozen=True)
class Joint:
    """One joint with its body; `fixed` are turns about axes by angles, as text and as number."""

    name: str
    parent: str
    kind: str
    axis: tuple[float, ...]
    at: tuple[float, ...]
    fixed: tuple[tuple[tuple[float, ...], str], ...]
    coordinates: tuple[str, ...]
    mass: float
    com: tuple[float, ...]
    inertia: tuple[float, ...]

    def moved(self, parent: Moving, q: list[float], qd: list[float], qdd: list[float]) -> Moving:
        """The frame behind the joint."""
        frame = parent.moved(np.array(self.at))
        for axis, angle in self.fixed:
            frame = frame.turned(about(np.array(axis, float), TURNS[angle]))
        place = 0
        for motion in KINDS[self.kind]:
            kind, _, along = motion.partition(" ")
            axis = MAIN[along] if along else np.array(self.axis, float) / np.linalg.norm(self.axis)
            if kind == "quaternion":
                e, rate, change = (np.array(x[place : place + 4]) for x in (q, qd, qdd))
                bent = spin(e, change) - spin(e, rate) * 2 * (e @ rate) / (e @ e)
                frame = frame.turned(attitude(e), spin(e, rate), bent)
                place += 4
                continue
            x, rate, change = (values[place] for values in (q, qd, qdd))
            if kind == "way":
                frame = frame.moved(axis * x, axis * rate, axis * change)
            else:
                frame = frame.turned(about(axis, x), axis * rate, axis * change)
            place += 1
        return frame


class Tree:
    """A random tree; with `loop` its last body is held at a point, where it stands at the start.

    `flat` chains turn about few axes, which have a plane in common: their sines meet in sums, divided by lengths.
    """

    def __init__(self, seed: int, loop: bool = False, flat: bool = False) -> None:
        self.draw = draw = random.Random(seed)
        self.joints: list[Joint] = []
        kinds = [draw.choice(("revolute", "prismatic", "cylindrical", "planar")) for _ in range(draw.randrange(1, 3))]
        kinds.insert(draw.randrange(len(kinds) + 1), draw.choice(("revolute", "revolute", "spherical", "floating")))
        if loop:
            # three rows must leave something to move
            kinds = ["revolute", draw.choice(("cylindrical", "revolute")), "revolute"]
            kinds.append(draw.choice(("revolute", "planar")))
        if flat:
            kinds = ["revolute"] * 3
        for k, kind in enumerate(kinds):
            joint = self._joint(k, kind, chained=loop or flat)
            self.joints.append(replace(joint, axis=draw.choice(AXES[:5:3] + FLAT), fixed=()) if flat else joint)
        self.names = [name for joint in self.joints for name in joint.coordinates]
        self.q = [draw.uniform(-1.2, 1.2) for _ in self.names]
        self.qd = [draw.uniform(-1, 1) for _ in self.names]
        for joint in self.joints:
            if "quaternion" in KINDS[joint.kind]:
                place = self.names.index(joint.coordinates[-4])
                e = np.array(self.q[place : place + 4])
                e /= np.linalg.norm(e)
                rate = np.array(self.qd[place : place + 4])
                self.q[place : place + 4] = e.tolist()
                self.qd[place : place + 4] = (rate - e * (e @ rate)).tolist()
        self.points = {"p": (self.joints[-1].name, self._numbers(3)), "s": (self.joints[0].name, self._numbers(3))}
        self.loop = loop
        self.u = [draw.uniform(-3, 3) for _ in range(3)]
        self.direction = draw.choice(AXES)

    def _numbers(self, count: int) -> tuple[float, ...]:
        return tuple(round(self.draw.uniform(-0.6, 0.6), 2) for _ in range(count))

    def _joint(self, k: int, kind: str, chained: bool) -> Joint:
        draw = self.draw
        count = sum(4 if motion == "quaternion" else 1 for motion in KINDS[kind])
        fixed = tuple((draw.choice(AXES), draw.choice([*TURNS])) for _ in range(draw.randrange(3)))
        diagonal = [round(draw.uniform(0.05, 0.09), 3) for _ in range(3)]
        parent = f"b{k - 1}" if chained else f"b{draw.randrange(k)}" if k else ""
        return Joint(
            name=f"b{k}",
            parent=parent if k else "world",
            kind=kind,
            axis=draw.choice(AXES),
            at=self._numbers(3) if draw.random() < 0.8 else (0.0, 0.0, 0.0),
            fixed=fixed,
            coordinates=tuple(f"q_{k}_{i}" for i in range(count)),
            mass=round(draw.uniform(0.5, 3), 2),
            com=self._numbers(3),
            inertia=(*diagonal, 0.004, -0.003, 0.006),
        )

    def text(self) -> str:
        """The model file."""
        lines = ["model: drawn", f"gravity: {[*GRAVITY]}", f"parameters: {{tilt: {TILT}}}", "joints:"]
        for j in self.joints:
            fixed = ", ".join(f"[{[*axis]}, {angle}]" for axis, angle in j.fixed)
            axis = f", axis: {[*j.axis]}" if j.kind in ("revolute", "prismatic", "cylindrical") else ""
            lines.append(
                f"  {j.name}: {{type: {j.kind}, parent: {j.parent}, at: {[*j.at]}{axis}, rotation: [{fixed}], "
                f"coordinates: [{', '.join(j.coordinates)}]}}"
            )
        lines.append("bodies:")
        for j in self.joints:
            entries = zip(("xx", "yy", "zz", "xy", "xz", "yz"), j.inertia, strict=True)
            tensor = ", ".join(f"{name}: {x}" for name, x in entries)
            lines.append(f"  {j.name}: {{mass: {j.mass}, com: {[*j.com]}, inertia: {{{tensor}}}}}")
        lines.append("points:")
        lines += [f"  {name}: {{frame: {frame}, at: {[*at]}}}" for name, (frame, at) in self.points.items()]
        last = self.joints[-1].name
        lines += ["inputs:", f"  f: {{unit: N, point: p, direction: {[*self.direction]}}}"]
        lines += [f"  n: {{unit: N*m, torque_on: {last}, direction: {[*self.direction]}, axes: {last}}}"]
        lines += [f"  k: {{joint: {self.names[0]}}}"]
        if self.loop:
            held = self.frames(self.q)[last].moved(np.array(self.points["p"][1])).place
            lines.append(f"frames: {{anchor: {{translation: {[float(x) for x in held]}}}}}")
            lines.append("loops: {hold: {type: point, between: [p, anchor]}}")
        pairs = ", ".join(f"{name}: {value}" for name, value in zip(self.names, self.q, strict=True))
        return "\n".join([*lines, f"configuration: {{{pairs}}}", f"outputs: [{', '.join(QUANTITIES)}]", ""])

    def frames(
        self, q: list[float], qd: list[float] | None = None, qdd: list[float] | None = None
    ) -> dict[str, Moving]:
        """Where everything is and how it moves."""
        zeros = [0.0] * len(q)
        by_name, place = {"world": Moving()}, 0
        for joint in self.joints:
            n = len(joint.coordinates)
            parts = [values[place : place + n] for values in (q, qd or zeros, qdd or zeros)]
            by_name[joint.name] = joint.moved(by_name[joint.parent], *parts)
            place += n
        return by_name

    def unit(self, i: int) -> list[float]:
        """A unit rate of one coordinate."""
        return [float(k == i) for k in range(len(self.names))]

    def balance(self, qd: list[float], qdd: list[float], gravity: np.ndarray) -> np.ndarray:
        """G qdd + C qd + Q."""
        total = np.zeros(len(self.names))
        moving = self.frames(self.q, qd, qdd)
        turning = [self.frames(self.q, self.unit(i)) for i in range(len(self.names))]
        for joint in self.joints:
            frame = moving[joint.name]
            xx, yy, zz, xy, xz, yz = joint.inertia
            tensor = frame.turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ frame.turn.T
            force = joint.mass * (frame.moved(np.array(joint.com)).a - gravity)
            moment = tensor @ frame.dw + np.cross(frame.w, tensor @ frame.w)
            for i, one in enumerate(turning):
                total[i] += one[joint.name].moved(np.array(joint.com)).v @ force + one[joint.name].w @ moment
        return total

    def point(self, name: str, qd: list[float] | None = None) -> Moving:
        """A point of the file."""
        frame, at = self.points[name]
        return self.frames(self.q, qd)[frame].moved(np.array(at))

    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """J and -J_dot qd of the loop and the quaternions."""
        n = len(self.names)
        jacobian, right = [], []
        if self.loop:
            jacobian += [*np.array([self.point("p", self.unit(i)).v for i in range(n)]).T]
            right += [*-self.point("p", self.qd).a]
        for joint in self.joints:
            if "quaternion" in KINDS[joint.kind]:
                place = self.names.index(joint.coordinates[-4])
                row = np.zeros(n)
                row[place : place + 4] = self.q[place : place + 4]
                jacobian.append(row)
                right.append(-sum(x * x for x in self.qd[place : place + 4]))
        return np.array(jacobian).reshape(-1, n), np.array(right)

    def expected(self) -> dict[str, np.ndarray]:
        """The quantities that have a plain meaning, C q_dot in place of C."""
        n = len(self.names)
        still, none, gravity = [0.0] * n, np.zeros(3), np.array(GRAVITY)
        rows, right = self.rows()
        if self.loop:
            self.qd = (np.array(self.qd) - np.linalg.pinv(rows) @ rows @ np.array(self.qd)).tolist()
            rows, right = self.rows()
        mass = np.array([self.balance(still, self.unit(i), none) for i in range(n)]).T
        last, direction = self.joints[-1].name, np.array(self.direction, float)
        units = [self.unit(i) for i in range(n)]
        force = [self.point("p", unit).v @ direction for unit in units]
        turn = self.frames(self.q)[last].turn
        torque = [self.frames(self.q, unit)[last].w @ turn @ direction for unit in units]
        control = np.array([force, torque, units[0]]).T
        bias = self.balance(self.qd, still, none)
        weight = self.balance(still, still, gravity)
        r = len(rows)
        matrix = np.block([[mass, rows.T], [rows, np.zeros((r, r))]])
        solved = np.linalg.solve(matrix, [*(control @ self.u - bias - weight), *right])
        jacobians = [np.array([self.point(name, unit).v for unit in units]).T for name in self.points]
        return {
            "point_position": np.array([self.point(name).place for name in self.points]).ravel(),
            "point_jacobian": np.vstack(jacobians),
            "mass_matrix": mass,
            "coriolis_matrix": bias,
            "potential_force": weight,
            "control_matrix": control,
            "nullspace_projector": np.eye(n) - np.linalg.pinv(rows) @ rows if r else np.eye(n),
            "forward_dynamics": solved[:n],
        }


def compared(tree: Tree) -> None:
    expected = tree.expected()
    model = load_text(tree.text(), "drawn.yaml")
    assert [c.name for c in model.coordinates] == tree.names
    derivations = derive_quantities(model, QUANTITIES)
    program = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"]
    assert {kernel.name for kernel in program.kernels} >= {*QUANTITIES} - {"nullspace_projector"}
    given = {"q": tree.q, "qd": tree.qd, "qdd": [0.0] * model.n, "u": tree.u}
    for kernel in program.kernels:
        status, entries = Interpreter(program.sincos).run(kernel, given, [TILT])
        assert not status, kernel.name
        value = np.array(entries).reshape(kernel.shape)
        if kernel.name == "coriolis_matrix":
            value = value @ np.array(tree.qd)
        wanted = expected[kernel.name].reshape(value.shape)
        assert value == pytest.approx(wanted, rel=1e-9, abs=1e-9 * (1 + np.abs(wanted).max())), kernel.name


def seeds(every: range, *few: int) -> list[Any]:
    """Some trees of each kind; the others are for `make mechanisms`."""
    return [pytest.param(seed, marks=() if seed in few else pytest.mark.mechanisms) for seed in every]


@pytest.mark.parametrize("seed", seeds(range(14), 1, 5, 6))
def test_trees_of_any_joints_about_any_axes(seed: int) -> None:
    compared(Tree(seed))


@pytest.mark.parametrize("seed", seeds(range(200, 212), 202, 208))
def test_chains_about_axes_in_a_plane(seed: int) -> None:
    compared(Tree(seed, flat=True))


@pytest.mark.mechanisms
@pytest.mark.parametrize("seed", seeds(range(100, 105), 103))
def test_chains_closed_at_a_point(seed: int) -> None:
    compared(Tree(seed, loop=True))
