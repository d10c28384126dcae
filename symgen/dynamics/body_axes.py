"""Free bodies moved by their twists: three balances of forces and three of moments in the body's own axes.

u depends only on T^T f, B T and T^T M for any regular T.  A body that three coordinates carry and three others turn has
six rows in which every force is projected on the axes of its angles.  With the velocity of one of its points and its
angular velocity, both in body axes, as quasi-velocities, a force d at r has the row (d, r x d) with r of parameters
only, and Newton and Euler's equations stand as they are (Kane and Levinson, Dynamics, 1985, ch. 2 and 4).

Moments are taken about the point that leaves most of them out.  T is singular where the angles' rates do not turn the
body in every direction; there the rows of the coordinates are singular, so that determinant belongs to what is tested.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from symgen.dynamics.bodies import Vector3
from symgen.dynamics.forms.definite import Definite
from symgen.dynamics.mechanics import Mechanics
from symgen.dynamics.newton_euler import newton_euler
from symgen.graph.calculus import gradient
from symgen.graph.content import divided, usual_number
from symgen.graph.matrix import Matrix, Vector, dot
from symgen.graph.scalar import Scalar
from symgen.graph.translate import translate
from symgen.graph.traverse import reached, substitute
from symgen.model.components import components_in, without_components
from symgen.model.expression import Expression
from symgen.model.mechanism import WORLD, component
from symgen.model.model import Model
from symgen.model.triples import Rows, applied, minus, plus, transposed
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class FreeBody:
    """A frame of the world that three coordinates move along its axes and three others turn.

    `places` and `angles` are the numbers of these coordinates, `points` the points (or the frame itself) that geometric
    constraints hold, with their places in the frame.
    """

    frame: str
    places: tuple[int, int, int]
    angles: tuple[int, int, int]
    points: tuple[tuple[str, Vector3], ...]


def free_bodies(mechanics: Mechanics) -> tuple[FreeBody, ...]:
    """The frames whose six coordinates do nothing but move them, driven and braked by nothing but constraints."""
    if not mechanics.model.mechanism.has_mass or mechanics.change is not None:
        return ()
    parents = {frame.parent for frame in mechanics.model.mechanism.frames}
    frames = [f.name for f in mechanics.model.mechanism.frames if f.parent == WORLD and f.name not in parents]
    return tuple(found for name in frames if (found := _free_body(mechanics, name)) is not None)


def _free_body(mechanics: Mechanics, frame: str) -> FreeBody | None:
    q, qd, kinematics = mechanics.q, mechanics.qd, mechanics.bodies.kinematics
    joint = kinematics.joint(frame)
    places = [q.index(x) for x in joint.place if x in q]
    turned = reached(joint.turning)
    angles = [j for j, rate in enumerate(qd) if rate in turned]
    own = {*places, *angles}
    if len(places) != 3 or len(angles) != 3 or len(own) != 6:
        return None
    symbols = {x for j in own for x in (q[j], qd[j])}
    for other in mechanics.model.mechanism.frames:
        if other.name != frame:
            there = kinematics.joint(other.name)
            if symbols & reached((*there.place, *(x for row in there.axes for x in row))):
                return None
    points = _held_points(mechanics, frame)
    if points is None or not _only_held(mechanics, points, own):
        return None
    return FreeBody(frame, (places[0], places[1], places[2]), (angles[0], angles[1], angles[2]), points)


def _held_points(mechanics: Mechanics, frame: str) -> tuple[tuple[str, Vector3], ...] | None:
    """The points of the frame whose places are used; None where anything else of the frame is."""
    kinematics = mechanics.bodies.kinematics
    found: dict[str, Vector3] = {}
    for name in components_in(mechanics.model):
        one = component(name)
        point = kinematics.points.get(one.owner)
        held = frame in ((one.owner,) if point is None else (point.frame, point.carrier))
        if not held and one.axes != frame:
            continue
        at = kinematics.space.origin if point is None else kinematics.space.values(point.at)
        placed = point is None or (point.frame == frame and all(map(mechanics.factoring.fixed, at)))
        if one.axes != WORLD or one.what not in ("x", "y", "z") or not placed:
            return None
        found[one.owner] = at
    return tuple(found.items())


def _only_held(mechanics: Mechanics, points: Sequence[tuple[str, Vector3]], own: set[int]) -> bool:
    """Whether geometric constraints feel the six coordinates through places of points only, and nothing else does."""
    model, graph = mechanics.model, mechanics.graph
    names, leaves = _with_leaves(mechanics, [owner for owner, _ in points])
    coordinates = {x for j in own for x in (mechanics.q[j], mechanics.qd[j])}
    moved = {model.coordinates[j].name for j in own}
    whole = coordinates | {leaf for three in leaves.values() for leaf in three}

    def feels(expression: Expression, symbols: Iterable[Scalar]) -> bool:
        return not reached([translate(graph, expression, names)]).isdisjoint(symbols)

    driven = [
        *(name for control in model.inputs for name, _ in control.acts_on),
        *(force.coordinate for force in model.applied_forces),
        *(rotor.coordinate for rotor in model.mechanism.rotor_inertias),
    ]
    works = [
        model.kinetic_energy,
        model.potential_energy,
        *(control.velocity for control in model.inputs if control.velocity is not None),
        *(force.velocity for force in model.forces),
        *(row.expression for row in model.constraints if row.kind != "geometric"),
    ]
    held = [row.expression for row in model.constraints if row.kind == "geometric"]
    return (
        moved.isdisjoint(driven)
        and not any(feels(expression, whole) for expression in works)
        and not any(feels(expression, coordinates) for expression in held)
    )


def _with_leaves(mechanics: Mechanics, owners: Sequence[str]) -> tuple[dict[str, Scalar], dict[str, Vector3]]:
    """The names of formulas with symbols in place of the components of points."""
    graph, model = mechanics.graph, mechanics.model
    names, leaves = dict(mechanics.names), dict[str, Vector3]()
    for owner in owners:
        x, y, z = (graph.symbol(f"{owner}.{axis} held") for axis in "xyz")
        leaves[owner] = (x, y, z)
        names |= {f"{owner}.{axis}": leaf for axis, leaf in zip("xyz", (x, y, z), strict=True)}
    apart = without_components(model.definitions)
    for definition in model.definitions:
        if definition not in apart:
            names[definition.name] = translate(graph, definition.value, names)
    return names, leaves


class BodyAxes(Mechanics):
    """A system whose free bodies have twists in place of rates: their rows are forces and moments in body axes.

    B, f and M are those of the quasi-velocities, rows of B without the numbers that all their terms hold.
    """

    def __init__(self, model: Model, lumped: bool = False) -> None:
        super().__init__(model, lumped=lumped)
        self.free = free_bodies(self)
        owners = [owner for body in self.free for owner, _ in body.points]
        self._leaf_names, self._leaves = _with_leaves(self, owners)
        self._arms = {body.frame: _arms(self, body) for body in self.free}

    @cached_property
    def twist_determinant(self) -> Scalar:
        """The determinant of twists by rates: where it vanishes the coordinates do not move the bodies freely."""
        return self.graph.product(_determinant(rows) for rows in self._turning.values())

    @cached_property
    def coordinate_rows(self) -> Matrix:
        """B with columns that span those of the coordinates: moments work on the rates of angles."""
        rows = [list(row) for row in self.constraint_jacobian]
        for body in self.free:
            for row in rows:
                moment = [row[j] for j in body.angles]
                for j, column in zip(body.angles, transposed(self._turning[body.frame]), strict=True):
                    row[j] = dot(self.graph, column, moment)
        return tuple(map(tuple, rows))

    @cached_property
    def geometric_jacobian(self) -> Matrix:
        return tuple(self._row(row.expression) for row in self.model.constraints if row.kind == "geometric")

    @cached_property
    def _turning(self) -> dict[str, Rows[Scalar]]:
        """Angular velocity of each free body by the rates of its angles."""
        found = {}
        for body in self.free:
            rates = [self.qd[j] for j in body.angles]
            x, y, z = (
                _triple(gradient(self.graph, w, rates)) for w in self.bodies.kinematics.joint(body.frame).turning
            )
            found[body.frame] = (x, y, z)
        return found

    def _row(self, residual: Expression) -> Vector:
        """A row of B: slopes by the other coordinates, and the wrench of the held points."""
        graph = self.graph
        leaves = [leaf for three in self._leaves.values() for leaf in three]
        slopes = gradient(graph, translate(graph, residual, self._leaf_names), [*self.q, *leaves])
        number = usual_number(slope for slope in slopes if not slope.is_zero)
        primitive = [divided(graph, slope, number) for slope in slopes]
        by_leaf = dict(zip(leaves, primitive[self.n :], strict=True))
        row = substitute(graph, primitive[: self.n], self._places)
        for body in self.free:
            force = moment = (graph.zero,) * 3
            for owner, at in body.points:
                pulls = _triple([by_leaf[leaf] for leaf in self._leaves[owner]])
                own = self._in_body_axes(body, owner, at, pulls)
                force = plus(force, own)
                moment = plus(moment, self._moment(self._arms[body.frame][1][owner], own))
            for j, entry in zip((*body.places, *body.angles), (*force, *moment), strict=True):
                row[j] = entry
        return tuple(row)

    def _in_body_axes(self, body: FreeBody, owner: str, at: Vector3, pull: Vector3) -> Vector3:
        """A force in body axes; one along the place of its own point takes that place as it is in body axes."""
        graph, joint = self.graph, self.bodies.kinematics.joint(body.frame)
        inward, leaves = transposed(joint.axes), self._leaves[owner]
        slopes = [gradient(graph, entry, leaves) for entry in pull]
        sign = slopes[0][0].constant
        along = sign in (1, -1) and all(
            slope.constant == (sign if i == j else 0) for i, row in enumerate(slopes) for j, slope in enumerate(row)
        )
        if not along:
            return applied(inward, _triple(substitute(graph, pull, self._places)))
        rest = substitute(graph, pull, dict.fromkeys(leaves, graph.zero))
        rest = substitute(graph, [sign * entry for entry in rest], self._places)
        x, y, z = plus(applied(inward, joint.place), at)
        # term by term: what points share is added first, and no sum of two products turns into another angle
        for entry, row in zip(rest, joint.axes, strict=True):
            x, y, z = x + row[0] * entry, y + row[1] * entry, z + row[2] * entry
        return sign * x, sign * y, sign * z

    @cached_property
    def _places(self) -> dict[Scalar, Scalar]:
        """Where the held points are."""
        return {
            leaf: place
            for owner, three in self._leaves.items()
            for leaf, place in zip(three, self.bodies.kinematics.position(owner), strict=True)
        }

    def _forces_of_bodies(self, acceleration: Vector, gravity: Vector3) -> Vector:
        twists = {body.frame: (*body.places, *body.angles) for body in self.free}
        forces = list(newton_euler(self.bodies, self.qd, acceleration, gravity, self.lumped, twists))
        for body in self.free:
            reference, _, length = self._arms[body.frame]
            force, moment = (_triple([forces[j] for j in slots]) for slots in (body.places, body.angles))
            over = 1 / length
            about = minus((moment[0] * over, moment[1] * over, moment[2] * over), self._moment(reference, force))
            for j, entry in zip(body.angles, about, strict=True):
                forces[j] = entry
        return tuple(forces)

    def _moment(self, arm: Vector3, force: Vector3) -> Vector3:
        x, y, z = arm
        a, b, c = force
        return y * c - z * b, z * a - x * c, x * b - y * a


def _arms(mechanics: BodyAxes, body: FreeBody) -> tuple[Vector3, dict[str, Vector3], Scalar]:
    """The point moments are taken about and the arms of all points from it, over a length, and that length.

    Of the points that which leaves most components of arms out; the length is what all of them hold as a factor.
    """
    definite = Definite(mechanics)
    length = definite.content([x for _, at in body.points for x in at])
    places = {owner: _triple([definite.without(x, length) for x in at]) for owner, at in body.points}
    origin: Vector3 = (mechanics.graph.zero,) * 3
    arms = [{owner: minus(at, place) for owner, at in places.items()} for place in (origin, *places.values())]
    best = max(range(len(arms)), key=lambda k: sum(x.is_zero for arm in arms[k].values() for x in arm))
    return (origin, *places.values())[best], arms[best], length


def _determinant(rows: Rows[Scalar]) -> Scalar:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def _triple(values: Sequence[Scalar]) -> Vector3:
    x, y, z = values
    return x, y, z
