"""Links and joints of a robot description as frozen data."""

from __future__ import annotations

from dataclasses import dataclass, field

from symgen.diagnostics import Span
from symgen.model.robots.names import NamedThings
from symgen.model.robots.numbers import IDENTITY, Matrix, Vector, WrittenNumber, product, turn

# the joints that move, with the endings of their coordinates behind the joint's name
ENDINGS: dict[str, tuple[str, ...]] = {
    "revolute": ("",),
    "continuous": ("",),
    "prismatic": ("",),
    "planar": ("_x", "_y", "_angle"),
    "floating": ("_x", "_y", "_z", "_e0", "_e1", "_e2", "_e3"),
}
KINDS = (*ENDINGS, "fixed")


@dataclass(frozen=True, slots=True)
class Origin:
    """A shift, then turns by yaw about z, pitch about the new y, roll about the newest x."""

    xyz: tuple[WrittenNumber, ...] = ()
    rpy: tuple[WrittenNumber, ...] = ()

    @property
    def shift(self) -> Vector:
        """The shift as numbers."""
        if not self.xyz:
            return IDENTITY[0][1], IDENTITY[0][1], IDENTITY[0][1]
        x, y, z = (entry.value for entry in self.xyz)
        return x, y, z

    @property
    def axes(self) -> Matrix:
        """The matrix that turns components after the turns into components before them."""
        axes = IDENTITY
        for axis, angle in enumerate(self.rpy):
            axes = product(turn(axis, angle), axes)
        return axes


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass, place of the centre of mass, and the tensor about it (xx, yy, zz, xy, xz, yz) in the axes there."""

    origin: Origin
    mass: WrittenNumber
    tensor: tuple[WrittenNumber, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Link:
    """A part of the robot; without `inertial` it has no mass."""

    name: str
    inertial: Inertial | None
    span: Span


@dataclass(frozen=True, slots=True)
class Mimic:
    """A joint's coordinate is multiplier * (that of `joint`) + offset."""

    joint: str
    multiplier: WrittenNumber | None
    offset: WrittenNumber | None
    span: Span


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """What connects two links; `limits` and `dynamics` by the names of their attributes."""

    name: str
    kind: str
    parent: str
    child: str
    origin: Origin
    axis: tuple[WrittenNumber, ...]
    limits: dict[str, WrittenNumber] = field(hash=False)
    dynamics: dict[str, WrittenNumber] = field(hash=False)
    mimic: Mimic | None
    span: Span


@dataclass(frozen=True, slots=True)
class Robot:
    """Links and joints in the order of the file, and what was left out: names by tag."""

    links: dict[str, Link] = field(hash=False)
    joints: dict[str, UrdfJoint] = field(hash=False)
    left_out: dict[str, tuple[str, ...]] = field(hash=False)
    root: str = ""


def named_things(robot: Robot) -> NamedThings:
    """What may get names of its own in the model file."""
    moving = {name: joint for name, joint in robot.joints.items() if joint.kind != "fixed"}
    return NamedThings(
        "URDF",
        {name: (joint.span, ENDINGS[joint.kind]) for name, joint in moving.items()},
        {name: link.span for name, link in robot.links.items()},
        robot.root,
    )
