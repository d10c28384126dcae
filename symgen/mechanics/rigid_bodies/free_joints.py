"""Frames that three coordinates move along orthogonal axes and three others turn: their rates and their twist.

v = A x' with an orthogonal A and w = E a', so that forces and accelerations can be taken along the axes of the frame,
where its inertia is that of its bodies, and brought to the coordinates in one step.  Only E is ever singular.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.model.kinematics.triples import Rows, applied, cross, inner, transposed, triple
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

Six = tuple[Scalar, ...]


@dataclass(frozen=True, slots=True)
class FreeJoint:
    """The coordinates; `along` is A, `back` the inverse of E, `determinant` that of E."""

    places: tuple[int, int, int]
    angles: tuple[int, int, int]
    along: Rows[Scalar]
    back: Rows[Scalar]
    determinant: Scalar

    def directions(self, _: Mapping[int, Six], graph: Graph) -> list[tuple[int, Six]]:
        """Unit twists in place of the coordinates' directions; forces are met last from the tip."""
        units = [tuple(graph.one if i == j else graph.zero for j in range(6)) for i in range(6)]
        return list(zip((*self.angles, *self.places), units, strict=True))

    def wrench(self, forces: Sequence[Scalar]) -> dict[int, Scalar]:
        """Forces of the coordinates as force and moment along the axes, each where its coordinate stands."""
        force = applied(self.along, triple([forces[j] for j in self.places]))
        moment = applied(transposed(self.back), triple([forces[j] for j in self.angles]))
        return dict(zip((*self.places, *self.angles), (*force, *moment), strict=True))

    def rates(self, twist: Sequence[Scalar]) -> dict[int, Scalar]:
        """The rates of the coordinates from the twist, given where its coordinates stand."""
        places = applied(transposed(self.along), triple([twist[j] for j in self.places]))
        angles = applied(self.back, triple([twist[j] for j in self.angles]))
        return dict(zip((*self.places, *self.angles), (*places, *angles), strict=True))


def free_joint(directions: Mapping[int, Six]) -> FreeJoint | None:
    """The joint in which coordinates turn and move a frame like this, in its axes; None where it is another one."""
    places = [j for j, d in directions.items() if all(x.is_zero for x in d[:3])]
    angles = [j for j, d in directions.items() if all(x.is_zero for x in d[3:])]
    if len(places) != 3 or len(angles) != 3:
        return None
    along = transposed(_rows([triple(directions[j][3:]) for j in places]))
    x, y, z = (triple(directions[j][:3]) for j in angles)
    products = [[inner(column, other) for other in transposed(along)] for column in transposed(along)]
    if not all(x.is_one if i == j else x.is_zero for i, row in enumerate(products) for j, x in enumerate(row)):
        return None
    determinant = inner(x, cross(y, z))
    over = 1 / determinant
    back = [triple([entry * over for entry in row]) for row in (cross(y, z), cross(z, x), cross(x, y))]
    return FreeJoint(_three(places), _three(angles), along, _rows(back), determinant)


def _rows(rows: Sequence[Vector3]) -> Rows[Scalar]:
    first, second, third = rows
    return first, second, third


def _three(numbers: Sequence[int]) -> tuple[int, int, int]:
    first, second, third = numbers
    return first, second, third
