"""A model file to nodes of the witness: energies, rows, inputs and forces, by the zoo's own small reader."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.numbers.fields import Floats
from symgen.laboratory.zoo.witness.numbers.tape import Node, NodeTape
from symgen.laboratory.zoo.witness.reading.expressions import NotReadError, read_expression
from symgen.laboratory.zoo.witness.reading.frames import (
    FramePoses,
    Matrix,
    Relative,
    Vector,
    cross,
    dot,
    joint_coordinates,
    minus,
    plus,
    read_frames,
    read_vector,
    scaled,
    transposed,
    turned,
)

# configurations at which an identity is looked at, and what rounding leaves of it
TRIES, ROUNDING = 4, 1e-12
PLACES = {"x": 0, "y": 1, "z": 2}
VELOCITIES = {"vx": 0, "vy": 1, "vz": 2}
TURNING = {"wx": 0, "wy": 1, "wz": 2}


@dataclass(frozen=True)
class ConstraintEquation:
    """A constraint: `value` is zero, or its coefficients of the rates are."""

    name: str
    geometric: bool
    value: Node


@dataclass
class SystemReader:
    """What a file says, before any mechanics: everything by name, worked out as it is asked for."""

    blocks: Mapping[str, Any]
    tape: NodeTape = field(default_factory=NodeTape)
    _definitions: dict[str, Node] = field(default_factory=dict)
    _places: dict[str, Vector] = field(default_factory=dict)

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of q in the order of the file: declared ones first, then those of the joints."""
        declared = dict.fromkeys(self.blocks.get("coordinates") or {})
        for entry in (self.blocks.get("joints") or {}).values():
            declared |= dict.fromkeys(joint_coordinates(entry))
        return tuple(declared)

    @cached_property
    def parameters(self) -> dict[str, Node]:
        """Values of the parameters as expressions of earlier parameters."""
        by_name: dict[str, Node] = {}
        for name, entry in (self.blocks.get("parameters") or {}).items():
            text = entry["value"] if isinstance(entry, Mapping) else entry
            by_name[name] = read_expression(self.tape, str(text), by_name.__getitem__)
        return by_name

    @cached_property
    def inputs(self) -> tuple[str, ...]:
        """Names of u."""
        return tuple(self.blocks.get("inputs") or {})

    @cached_property
    def frames(self) -> FramePoses:
        """Poses of the frames."""
        relative: dict[str, Relative] = read_frames(self.tape, self.blocks, self.read)
        return FramePoses(self.tape, relative, self.rate)

    def rate(self, node: Node) -> Node:
        """The derivative along the motion, without what accelerations add."""
        return self.tape.derivative(node, self._seeds, "rate")

    @cached_property
    def _seeds(self) -> dict[str, Node]:
        return {name: self.tape.symbol(f"{name}_dot") for name in self.coordinates}

    @cached_property
    def rate_names(self) -> tuple[str, ...]:
        """Names of the rates."""
        return tuple(f"{name}_dot" for name in self.coordinates)

    def read(self, text: str) -> Node:
        """Any expression of the file."""
        return read_expression(self.tape, str(text), self.lookup)

    def lookup(self, name: str) -> Node:
        """The node of a name."""
        if "." in name:
            owner, what = name.split(".")
            return self._component(owner, what)
        if name in self._known:
            return self.tape.symbol(name)
        if name not in self._definitions:
            self._definitions[name] = self.read((self.blocks.get("definitions") or {})[name])
        return self._definitions[name]

    @cached_property
    def _known(self) -> frozenset[str]:
        return frozenset((*self.coordinates, *self.rate_names, *self.parameters))

    def _component(self, owner: str, what: str) -> Node:
        if what in PLACES:
            return self.place(owner)[PLACES[what]]
        if what in VELOCITIES:
            return self.velocity(owner)[VELOCITIES[what]]
        if what in TURNING:
            return self.frames.pose(owner).turning[TURNING[what]]
        raise NotReadError(f"the component {owner}.{what}")

    @property
    def _points(self) -> Mapping[str, Any]:
        return self.blocks.get("points") or {}

    def place(self, owner: str) -> Vector:
        """A point, or the origin of a frame, in the world."""
        if owner not in self._points:
            return self.frames.pose(owner).origin
        if owner not in self._places:
            entry = self._points[owner]
            at = read_vector(self.tape, entry.get("at"), self.read)
            self._places[owner] = self.frames.place(entry.get("frame", "world"), at)
        return self._places[owner]

    def _frame(self, owner: str) -> str:
        """The frame that a point stands in; a frame itself."""
        return self._points[owner].get("frame", "world") if owner in self._points else owner

    def velocity(self, owner: str) -> Vector:
        """Of the material point that is there, or of the origin of a frame."""
        if owner not in self._points:
            return self.frames.rates(self.frames.pose(owner).origin)
        entry = self._points[owner]
        carrier = self.frames.pose(entry.get("moves_with", entry.get("frame", "world")))
        arm = minus(self.place(owner), carrier.origin)
        return plus(self.frames.rates(carrier.origin), cross(carrier.turning, arm))

    def power(self, entry: Mapping[str, Any]) -> Node:
        """The rate that a unit force of an input or a force element works on."""
        if "acts_on" in entry:
            return self.tape.sum(
                self.read(value) * self.tape.symbol(f"{name}_dot") for name, value in entry["acts_on"].items()
            )
        if "joint" in entry:
            return self.tape.symbol(f"{entry['joint']}_dot")
        if "cable" in entry:
            return -self.tape.sum(
                self._stretch(one, other)[1] for one, other in zip(entry["cable"], entry["cable"][1:], strict=False)
            )
        direction = read_vector(self.tape, entry["direction"], self.read)
        axes = entry.get("axes", "world")
        direction = turned(self.frames.pose(axes).axes, direction)
        torque = "torque_on" in entry
        owner = entry["torque_on"] if torque else entry["point"]
        rate = dot(direction, self._moving(owner, torque))
        reaction = entry.get("reaction", "world")
        return rate if reaction == "world" else rate - dot(direction, self._moving(reaction, torque))

    def _moving(self, owner: str, torque: bool) -> Vector:
        return self.frames.pose(owner).turning if torque else self.velocity(owner)

    def _stretch(self, one: str, other: str) -> tuple[Node, Node]:
        """The distance of two points and its rate."""
        apart = minus(self.place(other), self.place(one))
        length = self.tape.call("sqrt", dot(apart, apart))
        return length, dot(apart, minus(self.velocity(other), self.velocity(one))) / length

    @cached_property
    def rows(self) -> tuple[ConstraintEquation, ...]:
        """All constraints: those of the file, joints, loops, wheels; of wheels none that always hold."""
        given = self.blocks.get("constraints") or {}
        geometric, nonholonomic = given.get("geometric") or {}, given.get("nonholonomic") or {}
        all_rows = [ConstraintEquation(name, True, self.read(text)) for name, text in geometric.items()]
        for name, entry in (self.blocks.get("loops") or {}).items():
            all_rows += self._loop(name, entry)
        all_rows += self._norms()
        wheels = [row for name, entry in (self.blocks.get("rolling") or {}).items() for row in self._wheel(name, entry)]
        wheels = [row for row in wheels if row.value.number != 0]
        all_rows += [row for row in wheels if row.geometric]
        all_rows += [ConstraintEquation(name, False, self.read(text)) for name, text in nonholonomic.items()]
        all_rows += [row for row in wheels if not row.geometric]
        return tuple(all_rows)

    def _norms(self) -> list[ConstraintEquation]:
        norms = []
        for name, entry in (self.blocks.get("joints") or {}).items():
            if entry["type"] in ("spherical", "floating"):
                parts = [self.read(part) for part in joint_coordinates(entry)[-4:]]
                value = self.tape.sum(part * part for part in parts) - self.tape.one
                norms.append(ConstraintEquation(f"{name}_norm", True, value))
        return norms

    def _loop(self, name: str, entry: Mapping[str, Any]) -> list[ConstraintEquation]:
        kind = entry["type"]
        one, other = entry["between"]
        apart = minus(self.place(one), self.place(other))
        if kind == "distance":
            length = self.read(entry["length"])
            return [ConstraintEquation(f"{name}_length", True, dot(apart, apart) - length * length)]
        carrier = transposed(self.frames.pose(self.frames.meeting(self._frame(one), self._frame(other))).axes)
        if kind in ("point", "spherical"):
            held = turned(carrier, apart)
            return [ConstraintEquation(f"{name}_{axis}", True, held[index]) for axis, index in PLACES.items()]
        axis = PLACES[entry.get("axis", "z")]
        across = [index for index in range(3) if index != axis]
        here, there = transposed(self.frames.pose(one).axes), transposed(self.frames.pose(other).axes)
        along, beside, tilted, turn = {
            "revolute": (True, True, True, False),
            "prismatic": (False, True, True, True),
            "cylindrical": (False, True, True, False),
            "planar": (True, False, True, False),
            "fixed": (True, True, True, True),
        }[kind]
        held = turned(carrier if along and beside else there, apart)
        rows = [
            ConstraintEquation(f"{name}_{letter}", True, held[index])
            for letter, index in PLACES.items()
            if (beside if index in across else along)
        ]
        letters = "xyz"
        if tilted:
            rows += [ConstraintEquation(f"{name}_tilt_{letters[k]}", True, dot(there[k], here[axis])) for k in across]
        if turn:
            rows.append(ConstraintEquation(f"{name}_turn", True, dot(there[across[0]], here[across[1]])))
        return rows

    def _wheel(self, name: str, entry: Mapping[str, Any]) -> list[ConstraintEquation]:
        """No slip at the lowest point of the wheel, and its height.

        In the axes of the frame that carries the wheel where that stays upright and the axle level, else of the world.
        """
        tape = self.tape
        pose = self.frames.pose(entry["frame"])
        radius = self.read(entry["radius"])
        axle = transposed(pose.axes)[PLACES[entry.get("axle", "y")]]
        up: Vector = (tape.zero, tape.zero, tape.one)
        down = minus(scaled(axle[2], axle), up)
        side = tape.call("sqrt", tape.one - axle[2] * axle[2])
        arm = scaled(radius / side, down)
        slip = plus(self.frames.rates(pose.origin), cross(pose.turning, arm))
        carrier = transposed(self.frames.pose(self.frames.carrier(entry["frame"])).axes)
        if self._vanishes(axle[2]) and self._vanishes(carrier[2][2] - tape.one):
            slip = turned(carrier, slip)
        height = pose.origin[2] - radius * side
        rows = [] if self._still(height) else [ConstraintEquation(f"{name}_height", True, height)]
        return [
            *rows,
            ConstraintEquation(f"{name}_along", False, slip[0]),
            ConstraintEquation(f"{name}_across", False, slip[1]),
        ]

    def _still(self, node: Node) -> bool:
        """Whether a value is the same in every configuration."""
        return all(self._vanishes(part) for part in self.tape.gradient(node, self.coordinates))

    def _vanishes(self, node: Node) -> bool:
        """Whether a value is 0 in every configuration: at a few, to rounding."""
        for seed in range(TRIES):
            values = {name: Dice(seed, name).uniform(0.3, 1.2) for name in (*self.coordinates, *self.parameters)}
            if abs(self.tape.evaluate([node], values, Floats())[0]) > ROUNDING:
                return False
        return True

    @cached_property
    def kinetic_energy(self) -> Node:
        """T of the block and of the rotors; bodies are apart."""
        total = self.read(self.blocks["kinetic_energy"]) if "kinetic_energy" in self.blocks else self.tape.zero
        half = self.tape.one / self.tape.number(2)
        for name, text in (self.blocks.get("rotor_inertias") or {}).items():
            rate = self.tape.symbol(f"{name}_dot")
            total = total + half * self.read(text) * rate * rate
        return total

    @cached_property
    def potential_energy(self) -> Node:
        """U of the block, gravity and springs."""
        total = self.read(self.blocks["potential_energy"]) if "potential_energy" in self.blocks else self.tape.zero
        half = self.tape.one / self.tape.number(2)
        gravity = read_vector(self.tape, self.blocks.get("gravity"), self.read)
        for body in self.bodies:
            total = total - body.mass * dot(gravity, body.centre)
        for entry in (self.blocks.get("springs") or {}).values():
            stretch = self._spring(entry)[0] - self.read(entry.get("length", "0"))
            total = total + half * self.read(entry["stiffness"]) * stretch * stretch
        return total

    def _spring(self, entry: Mapping[str, Any]) -> tuple[Node, Node]:
        if "joint" in entry:
            return self.tape.symbol(entry["joint"]), self.tape.symbol(f"{entry['joint']}_dot")
        return self._stretch(*entry["between"])

    @cached_property
    def bodies(self) -> tuple[RigidBody, ...]:
        """Masses and tensors in the world."""
        rigid_bodies = []
        for name, given in (self.blocks.get("bodies") or {}).items():
            entry = given or {}
            frame = entry.get("frame", name)
            tensor = {key: self.read(text) for key, text in (entry.get("inertia") or {}).items()}
            xx, yy, zz, xy, xz, yz = (tensor.get(key, self.tape.zero) for key in ("xx", "yy", "zz", "xy", "xz", "yz"))
            centre = self.frames.place(frame, read_vector(self.tape, entry.get("com"), self.read))
            mass = self.read(entry["mass"]) if "mass" in entry else self.tape.zero
            rigid_bodies.append(RigidBody(frame, mass, centre, ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))))
        return tuple(rigid_bodies)

    @cached_property
    def applied(self) -> tuple[tuple[Node, Node], ...]:
        """Magnitudes and the rates they work on: Q_a is the sum of magnitude times the gradient of the rate."""
        terms = []
        for name, text in (self.blocks.get("applied_forces") or {}).items():
            terms.append((self.read(text), self.tape.symbol(f"{name}_dot")))
        for entry in (self.blocks.get("springs") or {}).values():
            if "damping" in entry:
                rate = self._spring(entry)[1]
                terms.append((-(self.read(entry["damping"]) * rate), rate))
        for name, entry in (self.blocks.get("friction") or {}).items():
            rate = self.tape.symbol(f"{name}_dot")
            force = -(self.read(entry.get("viscous", "0")) * rate)
            if "coulomb" in entry:
                slope = self.tape.call("tanh", rate / self.read(entry["width"]))
                force = force - self.read(entry["coulomb"]) * slope
            terms.append((force, rate))
        for entry in (self.blocks.get("forces") or {}).values():
            terms.append((self.read(entry["magnitude"]), self.power(entry)))
        return tuple(terms)


@dataclass(frozen=True)
class RigidBody:
    """A body: its frame, mass, centre in the world, tensor about the centre in the axes of the frame."""

    frame: str
    mass: Node
    centre: Vector
    tensor: Matrix
