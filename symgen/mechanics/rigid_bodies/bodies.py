"""Bodies on the scalar graph: forward kinematics in body axes, kinetic and potential energy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.triples import Triple, applied, inner
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import Component, Mechanism, component
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate

Vector3 = Triple[Scalar]


class ScalarArithmetic:
    """The arithmetic of `Kinematics` on a graph; `names` are those frames and bodies may use."""

    def __init__(self, graph: Graph, names: Mapping[str, Scalar], motion: Mapping[Scalar, Scalar]) -> None:
        self.graph, self._names, self._motion = graph, names, motion

    def value(self, expression: Expression) -> Scalar:
        """The scalar of an expression."""
        return translate(self.graph, expression, self._names)

    def rate(self, expression: Expression) -> Scalar:
        """Its time derivative."""
        return derivative_along(self.graph, [self.value(expression)], self._motion)[0]

    def number(self, value: int) -> Scalar:
        """A constant."""
        return self.graph.const(value)

    def function(self, name: str, operand: Scalar) -> Scalar:
        """sin, cos or sqrt."""
        return self.graph.function(name, (operand,))

    def combination(self, terms: Iterable[tuple[Scalar, Scalar]]) -> Scalar:
        """Sum of products."""
        return self.graph.sum(factor * rate for factor, rate in terms if not (factor.is_zero or rate.is_zero))

    def named(self, _: str, value: Scalar, /) -> Scalar:
        """Scalars have no names."""
        return value


class Bodies:
    """A mechanism at one state: `q` and `qd` are the symbols that move, `names` what frames and bodies may use.

    `held` are the numbers of coordinates that constraints leave no motion.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        graph: Graph,
        names: Mapping[str, Scalar],
        q: Vector,
        qd: Vector,
        held: Sequence[int] = (),
    ) -> None:
        self.mechanism, self.graph, self.q, self.qd, self.held = mechanism, graph, q, qd, frozenset(held)
        self.names = names
        self.scalars = ScalarArithmetic(graph, names, dict(zip(q, qd, strict=True)))
        self.kinematics: Kinematics[Scalar, Scalar] = Kinematics(mechanism, self.scalars)

    def component(self, name: str) -> Scalar:
        """A component of a point or frame as it stands in an expression."""
        one: Component = component(name)
        return self.kinematics.component_rate(one) if one.is_rate else self.kinematics.component(one)

    @cached_property
    def point_position(self) -> Vector:
        """Places of the points in world axes, x, y, z of each in turn."""
        return tuple(x for point in self.mechanism.points for x in self.kinematics.position(point.name))

    @cached_property
    def point_jacobian(self) -> Matrix:
        """Velocities of the material points in world axes by the rates, three rows for each point."""
        rates = (v for point in self.mechanism.points for v in self.kinematics.velocity(point.name))
        return tuple(tuple(gradient(self.graph, rate, self.qd)) for rate in rates)

    @cached_property
    def gravity(self) -> Vector3:
        """The acceleration of gravity in world axes."""
        return self.kinematics.space.values(self.mechanism.gravity)

    @cached_property
    def kinetic_energy(self) -> Scalar:
        """Sum of m/2 v.v + w.I w/2 in body axes, v of the centre of mass, and J/2 rate^2 of rotors."""
        half = self.graph.const(1) / 2
        space = self.kinematics.space
        total = self.graph.zero
        for body in self.mechanism.bodies:
            twist = self.kinematics.twist(body.frame)
            velocity = space.summed(twist.linear, space.crossed(twist.angular, space.values(body.com)))
            total = total + self.scalars.value(body.mass) * half * inner(velocity, velocity)
            momentum = applied(self.inertia(body.name), twist.angular)
            total = total + half * inner(twist.angular, momentum)
        for rotor in self.mechanism.rotor_inertias:
            rate = self.names[f"{rotor.coordinate}_dot"]
            total = total + self.scalars.value(rotor.inertia) * half * (rate * rate)
        return total

    @cached_property
    def potential_energy(self) -> Scalar:
        """The sum of -m g·r over the centres of mass."""
        total = self.graph.zero
        if all(entry.is_zero for entry in self.gravity):
            return total
        for body in self.mechanism.bodies:
            place = self.kinematics.place(body.frame, self.kinematics.space.values(body.com))
            total = total - self.scalars.value(body.mass) * inner(self.gravity, place)
        return total

    @cached_property
    def weights_work(self) -> bool:
        """Whether a weight loads any coordinate.

        Weights that joints bear are left out of recursions: turned from frame to frame and back, they would leave a
        rounding of themselves, which is all there is near rest.
        """
        return not all(force.is_zero for force in gradient(self.graph, self.potential_energy, self.q))

    def inertia(self, name: str) -> tuple[Vector3, Vector3, Vector3]:
        """The inertia tensor of a body, in its frame's axes about its centre of mass."""
        body = next(body for body in self.mechanism.bodies if body.name == name)
        x, y, z = (self.kinematics.space.values(row) for row in body.inertia.rows)
        return x, y, z
