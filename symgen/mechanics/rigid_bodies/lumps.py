"""The bodies of a frame as one, given by mass, first moment and inertia about the frame's origin.

The mass of a frame that turns about a point of its parent is put there as a point mass, and a rotor on a fixed axis is
part of what it turns (base parameters: Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, ch. 9).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.model.kinematics.triples import plus, triple
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import WORLD, RotorInertia
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True)
class Lump:
    """Mass, first moment and inertia tensor about a frame's origin, in its axes."""

    mass: Scalar
    first: Vector3
    tensor: tuple[Vector3, Vector3, Vector3]


def lumped_bodies(bodies: Bodies, frames: Sequence[str]) -> tuple[dict[str, Lump], list[RotorInertia]]:
    """What each frame carries, and the rotors that are not part of it."""
    zero, kinematics = bodies.graph.zero, bodies.kinematics
    none: Vector3 = (zero, zero, zero)
    lumps = {name: Lump(zero, none, (none, none, none)) for name in frames}
    for body in bodies.mechanism.bodies:
        if body.frame != WORLD:
            mass, com = bodies.scalars.value(body.mass), kinematics.space.values(body.com)
            about_centre = _with_tensor(lumps[body.frame], bodies.inertia(body.name))
            lumps[body.frame] = _with_point(about_centre, mass, com)
    for name in reversed(frames):
        joint, parent = kinematics.joint(name), kinematics.frames[name].parent
        if parent != WORLD and all(rate.is_zero for rate in joint.place_rate):
            lumps[parent] = _with_point(lumps[parent], lumps[name].mass, joint.place)
            lumps[name] = replace(lumps[name], mass=zero)
    rotors = []
    for rotor in bodies.mechanism.rotor_inertias:
        held = _turned_alone_by(bodies, rotor.coordinate, frames)
        if held is None:
            rotors.append(rotor)
        else:
            name, axis = held
            inertia = bodies.scalars.value(rotor.inertia)
            rows = [tuple(inertia if i == j == axis else zero for j in range(3)) for i in range(3)]
            lumps[name] = _with_tensor(lumps[name], (triple(rows[0]), triple(rows[1]), triple(rows[2])))
    return lumps, rotors


def _turned_alone_by(bodies: Bodies, coordinate: str, frames: Sequence[str]) -> tuple[str, int] | None:
    """The frame, and its main axis, that turns by this coordinate alone about a fixed place of the world."""
    rate = bodies.names[f"{coordinate}_dot"]
    for name in frames:
        joint = bodies.kinematics.joint(name)
        turning = [k for k, x in enumerate(joint.turning) if not x.is_zero]
        if bodies.kinematics.frames[name].parent not in _still(bodies.kinematics, frames) or len(turning) != 1:
            continue
        if joint.turning[turning[0]] is rate and all(x.is_zero for x in joint.place_rate):
            return name, turning[0]
    return None


def _still(kinematics: Kinematics[Scalar, Scalar], frames: Sequence[str]) -> set[str]:
    """The world, and the frames that do not move."""
    still = {WORLD}
    for name in frames:
        joint = kinematics.joint(name)
        fixed = all(x.is_zero for x in (*joint.turning, *joint.place_rate))
        if fixed and kinematics.frames[name].parent in still:
            still.add(name)
    return still


def _with_point(lump: Lump, mass: Scalar, at: Vector3) -> Lump:
    """With a point mass: m (|c|^2 1 - c c^T) about the origin."""
    x, y, z = at
    mx, my, mz = first = (mass * x, mass * y, mass * z)
    xx, yy, zz, xy, xz, yz = mx * x, my * y, mz * z, mx * y, mx * z, my * z
    rows = ((yy + zz, -xy, -xz), (-xy, xx + zz, -yz), (-xz, -yz, xx + yy))
    return _with_tensor(Lump(lump.mass + mass, plus(lump.first, first), lump.tensor), rows)


def _with_tensor(lump: Lump, tensor: tuple[Vector3, Vector3, Vector3]) -> Lump:
    x, y, z = (plus(a, b) for a, b in zip(lump.tensor, tensor, strict=True))
    return replace(lump, tensor=(x, y, z))
