"""Frames that a quaternion turns: three turning rates, and the rate of the quaternion's length, which moves nothing.

w = 2 E e' / |e|^2 with E e = 0 and E E^T = |e|^2, so that e' = E^T w / 2 + e r with r = e.e' / |e|^2.  Forces and
accelerations are taken along the axes of the frame, where its inertia is that of its bodies; G has nothing along e, and
the row that holds |e| nothing beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from symgen.mechanics.rigid_bodies.bodies import Bodies
from symgen.model.expressions.expression import Name
from symgen.model.kinematics.triples import Rows, applied, transposed, triple
from symgen.model.mechanism import Quaternion
from symgen.records import dataclass
from symgen.symbolic.calculus import gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar

Six = tuple[Scalar, ...]
Rates3 = tuple[Scalar, Scalar, Scalar]
# E by rows: for each entry a part of the quaternion (0: the scalar one) and its sign; the frame's own axes
TURNS = (((1, -1), (0, 1), (3, 1), (2, -1)), ((2, -1), (3, -1), (0, 1), (1, 1)), ((3, -1), (2, 1), (1, -1), (0, 1)))


@dataclass(frozen=True, slots=True)
class QuaternionJoint:
    """The four coordinates, scalar part first, and their symbols e.

    The first one's place among the coordinates stands for e.e' / |e|^2, those of the others for the turning rates.
    `places` are coordinates along the parent's axes, if it has three such; `along` brings their rates to the frame's.
    """

    parts: tuple[int, ...]
    values: Vector
    places: tuple[int, ...]
    along: Rows[Scalar]

    @property
    def length(self) -> int:
        """Where the rate of the length stands."""
        return self.parts[0]

    @property
    def turns(self) -> tuple[int, ...]:
        """Where the turning rates stand."""
        return self.parts[1:]

    def directions(self, own: Mapping[int, Six], graph: Graph) -> list[tuple[int, Six]]:
        """Unit twists in place of the coordinates' directions, and those of others as they are."""
        units = [tuple(graph.one if i == j else graph.zero for j in range(6)) for i in range(6)]
        replaced = (*self.turns, *self.places)
        others = [(j, direction) for j, direction in own.items() if j not in (*self.parts, *self.places)]
        return [*zip(replaced, units, strict=False), *others]

    def wrench(self, forces: Sequence[Scalar]) -> dict[int, Scalar]:
        """Forces of the coordinates: the moment, what works on the length, and the force, where each has its place."""
        given = [forces[j] for j in self.parts]
        moment = [self._turned(row, given) / 2 for row in TURNS]
        by_coordinate = dict(zip(self.parts, (self.along_length(given), *moment), strict=True))
        if self.places:
            force = applied(self.along, triple([forces[j] for j in self.places]))
            by_coordinate |= dict(zip(self.places, force, strict=True))
        return by_coordinate

    def along_length(self, given: Sequence[Scalar]) -> Scalar:
        """e.f of forces of the four coordinates."""
        return dot(self.values[0].graph, self.values, given)

    def rates(self, twist: Sequence[Scalar]) -> dict[int, Scalar]:
        """The rates of the coordinates from what stands in their places."""
        stretched, *turning = (twist[j] for j in self.parts)
        by_coordinate = {}
        for i, (j, value) in enumerate(zip(self.parts, self.values, strict=True)):
            column = [row[i] for row in TURNS]
            turned = dot(value.graph, [self.values[k] * sign for k, sign in column], turning) / 2
            by_coordinate[j] = turned + value * stretched
        if self.places:
            places = applied(transposed(self.along), triple([twist[j] for j in self.places]))
            by_coordinate |= dict(zip(self.places, places, strict=True))
        return by_coordinate

    def holds_length(self, row: Vector) -> bool:
        """Whether a row of B holds the length of the quaternion and nothing else: it is a multiple of e."""
        given = [row[j] for j in self.parts]
        if any(not entry.is_zero for j, entry in enumerate(row) if j not in self.parts):
            return False
        pairs = zip(given, self.values, strict=True)
        first, value = given[0], self.values[0]
        return not first.is_zero and all((x * value - first * y).is_zero for x, y in pairs)

    def _turned(self, row: Sequence[tuple[int, int]], given: Sequence[Scalar]) -> Scalar:
        return dot(given[0].graph, [self.values[k] * sign for k, sign in row], given)


def quaternion_joint(bodies: Bodies, name: str, own: Mapping[int, Six]) -> QuaternionJoint | None:
    """The joint of a frame that four coordinates turn as a quaternion; `own` are the directions of its coordinates."""
    parts = quaternion_parts(bodies, name)
    if not parts:
        return None
    joint = bodies.kinematics.joint(name)
    slopes = [gradient(bodies.graph, rate, bodies.qd) for rate in joint.place_rate]
    moved = [[j for j, slope in enumerate(row) if not slope.is_zero] for row in slopes]
    places = tuple(row[0] for row in moved if len(row) == 1)
    simple = len(set(places)) == 3 and all(row[j].is_one for row, j in zip(slopes, places, strict=True))
    if not set(own) >= set(parts) or any(set(parts) & set(row) for row in moved):
        return None
    values = tuple(bodies.q[j] for j in parts)
    return QuaternionJoint(parts, values, places if simple else (), transposed(joint.axes))


def quaternion_parts(bodies: Bodies, name: str) -> tuple[int, ...]:
    """The numbers of the four coordinates that turn a frame as a quaternion; none where nothing turns it so."""
    rotation = bodies.kinematics.frames[name].rotation
    if not isinstance(rotation, Quaternion):
        return ()
    names = [str(symbol.payload) for symbol in bodies.q]
    parts = [names.index(x.name) for x in rotation.parts if isinstance(x, Name) and x.name in names]
    return tuple(parts) if len(set(parts)) == 4 else ()


def turning_rate(e: Sequence[Scalar], e_dot: Sequence[Scalar], e_ddot: Sequence[Scalar], w: Rates3) -> Rates3:
    """d/dt of w = 2 E e' / |e|^2: 2 E e'' / |e|^2 - w 2 e.e' / |e|^2, because the rate of E times e' is 0."""
    graph = e[0].graph
    two = 2 / dot(graph, e, e)
    shrinking = two * dot(graph, e, e_dot)
    grown = [two * dot(graph, [e[k] * sign for k, sign in row], e_ddot) for row in TURNS]
    return triple([one - shrinking * own for one, own in zip(grown, w, strict=True)])
