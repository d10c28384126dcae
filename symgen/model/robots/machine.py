"""A machine as readers of MJCF and SDF understand it: links, joints that make a tree of them, and what closes loops."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from symgen.diagnostics import Span
from symgen.model.mechanism import WORLD
from symgen.model.robots.names import NamedThings
from symgen.model.robots.numbers import Vector, WrittenNumber, written
from symgen.model.robots.places import NO_SHIFT, AxesPlace
from symgen.model.robots.solids import Solid

# the endings of the coordinates behind the name of a joint
ENDINGS: dict[str, tuple[str, ...]] = {
    "fixed": (),
    "revolute": ("",),
    "prismatic": ("",),
    "spherical": ("_e0", "_e1", "_e2", "_e3"),
    "floating": ("_x", "_y", "_z", "_e0", "_e1", "_e2", "_e3"),
}


@dataclass(frozen=True, slots=True)
class MachineLink:
    """A part that moves as one; one that `stands_between` two joints of a part has no name of its own."""

    name: str
    solids: tuple[Solid, ...]
    span: Span
    stands_between: bool = False


@dataclass(frozen=True, slots=True)
class MachineJoint:
    """What connects a link with one nearer to the root.

    Its axes have `place` in those of the parent, and the axes of the child have `rest` in those that have moved.
    `values` are numbers by name: lower, upper, velocity, viscous, dry, rotor, stiffness, and unstretched, the
    coordinate where its spring has no force.  `start` are the coordinates in which the file describes the machine.
    """

    name: str
    kind: str
    parent: str
    child: str
    place: AxesPlace
    rest: AxesPlace
    span: Span
    axis: Vector = NO_SHIFT
    values: dict[str, WrittenNumber] = field(default_factory=dict, hash=False)
    start: tuple[Fraction, ...] = ()


@dataclass(frozen=True, slots=True)
class Closing:
    """A loop by its type in the model language: what has these places in the two links meets."""

    name: str
    kind: str
    links: tuple[str, str]
    places: tuple[AxesPlace, AxesPlace]
    span: Span


@dataclass(frozen=True, slots=True)
class Follower:
    """The coordinate of `joint`, less `offset`, is a polynomial of that of `leader`, less `leader_offset`; without a
    leader it is the first of the coefficients."""

    name: str
    joint: str
    leader: str
    coefficients: tuple[WrittenNumber, ...]
    offset: Fraction
    leader_offset: Fraction
    span: Span


@dataclass(frozen=True, slots=True)
class Drive:
    """An input, which acts on the coordinate of a joint times `gear`."""

    name: str
    joint: str
    gear: WrittenNumber
    span: Span


@dataclass(frozen=True, slots=True)
class Machine:
    """All of it: joints parents first, what was left out (names by tag), and links that the model file places."""

    links: dict[str, MachineLink] = field(hash=False)
    joints: tuple[MachineJoint, ...] = ()
    closings: tuple[Closing, ...] = ()
    followers: tuple[Follower, ...] = ()
    drives: tuple[Drive, ...] = ()
    gravity: tuple[WrittenNumber, ...] = ()
    left_out: dict[str, tuple[str, ...]] = field(default_factory=dict, hash=False)
    placed: tuple[str, ...] = ()


def named_parts(form: str, machine: Machine) -> NamedThings:
    """What may get names of its own in the model file."""
    return NamedThings(
        form,
        {joint.name: (joint.span, ENDINGS[joint.kind]) for joint in machine.joints if joint.kind != "fixed"},
        {name: link.span for name, link in machine.links.items() if not link.stands_between},
        WORLD,
    )


def computed(value: Fraction, span: Span) -> WrittenNumber:
    """A number that does not stand in the file as it is."""
    return WrittenNumber(value, written(value), span)
