"""Forward kinematics of a mechanism in any arithmetic: attitudes and places of frames, velocities in body axes.

Numbers `P` depend on the configuration, `V` are linear in the rates.  The graph takes scalars for both; the checks of
a model take floats and linear forms, the energy form expressions and linear forms.  The recursions are those of
Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 4 and 5, with angular and linear parts kept apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from symgen.model.expressions import combine
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import names_in
from symgen.model.kinematics.joints import Joint, joint_of, main_axis, plane_turn, turn_matrix
from symgen.model.kinematics.triples import (
    Arithmetic,
    P,
    Rates,
    Rows,
    Space,
    Triple,
    V,
    applied,
    minus,
    plus,
    product,
    transposed,
)
from symgen.model.mechanism import WORLD, ZERO, Component, Mechanism, Quaternion, Vector3


@dataclass(frozen=True)
class Twist(Generic[V]):
    """Angular velocity of a frame and velocity of its origin, against the world, in the same axes."""

    angular: Rates[V]
    linear: Rates[V]


class Kinematics(Generic[P, V]):
    """Everything about frames and points at one state; each part is worked out once, when it is first asked for."""

    def __init__(self, mechanism: Mechanism, arithmetic: Arithmetic[P, V], sums_of_angles: bool = True) -> None:
        self.mechanism, self.space = mechanism, Space(arithmetic)
        # frames in a plane are turned by sums of angles, which symbols profit from and numbers do not
        self._sums_of_angles = sums_of_angles
        self.frames = {frame.name: frame for frame in mechanism.frames}
        self.points = {point.name: point for point in mechanism.points}
        self._lines: dict[str, list[str]] = {WORLD: [WORLD]}
        self._joints: dict[str, Joint[P, V]] = {}
        self._axes: dict[tuple[str, str], Rows[P]] = {}
        self._places: dict[tuple[str, str], Triple[P]] = {}
        self._planes: dict[tuple[str, str], tuple[Vector3 | None, Expression] | None] = {}
        self._twists: dict[tuple[str, str], Twist[V]] = {(WORLD, WORLD): Twist(self.space.still, self.space.still)}

    # frames -----------------------------------------------------------------------------------------------------------

    def lineage(self, frame: str) -> list[str]:
        """The frame, its parent, and so on to the world."""
        if frame not in self._lines:
            line = [frame]
            while line[-1] != WORLD:
                line.append(self.frames[line[-1]].parent)
            self._lines[frame] = line
        return self._lines[frame]

    def plane(self, ancestor: str, frame: str) -> tuple[Vector3 | None, Expression] | None:
        """Axis and angle of a frame against an ancestor, where all turns between share one main axis."""
        line = self.lineage(frame)
        for name in reversed(line[: line.index(ancestor) + 1]):
            if (ancestor, name) not in self._planes:
                self._planes[ancestor, name] = self._turn_below(ancestor, name)
        return self._planes[ancestor, frame]

    def _turn_below(self, ancestor: str, name: str) -> tuple[Vector3 | None, Expression] | None:
        if name == ancestor:
            return None, ZERO
        above, own = self._planes[ancestor, self.frames[name].parent], plane_turn(self.frames[name])
        if above is None or own is None:
            return None
        if above[0] is None or own[0] is None:
            return above[0] or own[0], combine.plus(above[1], own[1])
        same = main_axis(above[0]) == main_axis(own[0])
        return (above[0], combine.plus(above[1], own[1])) if same else None

    def joint(self, name: str) -> Joint[P, V]:
        """The frame against its parent."""
        if name not in self._joints:
            self._joints[name] = joint_of(self.space, self.frames[name])
        return self._joints[name]

    def axes(self, frame: str, seen_from: str = WORLD) -> Rows[P]:
        """The matrix that turns components in the frame's axes into components in those of another frame."""
        meeting = self.meeting(frame, seen_from)
        down = self._below(meeting, frame)[0]
        return down if meeting == seen_from else product(transposed(self._below(meeting, seen_from)[0]), down)

    def place(self, frame: str, at: Triple[P], seen_from: str = WORLD) -> Triple[P]:
        """A place given in the frame, from the origin and in the axes of another."""
        meeting = self.meeting(frame, seen_from)
        still = self._last_fixed_turn(meeting, frame)
        if still not in (None, frame):
            # what is added up beyond a fixed turn is turned once
            at, frame = self.place(frame, at, still), still
        axes, origin = self._below(meeting, frame)
        position = plus(origin, applied(axes, at))
        if meeting == seen_from:
            return position
        axes, origin = self._below(meeting, seen_from)
        return applied(transposed(axes), minus(position, origin))

    def origin(self, frame: str) -> Triple[P]:
        """The origin of a frame from that of the world."""
        return self._below(WORLD, frame)[1]

    def twist(self, frame: str, axes: str | None = None) -> Twist[V]:
        """Velocities of a frame in its own axes, or in those of a frame that it descends from."""
        axes = frame if axes is None else axes
        for name in reversed(self.lineage(frame)):
            if (name, name) not in self._twists:
                self._twists[name, name] = self._own_twist(name)
        if (frame, axes) not in self._twists:
            self._twists[frame, axes] = self._carried_twist(frame, axes)
        return self._twists[frame, axes]

    # points -----------------------------------------------------------------------------------------------------------

    def position(self, owner: str, axes: str = WORLD) -> Triple[P]:
        """Place of a point or of a frame's origin, from the origin and in the axes of some frame."""
        frame, at, _ = self._located(owner)
        return self.place(frame, at, axes)

    def velocity(self, owner: str, axes: str = WORLD) -> Rates[V]:
        """Velocity of the material point, in some frame's axes."""
        frame, at, carrier = self._located(owner)
        held = frame if frame in self.lineage(carrier) else carrier
        twist = self.twist(carrier, held)
        arm = self.place(frame, at, held)
        if carrier != held:
            arm = minus(arm, self.place(carrier, self.space.origin, held))
        here = self.space.summed(twist.linear, self.space.crossed(twist.angular, arm))
        return self.space.turned(self.axes(held, axes), here)

    def position_rate(self, owner: str, axes: str = WORLD) -> Rates[V]:
        """Time derivative of the components of a position, wherever the material point may go."""
        space = self.space
        frame, at, _ = self._located(owner)
        if axes != WORLD:
            return self._rate_seen_from(axes, owner)
        twist = self.twist(frame)
        here = space.summed(twist.linear, space.crossed(twist.angular, at))
        if owner in self.points:
            here = space.summed(here, space.rates(self.points[owner].at))
        return space.turned(self.axes(frame), here)

    def angular_velocity(self, frame: str, axes: str = WORLD) -> Rates[V]:
        """Angular velocity of a frame in the axes of another."""
        if axes in self.lineage(frame):
            return self.twist(frame, axes).angular
        return self.space.turned(self.axes(frame, axes), self.twist(frame).angular)

    def axes_rate(self, frame: str, axes: str) -> tuple[Rates[V], Rates[V], Rates[V]]:
        """Time derivative of the matrix `axes(frame, axes)`: its columns turn with the relative angular velocity."""
        relative = self.space.reduced(self.angular_velocity(frame, axes), self.twist(axes).angular)
        columns = [self.space.crossed(relative, column) for column in transposed(self.axes(frame, axes))]
        first, second, third = ((columns[0][i], columns[1][i], columns[2][i]) for i in range(3))
        return first, second, third

    def component(self, one: Component) -> P:
        """The value of a component that is no rate."""
        if one.is_direction:
            return self.axes(one.owner, one.axes)[int(one.what[1]) - 1][int(one.what[2]) - 1]
        return self.position(one.owner, one.axes)[one.index]

    def component_rate(self, one: Component) -> V:
        """The value of a component that is a rate; the time derivative of one that is none."""
        if one.is_direction:
            return self.axes_rate(one.owner, one.axes)[int(one.what[1]) - 1][int(one.what[2]) - 1]
        if one.what.startswith("w"):
            return self.angular_velocity(one.owner, one.axes)[one.index]
        rates = self.velocity if one.is_rate else self.position_rate
        return rates(one.owner, one.axes)[one.index]

    # the parts --------------------------------------------------------------------------------------------------------

    def _rate_seen_from(self, axes: str, owner: str) -> Rates[V]:
        """As `position_rate`, from the joints in between alone: what carries both does not enter."""
        space, meeting = self.space, self.meeting(self._located(owner)[0], axes)
        rates, _ = self._motion_below(meeting, owner)
        if meeting == axes:
            return rates
        carried, turning = self._motion_below(meeting, axes)
        apart = minus(self.position(owner, meeting), self.position(axes, meeting))
        rates = space.reduced(space.reduced(rates, carried), space.crossed(turning, apart))
        return space.turned(transposed(self.axes(axes, meeting)), rates)

    def _motion_below(self, ancestor: str, owner: str) -> tuple[Rates[V], Rates[V]]:
        """Velocity and turning rate against an ancestor, in its axes: each joint turns what hangs on it."""
        space = self.space
        frame, at, _ = self._located(owner)
        position, turning = self.place(frame, at, ancestor), space.still
        total = space.still
        if owner in self.points:
            total = space.turned(self.axes(frame, ancestor), space.rates(self.points[owner].at))
        line = self.lineage(frame)
        for name in line[: line.index(ancestor)]:
            joint, matrix = self.joint(name), self._below(ancestor, self.frames[name].parent)[0]
            own = space.turned(matrix, joint.turning_before)
            arm = minus(position, self._below(ancestor, name)[1])
            total = space.summed(total, space.summed(space.turned(matrix, joint.place_rate), space.crossed(own, arm)))
            turning = space.summed(turning, own)
        return total, turning

    def meeting(self, one: str, other: str) -> str:
        """The nearest frame that both descend from."""
        if other == WORLD:
            return WORLD
        line = set(self.lineage(one))
        return next(frame for frame in self.lineage(other) if frame in line)

    def _last_fixed_turn(self, ancestor: str, frame: str) -> str | None:
        """The last frame on the way that is turned against the ancestor by fixed angles only; in a plane angles add."""
        last = None
        if self._sums_of_angles and self.plane(ancestor, frame) is not None:
            return None
        line = self.lineage(frame)
        for name in reversed(line[: line.index(ancestor)]):
            turns = self.frames[name].rotation
            if isinstance(turns, Quaternion) or any(list(names_in(turn.angle)) for turn in turns):
                break
            last = name if turns or last else None
        return last

    def _located(self, owner: str) -> tuple[str, Triple[P], str]:
        """Frame, place in it, and carrier of a point or of a frame's origin."""
        if owner in self.points:
            point = self.points[owner]
            return point.frame, self.space.values(point.at), point.carrier
        return owner, self.space.origin, owner

    def _below(self, ancestor: str, frame: str) -> tuple[Rows[P], Triple[P]]:
        """Axes and origin of a frame, seen from one that it descends from."""
        if (ancestor, frame) not in self._axes:
            line = self.lineage(frame)
            for name in reversed(line[: line.index(ancestor) + 1]):
                if (ancestor, name) not in self._axes:
                    axes, place = self._step_below(ancestor, name)
                    self._axes[ancestor, name], self._places[ancestor, name] = axes, place
        return self._axes[ancestor, frame], self._places[ancestor, frame]

    def _step_below(self, ancestor: str, name: str) -> tuple[Rows[P], Triple[P]]:
        if name == ancestor:
            return self.space.identity, self.space.origin
        parent, joint = self.frames[name].parent, self.joint(name)
        axes, place = self._axes[ancestor, parent], self._places[ancestor, parent]
        if axes is self.space.identity:
            return joint.axes, plus(place, joint.place)
        place = plus(place, applied(axes, joint.place))
        if joint.axes is self.space.identity:
            return axes, place
        plane = self.plane(ancestor, name) if self._sums_of_angles else None
        if plane is not None and plane[0] is not None:
            turned = turn_matrix(self.space, plane[1], plane[0])
            return self.space.named(f"{name}.axes_{ancestor}", turned), place
        return self.space.named(f"{name}.axes_{ancestor}", product(axes, joint.axes)), place

    def _own_twist(self, name: str) -> Twist[V]:
        """The parent's twist moved to the frame's origin and turned into its axes, plus the joint's own."""
        space, joint = self.space, self.joint(name)
        parent = self._twists[self.frames[name].parent, self.frames[name].parent]
        carried = space.summed(parent.linear, space.crossed(parent.angular, joint.place))
        carried = space.summed(carried, joint.place_rate)
        if joint.axes is space.identity:
            return Twist(parent.angular, carried)
        inward = transposed(joint.axes)
        return Twist(space.summed(space.turned(inward, parent.angular), joint.turning), space.turned(inward, carried))

    def _carried_twist(self, frame: str, axes: str) -> Twist[V]:
        """The same, but kept in the axes of an ancestor, so that the turns in between do not enter."""
        space, line = self.space, self.lineage(frame)
        twist = self._twists[axes, axes]
        for name in reversed(line[: line.index(axes)]):
            joint, matrix = self.joint(name), self._below(axes, self.frames[name].parent)[0]
            linear = space.summed(twist.linear, space.crossed(twist.angular, applied(matrix, joint.place)))
            linear = space.summed(linear, space.turned(matrix, joint.place_rate))
            twist = Twist(space.summed(twist.angular, space.turned(matrix, joint.turning_before)), linear)
        return twist
