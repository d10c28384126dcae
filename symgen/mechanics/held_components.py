"""How places and directions of frames move: with each coordinate, and while no rate changes.

A row that holds components of points or frames depends on the configuration through these.  Differentiating it sweeps
through the products of rotations in it again for each row.  A joint turns all that hangs on it about its own axis, so
that a place moves by axis x arm, a direction by axis x direction, and what axes, arms and turning frames there are is
formed once for all rows (the geometric Jacobian: Siciliano et al., Robotics, 2009, ch. 3.1; accelerations outwards:
Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 2).
"""

from __future__ import annotations

from collections.abc import Iterator

from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.model.kinematics.triples import (
    Rows,
    acceleration_field,
    applied,
    cross,
    inner,
    minus,
    plus,
    transposed,
    triple,
)
from symgen.model.mechanism import Component
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached


@dataclass(frozen=True, slots=True)
class UnitMotion:
    """What the rate of one coordinate does at one joint, in the axes of an ancestor.

    `turn` is the angular velocity of what hangs on the joint, `slide` the velocity of its origin.
    """

    coordinate: int
    turn: Vector3
    slide: Vector3


@dataclass(frozen=True, slots=True)
class Turning:
    """How a frame moves against an ancestor while no rate changes, in the axes of that: angular velocity w and
    acceleration a, velocity and acceleration of its origin, and U with U r = a x r + w x (w x r)."""

    spin: Vector3
    swing: Vector3
    velocity: Vector3
    acceleration: Vector3
    field: Rows[Scalar]


@dataclass(frozen=True, slots=True)
class Moved:
    """A vector, its rate and its acceleration."""

    value: Vector3
    rate: Vector3
    acceleration: Vector3


