"""G, C, Q, Q_a, g, B, B-dot and M of a model in the ring: Lagrange's equations (3) with Christoffel's C."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from symgen.closedform.matrices import add, column, multiply, zero
from symgen.closedform.quotient import Matrix, Quotient, polynomial
from symgen.closedform.ring import TrigRing
from symgen.closedform.translate import Translator
from symgen.model.expression import Expression
from symgen.model.model import Model


@dataclass(frozen=True, slots=True)
class Mechanics:
    """The pieces of the motion equations (3); vectors are matrices with one column."""

    translator: Translator
    mass: Matrix
    coriolis: Matrix
    coriolis_force: Matrix
    potential_force: Matrix
    applied_force: Matrix
    residual: Matrix
    jacobian: Matrix
    jacobian_dot: Matrix
    control: Matrix

    @property
    def ring(self) -> TrigRing:
        """The ring all entries live in."""
        return self.translator.ring


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
    return Translator(variables, [c.name for c in model.coordinates], definitions, preferred, [*others, *further])


def derive_mechanics(model: Model, translator: Translator) -> Mechanics:
    """Differentiate the energies and constraints of the model."""
    ring = translator.ring
    names = [c.name for c in model.coordinates]
    rates = [c.rate for c in model.coordinates]
    mass = _mass_matrix(translator, translator.value(model.kinetic_energy), rates)
    coriolis = _christoffel(translator, mass, names, rates)
    velocity = tuple((translator.name(rate),) for rate in rates)
    potential = translator.value(model.potential_energy)
    applied = {name: zero(ring) for name in names}
    for force in model.applied_forces:
        applied[force.coordinate] = applied[force.coordinate] + translator.value(force.expression)
    rows: list[tuple[Quotient, ...]] = []
    residual: list[Quotient] = []
    for row in model.constraints:
        value = translator.value(row.expression)
        if row.kind == "geometric":
            residual.append(value)
        rows.append(tuple(translator.derivative(value, name) for name in (names if row.kind == "geometric" else rates)))
    jacobian = tuple(rows)
    controls = [{name: translator.value(factor) for name, factor in control.acts_on} for control in model.inputs]
    return Mechanics(
        translator=translator,
        mass=mass,
        coriolis=coriolis,
        coriolis_force=multiply(ring, coriolis, velocity),
        potential_force=column([translator.derivative(potential, name) for name in names]),
        applied_force=column([applied[name] for name in names]),
        residual=column(residual),
        jacobian=jacobian,
        jacobian_dot=tuple(tuple(time_derivative(translator, entry, model) for entry in row) for row in jacobian),
        control=tuple(tuple(entries.get(name, zero(ring)) for entries in controls) for name in names),
    )


def time_derivative(translator: Translator, value: Quotient, model: Model) -> Quotient:
    """The derivative along q-dot of a function of q."""
    total = zero(translator.ring)
    for c in model.coordinates:
        slope = translator.derivative(value, c.name)
        if slope:
            total = total + slope * translator.name(c.rate)
    return total


def load(model: Model, mechanics: Mechanics) -> Matrix:
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
