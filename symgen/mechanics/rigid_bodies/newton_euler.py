"""Generalized forces of the bodies by Newton and Euler's equations, frame by frame in body axes.

Outwards: angular velocity, angular acceleration and acceleration of each origin.  Inwards: the force and moment every
frame passes to its parent.  A frame's coordinates get the power of that wrench on their own relative motion; no energy
is formed or differentiated (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 5.3; Luh, Walker, Paul 1980).

Lumped (lumps.py), the bodies of a frame are one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.mechanics.rigid_bodies.lumps import Lump, lumped_bodies
from symgen.mechanics.rigid_bodies.quaternion_joints import quaternion_parts, turning_rate
from symgen.model.kinematics.triples import Rows, acceleration_field, applied, cross, inner, plus, transposed, triple
from symgen.model.mechanism import WORLD, Body, Frame
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True)
class FrameMotion:
    """Angular velocity and acceleration of a frame and the acceleration of its origin, in its axes.

    `field` is the matrix U with U r = w' x r + w x (w x r): what its points are accelerated by beside their origin.
    """

    velocity: Vector3
    acceleration: Vector3
    linear: Vector3
    field: Rows[Scalar]


@dataclass(frozen=True)
class Wrench:
    """Force and moment about a frame's origin, in its axes."""

    force: Vector3
    moment: Vector3


@dataclass(frozen=True)
class JointMotions:
    """What rates do joint by joint while no rate changes, by frame.

    `added` is how a frame moves whose parent is not accelerated, `turning` how it moves if it is not either: by its
    angular velocity alone.  What stands on the world is accelerated against gravity.
    """

    added: Mapping[str, FrameMotion]
    turning: Mapping[str, FrameMotion]
    wrenches: Mapping[str, Wrench]  # what turning so takes of the bodies


def newton_euler(
    bodies: Bodies,
    qd: Vector,
    qdd: Vector,
    gravity: Vector3,
    lumped: bool,
    twists: Mapping[str, Sequence[int]] = MappingProxyType({}),
) -> Vector:
    """d/dt dT/dq_dot - dT/dq + dU/dq of all bodies and rotors for the accelerations `qdd`.

    `qd` is the symbols of the rates, or zeros for a mechanism at rest; `gravity` may be zero to leave out weights.
    `lumped` tells whether parameters are regrouped first: cheaper where frames share parameters.
    The frames of `twists` hand nothing on: force and moment about their origin, in their axes, stand in six places of
    the result.
    """
    return _Recursion(bodies, qd, qdd, gravity).forces(lumped, twists)


def inertial_wrenches(bodies: Bodies, qd: Vector, qdd: Vector, gravity: Vector3) -> dict[str, Wrench]:
    """What moving its own bodies so takes of each frame, and nothing of rotors; arguments as for `newton_euler`."""
    recursion = _Recursion(bodies, qd, qdd, gravity)
    return recursion.wrenches(recursion.moving(), recursion.motions)


def frame_motions(
    bodies: Bodies, qd: Vector, qdd: Vector, gravity: Vector3, further: Iterable[str] = ()
) -> dict[str, FrameMotion]:
    """How the frames that carry bodies move, and `further` ones; gravity is taken off their accelerations.

    Arguments as for `newton_euler`.
    """
    recursion = _Recursion(bodies, qd, qdd, gravity)
    recursion.moving(further)
    return recursion.motions


def joint_motions(bodies: Bodies, qd: Vector, gravity: Vector3) -> JointMotions:
    """What rates do joint by joint; arguments as for `newton_euler`."""
    recursion = _Recursion(bodies, qd, (bodies.graph.zero,) * len(qd), gravity)
    added: dict[str, FrameMotion] = {}
    frames = bodies.mechanism.frames
    for frame in frames:
        moved = added[frame.name] = recursion.step(frame.name)
        turning = acceleration_field(moved.velocity, recursion.none)
        recursion.motions[frame.name] = FrameMotion(moved.velocity, recursion.none, recursion.none, turning)
    return JointMotions(added, recursion.motions, recursion.wrenches(frames, recursion.motions))


