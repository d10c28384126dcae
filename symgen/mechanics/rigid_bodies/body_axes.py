"""Free bodies moved by their twists: three balances of forces and three of moments in the body's own axes.

u depends only on T^T f, B T and T^T M for any regular T.  A body that three coordinates carry and three others turn has
six rows in which every force is projected on the axes of its angles.  With the velocity of one of its points and its
angular velocity, both in body axes, as quasi-velocities, a force d at r has the row (d, r x d) with r of parameters
only, and Newton and Euler's equations stand as they are (Kane and Levinson, Dynamics, 1985, ch. 2 and 4).

Moments are taken about the point that leaves most of them out.  T is singular where the angles' rates do not turn the
body in every direction; there the rows of the coordinates are singular, so that determinant belongs to what is tested.
"""

from __future__ import annotations

from functools import cached_property

from symgen.mechanics.held_rows import with_leaves
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.mechanics.rigid_bodies.free_bodies import FreeBody, free_bodies
from symgen.mechanics.rigid_bodies.newton_euler import newton_euler
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.triples import Rows, applied, cross, inner, minus, plus, transposed, triple
from symgen.model.model import Model
from symgen.symbolic.calculus import gradient
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import substitute


class BodyAxes(System):
    """A system whose free bodies have twists in place of rates: their rows are forces and moments in body axes.

    B, f and M are those of the quasi-velocities, rows of B without the numbers that all their terms hold.
    """

    def __init__(self, model: Model, lumped: bool = False) -> None:
        super().__init__(model, lumped=lumped)
        self.free = free_bodies(self)
        owners = [owner for body in self.free for owner, _ in body.points]
        self._leaf_names, self._leaves = with_leaves(self, owners)
        self._arms = {body.frame: _arms(self, body) for body in self.free}

    @cached_property
    def twist_determinant(self) -> Scalar:
        """The determinant of twists by rates: where it vanishes the coordinates do not move the bodies freely."""
        return self.graph.product(inner(x, cross(y, z)) for x, y, z in self._turning.values())

    @cached_property
    def turnings(self) -> tuple[tuple[tuple[int, int, int], Rows[Scalar]], ...]:
        """Of each free body: the coordinates that turn it, and its angular velocity by their rates (3 x 3)."""
        return tuple((body.angles, self._turning[body.frame]) for body in self.free)

    @cached_property
    def coordinate_rows(self) -> Matrix:
        """B with columns that span those of the coordinates: moments work on the rates of angles."""
        rows = [list(row) for row in self.constraint_jacobian]
        for angles, turning in self.turnings:
            for row in rows:
                moment = [row[j] for j in angles]
                for j, column in zip(angles, transposed(turning), strict=True):
                    row[j] = dot(self.graph, column, moment)
        return tuple(map(tuple, rows))

    @cached_property
    def geometric_jacobian(self) -> Matrix:
        """The rows of B that stem from geometric constraints, by quasi-velocities."""
        return tuple(self._row(row.expression) for row in self.model.constraints if row.kind == "geometric")

    @cached_property
    def _turning(self) -> dict[str, Rows[Scalar]]:
        """Angular velocity of each free body by the rates of its angles."""
        by_frame = {}
        for body in self.free:
            rates = [self.qd[j] for j in body.angles]
            x, y, z = (
                triple(gradient(self.graph, w, rates)) for w in self.bodies.kinematics.twist(body.frame).angular
            )
            by_frame[body.frame] = (x, y, z)
        return by_frame

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
                pulls = triple([by_leaf[leaf] for leaf in self._leaves[owner]])
                own = self._in_body_axes(body, owner, at, pulls)
                force = plus(force, own)
                moment = plus(moment, cross(self._arms[body.frame][1][owner], own))
            for j, entry in zip(body.coordinates, (*force, *moment), strict=True):
                row[j] = entry
        return tuple(row)

    def _in_body_axes(self, body: FreeBody, owner: str, at: Vector3, pull: Vector3) -> Vector3:
        """A force in body axes; one along the place of its own point takes that place as it is in body axes."""
        graph, kinematics = self.graph, self.bodies.kinematics
        axes, leaves = kinematics.axes(body.frame), self._leaves[owner]
        inward = transposed(axes)
        slopes = [gradient(graph, entry, leaves) for entry in pull]
        sign = -1 if (-slopes[0][0]).is_one else 1
        if any(not (sign * x - int(i == j)).is_zero for i, row in enumerate(slopes) for j, x in enumerate(row)):
            return applied(inward, triple(substitute(graph, pull, self._places)))
        rest = substitute(graph, pull, dict.fromkeys(leaves, graph.zero))
        rest = substitute(graph, [sign * entry for entry in rest], self._places)
        x, y, z = plus(applied(inward, kinematics.position(body.frame)), at)
        # term by term: what points share is added first, and no sum of two products turns into another angle
        for entry, row in zip(rest, axes, strict=True):
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
        twists = {body.frame: body.coordinates for body in self.free}
        forces = list(newton_euler(self.bodies, self.qd, acceleration, gravity, self.lumped, twists))
        for body in self.free:
            reference, _, length = self._arms[body.frame]
            force, moment = (triple([forces[j] for j in slots]) for slots in (body.places, body.angles))
            over = 1 / length
            about = minus((moment[0] * over, moment[1] * over, moment[2] * over), cross(reference, force))
            for j, entry in zip(body.angles, about, strict=True):
                forces[j] = entry
        return tuple(forces)


def _arms(mechanics: BodyAxes, body: FreeBody) -> tuple[Vector3, dict[str, Vector3], Scalar]:
    """The point moments are taken about and the arms of all points from it, over a length, and that length.

    Of the points that which leaves most components of arms out; the length is what all of them hold as a factor.
    """
    definite = Definite(mechanics)
    length = definite.content([x for _, at in body.points for x in at])
    places = {owner: triple([definite.without(x, length) for x in at]) for owner, at in body.points}
    origin: Vector3 = (mechanics.graph.zero,) * 3
    arms = [{owner: minus(at, place) for owner, at in places.items()} for place in (origin, *places.values())]
    best = max(range(len(arms)), key=lambda k: sum(x.is_zero for arm in arms[k].values() for x in arm))
    return (origin, *places.values())[best], arms[best], length
