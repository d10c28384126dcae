"""The unprojected mechanics of a model by differentiating its energies and constraints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi

from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model
from symgen.witness.translate import translate, with_definitions


@dataclass(frozen=True, slots=True)
class Lagrange:
    """Symbols, and what follows from T, U, constraints and inputs without projection; equation numbers in brackets."""

    q: casadi.SX
    qd: casadi.SX
    qdd: casadi.SX
    u: casadi.SX
    p: casadi.SX
    kinetic: casadi.SX
    potential: casadi.SX
    mass: casadi.SX  # G (3), n×n
    coriolis: casadi.SX  # C (3), Christoffel, n×n
    coriolis_force: casadi.SX  # C q̇, n
    potential_force: casadi.SX  # Q (3), n
    applied_force: casadi.SX  # Q_a, n
    residual: casadi.SX  # g (4), r_g
    jacobian: casadi.SX  # B (1), r×n
    jacobian_dot: casadi.SX  # Ḃ along q̇, r×n
    control: casadi.SX  # M (3), n×m
    task: casadi.SX  # coordinates of the task as functions of q, k
    further: Mapping[str, casadi.SX]  # arguments of some quantities beside q, qd, qdd and u, by name

    @property
    def balance(self) -> casadi.SX:
        """τ = G q̈ + C q̇ + Q − Q_a, n."""
        return self.mass @ self.qdd + self.coriolis_force + self.potential_force - self.applied_force


def differentiate(model: Model) -> Lagrange:
    """All of `Lagrange` from the model alone."""
    model = energy_form(model)
    q, qd, qdd = (casadi.SX.sym(name, model.n) for name in ("q", "qd", "qdd"))
    u, p = casadi.SX.sym("u", model.m), casadi.SX.sym("p", len(model.parameters))
    scope = {coordinate.name: q[i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {coordinate.rate: qd[i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {parameter.name: p[i] for i, parameter in enumerate(model.parameters)}
    scope = with_definitions(scope, model.definitions)

    def column(*expressions: Expression) -> casadi.SX:
        return casadi.densify(casadi.vertcat(casadi.SX(0, 1), *(translate(e, scope) for e in expressions)))

    order = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    control = casadi.SX.zeros(model.n, model.m)
    for j, actuator in enumerate(model.inputs):
        for name, coefficient in actuator.acts_on:
            control[order[name], j] += translate(coefficient, scope)
    applied = casadi.SX.zeros(model.n)
    for force in model.applied_forces:
        applied[order[force.coordinate]] += translate(force.expression, scope)
    return lagrange(
        (q, qd, qdd, u, p),
        column(model.kinetic_energy),
        column(model.potential_energy),
        column(*(row.expression for row in model.constraints if row.kind == "geometric")),
        column(*(row.expression for row in model.constraints if row.kind == "nonholonomic")),
        control,
        applied,
        column(*(x.expression for x in model.task)),
        {one.name: casadi.SX.sym(one.name, len(one.places)) for one in model.further_arguments},
    )


def lagrange(
    symbols: tuple[casadi.SX, casadi.SX, casadi.SX, casadi.SX, casadi.SX],
    kinetic: casadi.SX,
    potential: casadi.SX,
    geometric: casadi.SX,
    nonholonomic: casadi.SX,
    control: casadi.SX,
    applied: casadi.SX,
    task: casadi.SX,
    further: Mapping[str, casadi.SX],
) -> Lagrange:
    """All of `Lagrange` from T, U, the columns of rows, M, Q_a and the task; `symbols` are q, qd, qdd, u, p."""
    q, qd, qdd, u, p = symbols
    mass = casadi.densify(casadi.hessian(kinetic, qd)[0])
    momentum = mass @ qd
    shift = casadi.jacobian(momentum, q)
    jacobian = casadi.vertcat(casadi.jacobian(geometric, q), casadi.jacobian(nonholonomic, qd))
    return Lagrange(
        q=q,
        qd=qd,
        qdd=qdd,
        u=u,
        p=p,
        kinetic=kinetic,
        potential=potential,
        mass=mass,
        coriolis=casadi.densify(along(mass, q, qd) + shift - shift.T) / 2,
        coriolis_force=casadi.jtimes(casadi.gradient(kinetic, qd), q, qd) - casadi.gradient(kinetic, q),
        potential_force=casadi.densify(casadi.gradient(potential, q)),
        applied_force=applied,
        residual=geometric,
        jacobian=casadi.densify(jacobian),
        jacobian_dot=along(jacobian, q, qd),
        control=control,
        task=task,
        further=further,
    )


def along(matrix: casadi.SX, q: casadi.SX, direction: casadi.SX) -> casadi.SX:
    """The derivative of a matrix of q in a direction (n), same shape."""
    flat = casadi.jtimes(casadi.vec(casadi.densify(matrix)), q, direction)
    return casadi.densify(casadi.reshape(flat, *matrix.shape))