class _Recursion:
    def __init__(self, bodies: Bodies, qd: Vector, qdd: Vector, gravity: Vector3) -> None:
        self.bodies, self.graph, self.kinematics = bodies, bodies.graph, bodies.kinematics
        self.at_rest = all(rate.is_zero for rate in qd)
        # relative velocities are linear in the rates: at rest their derivatives have terms in q_ddot alone
        motion = {} if self.at_rest else dict(zip(bodies.q, bodies.qd, strict=True))
        self.direction = {**motion, **dict(zip(bodies.qd, qdd, strict=True))}
        self.moves = not (self.at_rest and all(rate.is_zero for rate in qdd))
        zero = self.graph.zero
        self.none: Vector3 = (zero, zero, zero)
        self.motions = {WORLD: FrameMotion(self.none, self.none, _negative(gravity), (self.none, self.none, self.none))}

    def forces(self, lumped: bool, twists: Mapping[str, Sequence[int]]) -> Vector:
        """One generalized force for each coordinate."""
        frames = self.moving()
        rotors = list(self.bodies.mechanism.rotor_inertias)
        working = {f.name: self.motions[f.name] if f.name in twists else self._working(f.name) for f in frames}
        if lumped:
            lumps, rotors = lumped_bodies(self.bodies, [frame.name for frame in frames])
            wrenches = {name: self._inertial_about_origin(lump, working[name]) for name, lump in lumps.items()}
        else:
            wrenches = self.wrenches(frames, working, twists)
        totals = [self.graph.zero] * len(self.bodies.q)
        for frame in reversed(frames):
            wrench, joint = wrenches[frame.name], self.kinematics.joint(frame.name)
            carried = applied(joint.axes, wrench.force)
            absolute = self.kinematics.twist(frame.name).angular
            # a moment that works on the frame's own rate alone need not be handed to the parent and taken off again
            handed = self._terms(absolute) >= self._terms(joint.turning)
            if frame.name in twists:
                for j, load in zip(twists[frame.name], (*wrench.force, *wrench.moment), strict=True):
                    totals[j] = totals[j] + load
                continue
            self._work(totals, joint.turning if handed else absolute, wrench.moment)
            self._work(totals, joint.place_rate, carried)
            if frame.parent != WORLD:
                moment = self._cross(joint.place, carried)
                moment = plus(applied(joint.axes, wrench.moment), moment) if handed else moment
                wrenches[frame.parent] = _sum(wrenches[frame.parent], Wrench(carried, moment))
        for rotor in rotors:
            rate = self.bodies.names[f"{rotor.coordinate}_dot"]
            acceleration = derivative_along(self.graph, [rate], self.direction)[0]
            torque = self.bodies.scalars.value(rotor.inertia) * acceleration
            self._work(totals, (rate,), (torque,))
        return tuple(totals)

    def moving(self, further: Iterable[str] = ()) -> list[Frame]:
        """The frames that carry bodies and `further` ones, from the root outwards, their motions known from here on."""
        loaded = self._loaded(further)
        frames = [frame for frame in self.bodies.mechanism.frames if frame.name in loaded]
        for frame in frames:
            self.motions[frame.name] = self.step(frame.name)
        return frames

    def wrenches(
        self, frames: Sequence[Frame], motions: Mapping[str, FrameMotion], keeping: Collection[str] | None = None
    ) -> dict[str, Wrench]:
        """What the bodies of each frame take, about its origin.

        But for frames that are `keeping` theirs, if these are told, the force on a mass that stands still on a frame
        further in is that frame's from the start.  Turned into the axes of a wheel and back, a weight would leave a
        rounding of itself, which is all there is where the wheel hardly moves.
        """
        by_frame = {frame.name: Wrench(self.none, self.none) for frame in frames}
        for body in self.bodies.mechanism.bodies:
            if body.frame == WORLD:
                continue
            name, com = (body.frame, None) if keeping is None else self._carrier(body, keeping)
            if com is None or name == body.frame:
                by_frame[name] = _sum(by_frame[name], self._inertial(body, motions[name]))
                continue
            turning = turning_moment(self.bodies.inertia(body.name), motions[body.frame])
            by_frame[body.frame] = _sum(by_frame[body.frame], Wrench(self.none, turning))
            if name != WORLD:
                mass = self.bodies.scalars.value(body.mass)
                by_frame[name] = _sum(by_frame[name], self._on_point(name, mass, com, motions[name]))
        return by_frame

    def _carrier(self, body: Body, keeping: Collection[str]) -> tuple[str, Vector3]:
        """The innermost frame on which the centre of mass stands still, and where: balanced wheels stand on their axle.

        A frame that hands nothing on keeps what it has.
        """
        name, com = body.frame, self.kinematics.space.values(body.com)
        while name != WORLD and name not in keeping:
            joint = self.kinematics.joint(name)
            if not all(rate.is_zero for rate in (*joint.place_rate, *cross(joint.turning, com))):
                break
            name, com = self.kinematics.frames[name].parent, plus(joint.place, applied(joint.axes, com))
        return name, com

    def _loaded(self, further: Iterable[str]) -> set[str]:
        """Frames that carry bodies or are `further` ones, by themselves or further out."""
        loaded: set[str] = set()
        for name in (*(body.frame for body in self.bodies.mechanism.bodies), *further):
            loaded.update(self.kinematics.lineage(name))
        return loaded

    def step(self, name: str) -> FrameMotion:
        """The parent's motion carried to the frame's origin, the joint's own added."""
        joint, parent = self.kinematics.joint(name), self.motions[self.kinematics.frames[name].parent]
        inward = transposed(joint.axes)
        linear = plus(parent.linear, applied(parent.field, joint.place))
        if self.moves:
            linear = plus(linear, self._rates(joint.place_rate))
        acceleration = applied(inward, parent.acceleration)
        if self.moves:
            acceleration = plus(acceleration, self._turning_rate(name))
        if self.at_rest:
            field = acceleration_field(self.none, acceleration)
            return FrameMotion(self.none, acceleration, applied(inward, linear), field)
        linear = plus(linear, self._cross(parent.velocity, plus(joint.place_rate, joint.place_rate)))
        velocity = self.kinematics.twist(name).angular
        axis = self._shared_axis(name)
        if axis is None:
            acceleration = plus(acceleration, self._cross(applied(inward, parent.velocity), joint.turning))
        else:
            acceleration = _about_shared_axis(velocity, acceleration, axis[0], applied(inward, axis[1]))
        return FrameMotion(velocity, acceleration, applied(inward, linear), acceleration_field(velocity, acceleration))

    def _shared_axis(self, name: str) -> tuple[int, Vector3] | None:
        """The main axis k a frame turns about, and U e_k of its parent, whose main axis it is too; None without one.

        Frames without bodies have no use for U, so that there is nothing to share.
        """
        joint, parent = self.kinematics.joint(name), self.kinematics.frames[name].parent
        turning = [k for k, x in enumerate(joint.turning) if not x.is_zero]
        if len(turning) != 1 or all(body.frame != parent for body in self.bodies.mechanism.bodies):
            return None
        along = transposed(joint.axes)[turning[0]]
        places = [n for n, x in enumerate(along) if not x.is_zero]
        if len(places) != 1:
            return None
        (n,) = places
        x, y, z = (along[n] * row[n] for row in self.motions[parent].field)
        return turning[0], (x, y, z)

    def _working(self, name: str) -> FrameMotion:
        """The frame's motion, as far as work can be done on it: w x (w x r) has no moment about a fixed axis.

        A frame that the world holds by a joint about one axis passes its force and other moments to nobody else.
        """
        motion = self.motions[name]
        held = self.kinematics.frames[name].parent == WORLD
        held = held and all(rate.is_zero for rate in self.kinematics.joint(name).place_rate)
        if not held or sum(not x.is_zero for x in motion.velocity) != 1:
            return motion
        return replace(motion, field=acceleration_field(self.none, motion.acceleration))

    def _inertial(self, body: Body, motion: FrameMotion) -> Wrench:
        """What moving a body so takes: m a of its centre of mass; the moment of that and I w' + w x I w."""
        mass, com = self.bodies.scalars.value(body.mass), self.kinematics.space.values(body.com)
        point = self._on_point(body.frame, mass, com, motion)
        return replace(point, moment=plus(turning_moment(self.bodies.inertia(body.name), motion), point.moment))

    def _on_point(self, name: str, mass: Scalar, place: Vector3, motion: FrameMotion) -> Wrench:
        """What moving a mass at a place c of a frame takes: m a, and its moment.

        On a parent that is still, centrifugal forces stand apart from the others, c x (w x (w x c)) = (w.c) (c x w):
        without a rounding they have no moment about w, which c x (m a) gives a rest of.
        """
        x, y, z = (mass * a for a in plus(motion.linear, applied(motion.field, place)))
        if motion is not self.motions[name] or not self._on_still_parent(name):
            return Wrench((x, y, z), cross(place, (x, y, z)))
        along = inner(motion.velocity, place)
        others = cross(place, plus(motion.linear, cross(motion.acceleration, place)))
        centrifugal = (along * a for a in cross(place, motion.velocity))
        a, b, c = (mass * (one + other) for one, other in zip(others, centrifugal, strict=True))
        return Wrench((x, y, z), (a, b, c))

    def _on_still_parent(self, name: str) -> bool:
        """Whether a frame turns about a fixed place: what its own rate alone loads its joint with is exactly 0 then."""
        held, lineage = self.bodies.held, self.kinematics.lineage(name)[1:]
        return bool(held) and all(self._rates_of(frame) <= held for frame in lineage if frame != WORLD)

    def _rates_of(self, name: str) -> set[int]:
        """The numbers of the coordinates whose rates move a frame against its parent."""
        joint = self.kinematics.joint(name)
        moving = [x for x in (*joint.turning, *joint.place_rate) if not x.is_zero]
        shares = (gradient(self.graph, rate, self.bodies.qd) for rate in moving)
        return {j for row in shares for j, share in enumerate(row) if not share.is_zero}

    def _inertial_about_origin(self, lump: Lump, motion: FrameMotion) -> Wrench:
        """m a + U h and its moment, I w' + w x I w + h x a."""
        x, y, z = (lump.mass * a for a in motion.linear)
        moment = plus(turning_moment(lump.tensor, motion), self._cross(lump.first, motion.linear))
        return Wrench(plus(applied(motion.field, lump.first), (x, y, z)), moment)

    def _turning_rate(self, name: str) -> Vector3:
        """How fast a frame's angular velocity against its parent changes, in its axes."""
        turning, parts = self.kinematics.joint(name).turning, quaternion_parts(self.bodies, name)
        if not parts:
            return self._rates(turning)
        still, q, qd = self.graph.zero, self.bodies.q, self.bodies.qd
        rates = [self.direction.get(q[j], still) for j in parts]
        return turning_rate([q[j] for j in parts], rates, [self.direction[qd[j]] for j in parts], turning)

    def _rates(self, rates: Vector3) -> Vector3:
        x, y, z = derivative_along(self.graph, rates, self.direction)
        return x, y, z

    def _work(self, totals: list[Scalar], rates: Sequence[Scalar], load: Sequence[Scalar]) -> None:
        """Adds the power of a load on relative rates, per rate of each coordinate."""
        for rate, component in zip(rates, load, strict=True):
            if rate.is_zero or component.is_zero:
                continue
            for index, share in enumerate(gradient(self.graph, rate, self.bodies.qd)):
                if not share.is_zero:
                    totals[index] = totals[index] + share * component

    def _terms(self, rates: Vector3) -> int:
        """How many rates of coordinates the components depend on, in all."""
        shares = (gradient(self.graph, rate, self.bodies.qd) for rate in rates if not rate.is_zero)
        return sum(not share.is_zero for row in shares for share in row)

    def _cross(self, a: Vector3, b: Vector3) -> Vector3:
        return self.none if a is self.none or b is self.none else cross(a, b)