class HeldComponents:
    """Derivatives of components of points and frames of a mechanism."""

    def __init__(self, bodies: Bodies) -> None:
        self._bodies, self._graph, self._kinematics = bodies, bodies.graph, bodies.kinematics
        zero = self._graph.zero
        self._none: Vector3 = (zero, zero, zero)
        self._units: dict[tuple[str, str], tuple[UnitMotion, ...]] = {}
        self._turnings: dict[tuple[str, str], Turning] = {}

    def is_known(self, one: Component) -> bool:
        """Whether it is a place or a direction, of a point that stands still in its frame."""
        if one.is_rate:
            return False
        point = self._kinematics.points.get(one.owner)
        return point is None or not any(self._moves(x) for x in self._kinematics.space.values(point.at))

    def slopes(self, one: Component) -> dict[int, Scalar]:
        """The derivatives by the coordinates that it depends on."""
        by_coordinate: dict[int, Scalar] = {}
        meeting, direction, arm = self._meeting(one), self._direction(one), self._arm(one)
        turns = one.is_direction
        at = arm if turns else minus(self._place(one), self._origin(self._frame(one), one))
        # what turns the axes moves what is seen from them the other way
        for sign, frame, held in ((-1, one.axes, arm), (1, self._frame(one), at)):
            line = self._kinematics.lineage(frame)
            for name in line[: line.index(meeting)]:
                for motion in self._motions(name, meeting):
                    moved = cross(motion.turn, held)
                    slope = sign * inner(direction, moved if turns else plus(motion.slide, moved))
                    by_coordinate[motion.coordinate] = by_coordinate.get(motion.coordinate, self._graph.zero) + slope
                if not turns:
                    held = plus(held, self._offset(name, meeting))
        return by_coordinate

    def acceleration(self, one: Component) -> Scalar:
        """The second derivative by time while no rate changes, at the rates of the mechanism."""
        meeting = self._meeting(one)
        direction = self._turned(one.axes, meeting, self._direction(one))
        arm = self._turned(self._frame(one), meeting, self._arm(one)) if one.is_direction else self._apart(one)
        crossing = inner(direction.rate, arm.rate)
        return inner(direction.acceleration, arm.value) + 2 * crossing + inner(direction.value, arm.acceleration)

    # the two vectors whose product a component is ---------------------------------------------------------------------

    def _frame(self, one: Component) -> str:
        point = self._kinematics.points.get(one.owner)
        return one.owner if point is None else point.frame

    def _meeting(self, one: Component) -> str:
        return self._kinematics.meeting(self._frame(one), one.axes)

    def _direction(self, one: Component) -> Vector3:
        """The axis along which it is measured."""
        row = int(one.what[1]) - 1 if one.is_direction else one.index
        return self._column(one.axes, self._meeting(one), row)

    def _arm(self, one: Component) -> Vector3:
        """What is measured: an axis of the frame, or the place of the point from the origin of the axes."""
        if one.is_direction:
            return self._column(self._frame(one), self._meeting(one), int(one.what[2]) - 1)
        return minus(self._place(one), self._origin(one.axes, one))

    def _place(self, one: Component) -> Vector3:
        return self._kinematics.position(one.owner, self._meeting(one))

    def _origin(self, frame: str, one: Component) -> Vector3:
        meeting = self._meeting(one)
        return self._none if frame == meeting else self._kinematics.position(frame, meeting)

    def _column(self, frame: str, ancestor: str, index: int) -> Vector3:
        return transposed(self._kinematics.axes(frame, ancestor))[index]

    # by coordinates ---------------------------------------------------------------------------------------------------

    def _motions(self, name: str, ancestor: str) -> tuple[UnitMotion, ...]:
        if (name, ancestor) not in self._units:
            self._units[name, ancestor] = tuple(self._at_joint(name, ancestor))
        return self._units[name, ancestor]

    def _at_joint(self, name: str, ancestor: str) -> Iterator[UnitMotion]:
        joint, parent = self._kinematics.joint(name), self._kinematics.frames[name].parent
        rates = (*joint.turning_before, *joint.place_rate)
        used = reached(rates)
        for k, rate in enumerate(self._bodies.qd):
            if rate in used:
                unit = derivative_along(self._graph, rates, {rate: self._graph.one})
                turn, slide = (self._carried(parent, ancestor, triple(part)) for part in (unit[:3], unit[3:]))
                yield UnitMotion(k, turn, slide)

    def _offset(self, name: str, ancestor: str) -> Vector3:
        """The origin of a frame from that of its parent."""
        return self._carried(self._kinematics.frames[name].parent, ancestor, self._kinematics.joint(name).place)

    def _carried(self, frame: str, ancestor: str, vector: Vector3) -> Vector3:
        if frame == ancestor or all(x.is_zero for x in vector):
            return vector
        return applied(self._kinematics.axes(frame, ancestor), vector)

    def _moves(self, scalar: Scalar) -> bool:
        return not reached([scalar]).isdisjoint(self._bodies.q)

    # while no rate changes --------------------------------------------------------------------------------------------

    def _turned(self, frame: str, ancestor: str, vector: Vector3) -> Moved:
        """A vector that is fixed to a frame."""
        turning = self._turning(frame, ancestor)
        return Moved(vector, cross(turning.spin, vector), applied(turning.field, vector))

    def _apart(self, one: Component) -> Moved:
        """The place of a point from the origin of the axes in which it is measured."""
        meeting, frame = self._meeting(one), self._frame(one)
        here, there = self._turning(frame, meeting), self._turning(one.axes, meeting)
        arm = minus(self._place(one), self._origin(frame, one))
        return Moved(
            self._arm(one),
            minus(plus(here.velocity, cross(here.spin, arm)), there.velocity),
            minus(plus(here.acceleration, applied(here.field, arm)), there.acceleration),
        )

    def _turning(self, frame: str, ancestor: str) -> Turning:
        if (frame, ancestor) not in self._turnings:
            line = self._kinematics.lineage(frame)
            for name in reversed(line[: line.index(ancestor) + 1]):
                if (name, ancestor) not in self._turnings:
                    self._turnings[name, ancestor] = self._step(name, ancestor)
        return self._turnings[frame, ancestor]

    def _step(self, name: str, ancestor: str) -> Turning:
        none = self._none
        if name == ancestor:
            return Turning(none, none, none, none, (none, none, none))
        graph, kinematics, bodies = self._graph, self._kinematics, self._bodies
        joint, parent = kinematics.joint(name), kinematics.frames[name].parent
        above = self._turnings[parent, ancestor]
        rates = (*joint.turning_before, *joint.place_rate)
        changing = derivative_along(graph, rates, dict(zip(bodies.q, bodies.qd, strict=True)))
        vectors = [triple(part) for part in (rates[:3], changing[:3], rates[3:], changing[3:])]
        spin, swing, slide, speeding = (self._carried(parent, ancestor, vector) for vector in vectors)
        arm = self._offset(name, ancestor)
        turned, turning = plus(above.spin, spin), plus(plus(above.swing, cross(above.spin, spin)), swing)
        twice = cross(above.spin, slide)
        acceleration = plus(plus(above.acceleration, applied(above.field, arm)), plus(plus(twice, twice), speeding))
        velocity = plus(plus(above.velocity, cross(above.spin, arm)), slide)
        return Turning(turned, turning, velocity, acceleration, acceleration_field(turned, turning))

