"""G, C, Q, Q_a, g, B, B-dot and M of a model in the ring: Lagrange's equations (3) with Christoffel's C."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property

from symgen.closedform.algebra.limits import LIMIT_OF_MODEL
from symgen.closedform.algebra.matrices import add, column, multiply, zero
from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial
from symgen.closedform.algebra.ring import TrigRing
from symgen.closedform.algebra.translate import Translator
from symgen.model.expressions.expression import Expression, Name
from symgen.model.model import Model


class ExactSystem:
    """The pieces of the motion equations (3), derived when asked for; vectors are matrices with one column.

    Raises TooLargeError where the expanded expressions need too much work.
    """

    def __init__(self, model: Model, translator: Translator) -> None:
        self.model = model
        self.translator = translator
        self._names = [c.name for c in model.coordinates]
        self._rates = [c.rate for c in model.coordinates]

    @property
    def ring(self) -> TrigRing:
        """The ring all entries live in."""
        return self.translator.ring

    @cached_property
    def mass(self) -> Matrix:
        """G (3), the second derivatives of T."""
        with self.ring.work.limited("the mass matrix"):
            kinetic = self.translator.value(self.model.kinetic_energy)
            return _mass_matrix(self.translator, kinetic, self._rates)

    @cached_property
    def coriolis(self) -> Matrix:
        """C (3), Christoffel's."""
        mass = self.mass
        with self.ring.work.limited("the Coriolis matrix"):
            return _christoffel(self.translator, mass, self._names, self._rates)

    @cached_property
    def coriolis_force(self) -> Matrix:
        """C qd."""
        return multiply(self.ring, self.coriolis, tuple((self.translator.name(rate),) for rate in self._rates))

    @cached_property
    def potential_force(self) -> Matrix:
        """Q, the gradient of U."""
        with self.ring.work.limited("the potential forces"):
            potential = self.translator.value(self.model.potential_energy)
            return column([self.translator.derivative(potential, name) for name in self._names])

    @cached_property
    def applied_force(self) -> Matrix:
        """Q_a."""
        applied = {name: zero(self.ring) for name in self._names}
        with self.ring.work.limited("the applied forces"):
            for force in self.model.applied_forces:
                applied[force.coordinate] = applied[force.coordinate] + self.translator.value(force.expression)
        return column([applied[name] for name in self._names])

    @cached_property
    def residual(self) -> Matrix:
        """g of the geometric constraints."""
        rows = [row for row in self.model.constraints if row.kind == "geometric"]
        with self.ring.work.limited("the geometric constraints", LIMIT_OF_MODEL):
            return column([self.translator.value(row.expression) for row in rows])

    def places(self, names: Sequence[str]) -> Matrix:
        """Three named values in each row: the places of points."""
        with self.ring.work.limited("the places of the points"):
            values = [self.translator.value(Name(name)) for name in names]
        return tuple(tuple(values[i : i + 3]) for i in range(0, len(values), 3))

    def rate_coefficients(self, names: Sequence[str]) -> Matrix:
        """The coefficients of the rates in named velocities, a row for each."""
        with self.ring.work.limited("the Jacobians of the points"):
            values = [self.translator.value(Name(name)) for name in names]
            return tuple(tuple(self.translator.derivative(v, rate) for rate in self._rates) for v in values)

    @cached_property
    def task_jacobian(self) -> Matrix:
        """The derivatives of the coordinates of the task, a row for each."""
        with self.ring.work.limited("the derivatives of the task"):
            values = [self.translator.value(x.expression) for x in self.model.task]
            return tuple(tuple(self.translator.derivative(value, name) for name in self._names) for value in values)

    @cached_property
    def jacobian(self) -> Matrix:
        """B (1): derivatives of geometric constraints by q, of non-holonomic ones by qd."""
        rows = []
        with self.ring.work.limited("B", LIMIT_OF_MODEL):
            for row in self.model.constraints:
                value = self.translator.value(row.expression)
                names = self._names if row.kind == "geometric" else self._rates
                rows.append(tuple(self.translator.derivative(value, name) for name in names))
        return tuple(rows)

    @cached_property
    def jacobian_dot(self) -> Matrix:
        """The time derivative of B."""
        jacobian = self.jacobian
        with self.ring.work.limited("the time derivative of B"):
            return tuple(tuple(time_derivative(self.translator, e, self.model) for e in row) for row in jacobian)

    @cached_property
    def control(self) -> Matrix:
        """M (3)."""
        with self.ring.work.limited("the control matrix"):
            columns = [
                {name: self.translator.value(factor) for name, factor in control.acts_on}
                for control in self.model.inputs
            ]
        return tuple(tuple(entries.get(name, zero(self.ring)) for entries in columns) for name in self._names)