def _about_shared_axis(w: Vector3, turning: Vector3, k: int, column: Vector3) -> Vector3:
    """w' of a frame that turns about its axis k, which its parent shares: there both have the same U e_k.

    Of what the frames' angular accelerations are, only the component k of `turning` is looked at.
    """
    i, j = (k + 1) % 3, (k + 2) % 3
    components = list(turning)
    components[i], components[j] = w[j] * w[k] - column[j], column[i] - w[i] * w[k]
    return triple(components)


def turning_moment(tensor: Rows[Scalar], motion: FrameMotion) -> Vector3:
    """I w' + w x I w, sorted by the entries of the tensor: they meet sums that the accelerations of points hold too."""
    (i_xx, i_xy, i_xz), (_, i_yy, i_yz), (_, _, i_zz) = tensor
    (x, y, z), (a, b, c) = motion.velocity, motion.acceleration
    (_, u_xy, u_xz), (u_yx, _, u_yz), (u_zx, u_zy, _) = motion.field
    return (
        i_xx * a + (i_zz - i_yy) * (y * z) + i_xz * u_yx - i_xy * u_zx + i_yz * (y * y - z * z),
        i_yy * b + (i_xx - i_zz) * (x * z) + i_xy * u_zy - i_yz * u_xy + i_xz * (z * z - x * x),
        i_zz * c + (i_yy - i_xx) * (x * y) + i_yz * u_xz - i_xz * u_yz + i_xy * (x * x - y * y),
    )


def _negative(vector: Vector3) -> Vector3:
    return -vector[0], -vector[1], -vector[2]


def _sum(one: Wrench, other: Wrench) -> Wrench:
    return Wrench(plus(one.force, other.force), plus(one.moment, other.moment))
