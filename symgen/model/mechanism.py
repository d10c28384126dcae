"""Frames, bodies and points as frozen data: what a model in bodies form says, before any kinematics.

Frames are listed parents first.  Vectors are triples of expressions; lengths, angles and quaternions may contain
coordinates, parameters and definitions of these.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Literal, TypeAlias

from symgen.diagnostics import Span
from symgen.model.expressions.expression import Expression, Number
from symgen.records import dataclass

WORLD = "world"
ZERO = Number(Fraction(0))
Vector3: TypeAlias = tuple[Expression, Expression, Expression]
NO_VECTOR: Vector3 = (ZERO, ZERO, ZERO)
AXES: tuple[Literal["x", "y", "z"], ...] = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn by `angle` (rad, right-handed) about `axis`, given in the axes before the turn; any length but zero."""

    axis: Vector3
    angle: Expression


@dataclass(frozen=True, slots=True)
class Quaternion:
    """The attitude e / |e| of a quaternion (scalar part first), a rotation for every e but zero.

    The angular velocity in the turned axes is 2 (e_0 v' - e_0' v - v x v') / (e . e) with the vector part v.
    """

    parts: tuple[Expression, Expression, Expression, Expression]


@dataclass(frozen=True, slots=True)
class Frame:
    """Axes that are moved along `translation` (in the parent's axes), then turned by each of `rotation` in order."""

    name: str
    parent: str
    translation: Vector3
    rotation: tuple[Turn, ...] | Quaternion
    description: str = ""
    span: Span | None = None


INERTIA_ELEMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


@dataclass(frozen=True, slots=True)
class Inertia:
    """Elements of the inertia tensor about the centre of mass, in the frame's axes."""

    xx: Expression = ZERO
    yy: Expression = ZERO
    zz: Expression = ZERO
    xy: Expression = ZERO
    xz: Expression = ZERO
    yz: Expression = ZERO

    @property
    def rows(self) -> tuple[Vector3, Vector3, Vector3]:
        """The symmetric matrix."""
        return (self.xx, self.xy, self.xz), (self.xy, self.yy, self.yz), (self.xz, self.yz, self.zz)


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body that moves with `frame`; `com` and `inertia` in the frame's axes."""

    name: str
    frame: str
    mass: Expression
    com: Vector3
    inertia: Inertia
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Point:
    """A point at `at` in the axes of `frame`; its velocity is that of the material point of `carrier` at this place.

    The carrier is the frame itself unless the file says otherwise; where `at` contains coordinates, or the carrier
    turns against the frame, the velocity is not the derivative of the position (the contact point of a wheel).
    """

    name: str
    frame: str
    at: Vector3
    carrier: str
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class RotorInertia:
    """T += inertia/2 * (rate of the coordinate)^2: a rotor that is geared to one joint, without its other motions."""

    coordinate: str
    inertia: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Wheel:
    """A wheel around the origin of a frame; `axle` is 0, 1, 2 for the axis x, y, z of the frame it turns about."""

    frame: str
    radius: Expression
    axle: int


@dataclass(frozen=True, slots=True)
class Tie:
    """A rod, spring or part of a cable between two points or origins of frames."""

    kind: Literal["rod", "spring", "cable"]
    ends: tuple[str, str]


@dataclass(frozen=True, slots=True)
class DrawnSolid:
    """What a part looks like: corners (m) in the axes of a frame, and flat faces by the numbers of their corners."""

    frame: str
    corners: tuple[tuple[float, float, float], ...]
    faces: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The bodies form of a model; empty where the model has energies only.  Wheels, ties, solids are for pictures."""

    gravity: Vector3 = NO_VECTOR
    frames: tuple[Frame, ...] = ()
    bodies: tuple[Body, ...] = ()
    points: tuple[Point, ...] = ()
    rotor_inertias: tuple[RotorInertia, ...] = ()
    wheels: tuple[Wheel, ...] = ()
    ties: tuple[Tie, ...] = ()
    solids: tuple[DrawnSolid, ...] = ()

    @property
    def has_mass(self) -> bool:
        """Whether it adds to the kinetic energy."""
        return bool(self.bodies or self.rotor_inertias)


NO_MECHANISM = Mechanism()


# components of points and frames in expressions -----------------------------------------------------------------------

PLACES = ("x", "y", "z")
VELOCITIES = ("vx", "vy", "vz")
TURNING_RATES = ("wx", "wy", "wz")


@dataclass(frozen=True, slots=True)
class Component:
    """`owner.what`, as a user writes it, or `owner.what@axes` with the axes of another frame, as short forms write it.

    Places and velocities belong to points and to the origins of frames, turning rates to frames; `r12` is the second
    element of the first row of the matrix that turns the owner's axes into the given ones.
    """

    owner: str
    what: str
    axes: str = WORLD

    @property
    def name(self) -> str:
        """How the component stands in expressions."""
        return f"{self.owner}.{self.what}" + ("" if self.axes == WORLD else f"@{self.axes}")

    @property
    def is_rate(self) -> bool:
        """Whether it is linear in the rates."""
        return self.what[0] in "vw"

    @property
    def is_direction(self) -> bool:
        """Whether it is an entry of the matrix of the owner's axes."""
        return self.what[0] == "r"

    @property
    def index(self) -> int:
        """0, 1, 2 for x, y, z."""
        return "xyz".index(self.what[-1])


def is_component(name: str) -> bool:
    """Whether a name in an expression is one of a component."""
    return "." in name


def component(name: str) -> Component:
    """The component with that name."""
    owner, _, rest = name.partition(".")
    what, _, axes = rest.partition("@")
    return Component(owner, what, axes or WORLD)