def make_translator(model: Model, further: Iterable[Expression] = ()) -> Translator:
    """A ring that holds the model and `further` expressions."""
    delta = max(model.n, 1)
    variables = [c.name for c in model.coordinates]
    variables += [c.rate for c in model.coordinates]
    variables += [c.acceleration for c in model.coordinates]
    variables += [p.name for p in model.parameters]
    variables += [i.name for i in model.inputs if i.name not in variables]
    variables += [f"multiplier_{row.name}" for row in model.constraints]
    variables += [f"_velocity_{k}" for k in range(delta)] + [f"_acceleration_{k}" for k in range(delta)]
    definitions = {d.name: d.value for d in model.definitions}
    preferred = [row.expression for row in model.constraints]
    others = [model.kinetic_energy, model.potential_energy]
    others += [factor for control in model.inputs for _, factor in control.acts_on]
    others += [force.expression for force in model.applied_forces]
    others += [x.expression for x in model.task]
    return Translator(variables, [c.name for c in model.coordinates], definitions, preferred, [*others, *further])


def time_derivative(translator: Translator, value: Quotient, model: Model) -> Quotient:
    """The derivative along q-dot of a function of q."""
    total = zero(translator.ring)
    for c in model.coordinates:
        slope = translator.derivative(value, c.name)
        if slope:
            total = total + slope * translator.name(c.rate)
    return total


def load(model: Model, mechanics: ExactSystem) -> Matrix:
    """tau = G qdd + C qd + Q - Q_a."""
    acceleration = tuple((mechanics.translator.name(c.acceleration),) for c in model.coordinates)
    total = add(multiply(mechanics.ring, mechanics.mass, acceleration), mechanics.coriolis_force)
    total = add(total, mechanics.potential_force)
    return tuple((a - b,) for (a,), (b,) in zip(total, mechanics.applied_force, strict=True))


def _mass_matrix(translator: Translator, kinetic: Quotient, rates: list[str]) -> Matrix:
    slopes = [translator.derivative(kinetic, rate) for rate in rates]
    return tuple(tuple(translator.derivative(slope, rate) for rate in rates) for slope in slopes)


def _christoffel(translator: Translator, mass: Matrix, names: list[str], rates: list[str]) -> Matrix:
    """C_ij = 1/2 sum_k (d_k G_ij + d_j G_ik - d_i G_jk) qd_k."""
    n = len(names)
    ring = translator.ring
    slope = [[[translator.derivative(mass[i][j], name) for name in names] for j in range(n)] for i in range(n)]
    half = polynomial(ring, ring.constant(Fraction(1, 2)))
    velocity = [translator.name(rate) for rate in rates]
    rows = []
    for i in range(n):
        row = []
        for j in range(n):
            total = zero(ring)
            for k in range(n):
                symbol = slope[i][j][k] + slope[i][k][j] - slope[j][k][i]
                if symbol:
                    total = total + symbol * velocity[k] * half
            row.append(total)
        rows.append(tuple(row))
    return tuple(rows)
