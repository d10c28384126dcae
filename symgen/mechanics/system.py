"""The mechanical system on the scalar graph: energies, forces, constraints and their derivatives.

Everything is computed on first use, so a quantity that no output reaches costs nothing.  Velocities are arguments,
because several quantities are evaluated along a projected velocity rather than along q_dot.
"""

from __future__ import annotations

from functools import cached_property, lru_cache

from symgen.mechanics.absolute_angles import AbsoluteAngles
from symgen.mechanics.christoffel import Slopes, by_products_of_rates, slopes_of, with_zeros
from symgen.mechanics.given_forces import GivenForces
from symgen.mechanics.held_rows import HeldRows, acceleration_bias, geometric_jacobian
from symgen.mechanics.matrices import Matrices
from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.mechanics.rigid_bodies.joint_axes import along_joints
from symgen.model.checks.signs import nonnegative_parameters, positive_parameters
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.components import components_in, definitions_before_frames
from symgen.model.kinematics.triples import Rows
from symgen.model.model import Model
from symgen.model.quantities import MEASURED_ARGUMENTS, FurtherName
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, matvec, subtract_vectors, transpose
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import cost, substitute


class System:
    """A model's energies, forces and constraint rows as scalars of one graph.

    `change` describes the system in other coordinates on the graph of `base`; q, qd and qdd are then those.
    `lumped` regroups the parameters of bodies (`newton_euler`).
    """

    def __init__(
        self,
        model: Model,
        base: System | None = None,
        change: AbsoluteAngles | None = None,
        lumped: bool = False,
    ) -> None:
        self.model = model
        self.lumped = lumped
        graph = Graph() if base is None else base.graph
        self.graph: Graph = graph
        self.change = change
        mark = "" if change is None else " absolute"
        symbol = graph.symbol if change is None else graph.stand_in
        self.q: Vector = tuple(symbol(c.name + mark) for c in model.coordinates)
        # what only some kernels are given: where it cancels it must not come into those of others
        self.qd: Vector = tuple(graph.stand_in(c.rate + mark) for c in model.coordinates)
        self.qdd: Vector = tuple(graph.stand_in(c.acceleration + mark) for c in model.coordinates)
        self.parameters: Vector = tuple(graph.symbol(p.name) for p in model.parameters)
        self.u: Vector = tuple(graph.stand_in(i.name) for i in model.inputs)
        q, qd = (self.q, self.qd) if change is None else (change.relative(self.q), change.relative(self.qd))
        names = map(model.further_names, MEASURED_ARGUMENTS)
        self.measured = tuple(tuple(map(symbol, level)) for level in names)
        self.names: dict[str, Scalar] = {
            **{c.name: node for c, node in zip(model.coordinates, q, strict=True)},
            **{c.rate: node for c, node in zip(model.coordinates, qd, strict=True)},
            **{p.name: node for p, node in zip(model.parameters, self.parameters, strict=True)},
        }
        self.bodies = self._bodies()
        for definition in model.definitions:
            if definition.name not in self.names:
                self.names[definition.name] = translate(graph, definition.value, self.names)
        self.factoring = Factoring(graph, self.parameters, self.q)
        self.definitions = {d.name: self.names[d.name] for d in model.definitions}

    def apart(self) -> System:
        """The same system on a graph of its own, where no function of it is known yet."""
        plain = System(self.model, lumped=self.lumped)
        return plain if self.change is None else System(self.model, plain, self.change, self.lumped)

    def _bodies(self) -> Bodies:
        """The bodies, and every component of points and frames that a formula uses, entered in `names`."""
        for definition in definitions_before_frames(self.model):
            self.names[definition.name] = translate(self.graph, definition.value, self.names)
        held = () if self.model.assembly is None else self.model.assembly.held
        bodies = Bodies(along_joints(self.model.mechanism), self.graph, dict(self.names), self.q, self.qd, held)
        for name in components_in(self.model):
            self.names[name] = bodies.component(name)
        return bodies

    @cached_property
    def working_gravity(self) -> Vector3:
        """The acceleration of gravity for recursions over the joints; 0 where no weight works."""
        zero = self.graph.zero
        return self.bodies.gravity if _weights_work(self.model) else (zero, zero, zero)

    def further(self, *arguments: FurtherName) -> tuple[Vector, ...]:
        """The entries of arguments beside q, qd, qdd and u: of a task and of weights."""
        return tuple(tuple(map(self.graph.symbol, self.model.further_names(argument))) for argument in arguments)

    @property
    def motion(self) -> Vector:
        """q, q_dot and q_ddot, 3n."""
        return (*self.q, *self.qd, *self.qdd)

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.q)

    @property
    def r(self) -> int:
        """Number of constraint rows."""
        return len(self.model.constraints)

    @property
    def m(self) -> int:
        """Number of inputs."""
        return len(self.u)

    @cached_property
    def positive(self) -> frozenset[str]:
        """The parameters that are positive, by their ranges or by nature."""
        return positive_parameters(self.model)

    @cached_property
    def nonnegative(self) -> frozenset[str]:
        """The parameters that are positive or 0, by nature: masses and moments of inertia."""
        return nonnegative_parameters(self.model)

    # energies --------------------------------------------------------------------------------------------------------

    @cached_property
    def kinetic_energy(self) -> Scalar:
        """T(q, q_dot)."""
        return self._written_energy + self.bodies.kinetic_energy

    @cached_property
    def _written_energy(self) -> Scalar:
        """T as far as it is written out in the model."""
        return translate(self.graph, self.model.kinetic_energy, self.names)

    @cached_property
    def potential_energy(self) -> Scalar:
        """U(q)."""
        return self.written_potential + self.bodies.potential_energy

    @cached_property
    def written_potential(self) -> Scalar:
        """U as far as it is written out in the model."""
        return translate(self.graph, self.model.potential_energy, self.names)

    @cached_property
    def momentum(self) -> Vector:
        """p = dT/dq_dot = G q_dot."""
        return tuple(gradient(self.graph, self.kinetic_energy, self.qd))

    @cached_property
    def mass_matrix(self) -> Matrix:
        """G (3): the momentum's derivatives by the rates, the upper triangle used twice."""
        zero_rates = dict.fromkeys(self.qd, self.graph.zero)
        rows = [
            substitute(self.graph, gradient(self.graph, p, self.qd), zero_rates) for p in self.momentum
        ]
        return tuple(tuple(rows[min(i, j)][max(i, j)] for j in range(self.n)) for i in range(self.n))

    @cached_property
    def _mass_slopes(self) -> tuple[Slopes, ...]:
        """The entries of dG/dq^k that are not zero, for every k."""
        return slopes_of(self.graph, self.mass_matrix, self.q)

    @cached_property
    def mass_matrix_gradient(self) -> tuple[Matrix, ...]:
        """dG/dq^k for every k."""
        return with_zeros(self.graph, self._mass_slopes, self.n)

    @cached_property
    def matrices(self) -> Matrices:
        """G and C by the shortest ways, for what is made of them as they are."""
        return Matrices(self)

    @property
    def is_of_bodies_alone(self) -> bool:
        """Whether all that has mass are bodies, which move by the model's own coordinates."""
        return self.change is None and self.model.mechanism.has_mass and self._written_energy.is_zero

    @cached_property
    def potential_force(self) -> Vector:
        """Q (3) = dU/dq."""
        return tuple(gradient(self.graph, self.potential_energy, self.q))

    @cached_property
    def applied_force(self) -> Vector:
        """Q_a(q, q_dot), on the right-hand side."""
        (_, given), *others = self.applied_parts
        for magnitude, column in others:
            given = tuple(x + magnitude * y for x, y in zip(given, column, strict=True))
        return given

    @cached_property
    def applied_parts(self) -> list[tuple[Scalar, Vector]]:
        """What acts on the coordinates themselves, and the magnitude of each force with what a unit of it does."""
        forces = {f.coordinate: translate(self.graph, f.expression, self.names) for f in self.model.applied_forces}
        direct = self._components(tuple(forces.get(c.name, self.graph.zero) for c in self.model.coordinates))
        others = (
            (translate(self.graph, force.magnitude, self.names), self.worked_on(force.velocity))
            for force in self.model.forces
        )
        return [(self.graph.one, direct), *others]

    def applied_force_at(self, velocity: Vector) -> Vector:
        """Q_a along another velocity."""
        if velocity == self.qd:
            return self.applied_force
        return tuple(substitute(self.graph, self.applied_force, dict(zip(self.qd, velocity, strict=True))))

    @cached_property
    def coriolis_force(self) -> Vector:
        """C q_dot, straight from the energy."""
        return self._inertial_force(tuple(self.graph.zero for _ in self.q))

    @cached_property
    def balance(self) -> Vector:
        """tau = G q_ddot + C q_dot + Q - Q_a; built without the matrices G and C."""
        return tuple(f - a for f, a in zip(self._conservative_force(self.qdd), self.applied_force, strict=True))

    def _conservative_force(self, acceleration: Vector) -> Vector:
        """G a + C q_dot + Q; with bodies in one recursion, where weight is an acceleration of the world."""
        if self.model.mechanism.has_mass:
            inertial = self._inertial_force_of_bodies(acceleration, self.working_gravity)
            potential: Vector = tuple(gradient(self.graph, self.written_potential, self.q))
        else:
            inertial, potential = self._inertial_force(acceleration), self.potential_force
        return tuple(i + f for i, f in zip(inertial, potential, strict=True))

    def _inertial_force(self, acceleration: Vector) -> Vector:
        """d/dt dT/dq_dot - dT/dq: by differentiating the momentum, or through G, whichever counts less."""
        graph = self.graph
        if self.model.mechanism.has_mass:
            none = self.graph.zero
            return self._inertial_force_of_bodies(acceleration, (none, none, none))
        motion = dict(zip((*self.q, *self.qd), (*self.qd, *acceleration), strict=True))
        rates = derivative_along(graph, self.momentum, motion)
        direct = [p - t for p, t in zip(rates, gradient(graph, self.kinetic_energy, self.q), strict=True)]
        squared = by_products_of_rates(graph, self.qd, self.mass_matrix_gradient, self._mass_slopes)
        linear = matvec(graph, self.mass_matrix, acceleration)
        collected = [a + b for a, b in zip(linear, squared, strict=True)]
        return tuple(min((direct, collected), key=lambda force: cost(force).weight))

    def _inertial_force_of_bodies(self, acceleration: Vector, gravity: Vector3) -> Vector:
        """The same without the energies of the bodies, whose differentiation would undo the recursion."""
        graph = self.graph
        force = self._forces_of_bodies(acceleration, gravity)
        if self._written_energy.is_zero:
            return force
        motion = dict(zip((*self.q, *self.qd), (*self.qd, *acceleration), strict=True))
        rates = derivative_along(graph, gradient(graph, self._written_energy, self.qd), motion)
        shifts = gradient(graph, self._written_energy, self.q)
        return tuple(f + p - t for f, p, t in zip(force, rates, shifts, strict=True))

    def _forces_of_bodies(self, acceleration: Vector, gravity: Vector3) -> Vector:
        """What Newton and Euler's equations ask of each coordinate."""
        from symgen.mechanics.rigid_bodies.newton_euler import newton_euler  # models given by energies start without it

        return newton_euler(self.bodies, self.qd, acceleration, gravity, self.lumped)

    # constraints and inputs ------------------------------------------------------------------------------------------

    @cached_property
    def constraint_residual(self) -> Vector:
        """g(q) (4)."""
        rows = [row for row in self.model.constraints if row.kind == "geometric"]
        return tuple(translate(self.graph, row.expression, self.names) for row in rows)

    @cached_property
    def geometric_jacobian(self) -> Matrix:
        """dg/dq."""
        return geometric_jacobian(self)

    @cached_property
    def held_rows(self) -> HeldRows:
        """The same rows by the places and directions that they hold."""
        return HeldRows(self)

    @cached_property
    def constraint_jacobian(self) -> Matrix:
        """B (1): dg/dq above the coefficients of the non-holonomic rows."""
        graph = self.graph
        rows = [row for row in self.model.constraints if row.kind == "nonholonomic"]
        zero_rates = dict.fromkeys(self.qd, graph.zero)
        kinematic = [
            substitute(graph, gradient(graph, translate(graph, row.expression, self.names), self.qd), zero_rates)
            for row in rows
        ]
        return (*self.geometric_jacobian, *(tuple(row) for row in kinematic))

    @cached_property
    def coordinate_rows(self) -> Matrix:
        """Rows with the rank of B in the model's coordinates, whatever moves the system here."""
        return self.constraint_jacobian

    @property
    def turnings(self) -> tuple[tuple[tuple[int, int, int], Rows[Scalar]], ...]:
        """For each body whose twist moves it here: its angles, and the angular velocity by their rates."""
        return ()

    @cached_property
    def twist_determinant(self) -> Scalar:
        """The determinant of what moves the system here by the rates of its coordinates."""
        return self.graph.one

    def constraint_jacobian_dot(self, velocity: Vector) -> Matrix:
        """B_dot along a velocity."""
        flat = [entry for row in self.constraint_jacobian for entry in row]
        rates = iter(derivative_along(self.graph, flat, dict(zip(self.q, velocity, strict=True))))
        return tuple(tuple(next(rates) for _ in range(self.n)) for _ in range(self.r))

    def constraint_acceleration_bias(self, velocity: Vector) -> Vector:
        """B_dot v along v."""
        return acceleration_bias(self, velocity)

    @cached_property
    def control_matrix(self) -> Matrix:
        """M (3): one column per input."""
        columns = [
            {name: translate(self.graph, value, self.names) for name, value in i.acts_on} for i in self.model.inputs
        ]
        given = (tuple(column.get(c.name, self.graph.zero) for c in self.model.coordinates) for column in columns)
        input_columns = [
            self._components(column) if i.velocity is None else self.worked_on(i.velocity)
            for i, column in zip(self.model.inputs, given, strict=True)
        ]
        return transpose(tuple(input_columns), self.n)

    def worked_on(self, velocity: Expression) -> Vector:
        """The generalized force of a unit force that works on this rate: its coefficients."""
        rate = translate(self.graph, velocity, self.names)
        zero_rates = dict.fromkeys(self.qd, self.graph.zero)
        return tuple(substitute(self.graph, gradient(self.graph, rate, self.qd), zero_rates))

    def _components(self, force: Vector) -> Vector:
        """A generalized force of the model's coordinates in those of this system."""
        return force if self.change is None else self.change.forces(force)

    @cached_property
    def inputs(self) -> tuple[Vector, ...]:
        """The columns of M."""
        return transpose(self.control_matrix, self.m)

    @cached_property
    def applied_balance(self) -> Vector:
        """f = M u - C q_dot - Q + Q_a, the right-hand side of G q_ddot + B^T lambda = f."""
        return subtract_vectors(matvec(self.graph, self.control_matrix, self.u), self.bias_force)

    @cached_property
    def given(self) -> GivenForces:
        """M u + Q_a and the written potential: f without the weights and inertial forces of bodies."""
        return GivenForces(self)

    @cached_property
    def bias_force(self) -> Vector:
        """C q_dot + Q - Q_a."""
        conservative = self._conservative_force(tuple(self.graph.zero for _ in self.q))
        return tuple(f - a for f, a in zip(conservative, self.applied_force, strict=True))


@lru_cache(maxsize=1)
def _weights_work(model: Model) -> bool:
    """Whether a weight loads any coordinate; on a graph of its own, once for all systems of a model."""
    return System(model).bodies.weights_work
