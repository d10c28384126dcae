"""A mechanism as the user of a symbolic tool writes it: forward kinematics frame by frame in the tool's own scalars.

Rotation matrices and velocities in body axes are handed from frame to frame, energies are sums over bodies, and the
motion equations come from the tool's derivatives along directions, never through matrices.  In world axes, as
textbooks write them, rotation matrices are multiplied up and velocities of mass centres are the world's.  Written out,
as `symgen.model.kinematics.energy_form` has them for readers, the same energies cost tools that share by themselves
many times more.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

import casadi

from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Matrix, Symbol, translate
from symgen.laboratory.bench.peers.formulas.algebra import total
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.components import components_in, definitions_before_frames
from symgen.model.kinematics.triples import applied, plus
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import WORLD, component
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange, lagrange


class _Scalars:
    """The arithmetic of `Kinematics` in a tool's scalars."""

    def __init__(self, engine: Engine, scope: dict[str, Symbol], inputs: Inputs) -> None:
        self._engine, self.scope, self._inputs = engine, scope, inputs

    def value(self, expression: Expression) -> Symbol:
        return translate(self._engine, expression, self.scope)

    def rate(self, expression: Expression) -> Symbol:
        return self._engine.rates([self.value(expression)], self._inputs["q"], self._inputs["qd"])[0]

    def number(self, value: int) -> Symbol:
        return self._engine.number(Fraction(value))

    def function(self, name: str, operand: Symbol) -> Symbol:
        return self._engine.call(name, [operand])

    def combination(self, terms: Iterable[tuple[Symbol, Symbol]]) -> Symbol:
        is_zero = self._engine.is_zero
        return total(self._engine, [a * b for a, b in terms if not (is_zero(a) or is_zero(b))])

    def named(self, _: str, value: Symbol, /) -> Symbol:
        return value


@dataclass(frozen=True, slots=True)
class Written:
    """Energies, rows, inputs and applied forces of a mechanism before anything is differentiated."""

    inputs: Inputs
    kinetic: Symbol
    potential: Symbol
    geometric: list[Symbol]
    nonholonomic: list[Symbol]
    control: Matrix
    applied: list[Symbol]


@dataclass(frozen=True, slots=True)
class Walk:
    """The frames of a mechanism in the scalars of one tool, and every name of the file."""

    inputs: Inputs
    scope: dict[str, Symbol]
    scalars: _Scalars
    kinematics: Kinematics[Symbol, Symbol]


def walk(engine: Engine, model: Model) -> Walk:
    """Frames and names before energies, rows and forces are written."""
    lengths = {"q": model.n, "qd": model.n, "qdd": model.n, "p": len(model.parameters)}
    inputs = {array: engine.symbols(array, length) for array, length in lengths.items()}
    scope = {coordinate.name: inputs["q"][i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {coordinate.rate: inputs["qd"][i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {parameter.name: inputs["p"][i] for i, parameter in enumerate(model.parameters)}
    for definition in definitions_before_frames(model):
        scope[definition.name] = translate(engine, definition.value, scope)
    scalars = _Scalars(engine, scope, inputs)
    kinematics: Kinematics[Symbol, Symbol] = Kinematics(model.mechanism, scalars, sums_of_angles=False)
    for name in components_in(model):
        one = component(name)
        scope[name] = kinematics.component_rate(one) if one.is_rate else kinematics.component(one)
    for definition in model.definitions:
        if definition.name not in scope:
            scope[definition.name] = translate(engine, definition.value, scope)
    return Walk(inputs, scope, scalars, kinematics)


def written(engine: Engine, model: Model, world_axes: bool = False) -> Written:
    """The mechanism in the scalars of one tool; velocities in the axes of the bodies or of the world."""
    at = walk(engine, model)
    kinetic, potential = _energies(engine, model, at.scalars, at.kinematics, world_axes)
    rows = [(row.kind, translate(engine, row.expression, at.scope)) for row in model.constraints]
    return Written(
        at.inputs,
        kinetic + translate(engine, model.kinetic_energy, at.scope),
        potential + translate(engine, model.potential_energy, at.scope),
        [value for kind, value in rows if kind == "geometric"],
        [value for kind, value in rows if kind == "nonholonomic"],
        control_matrix(engine, model, at),
        applied_forces(engine, model, at),
    )


def control_matrix(engine: Engine, model: Model, at: Walk) -> Matrix:
    """M."""
    places = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    columns = []
    for actuator in model.inputs:
        column = [engine.number(Fraction(0))] * model.n
        if actuator.velocity is not None:
            column = engine.gradient(translate(engine, actuator.velocity, at.scope), at.inputs["qd"])
        for name, value in actuator.acts_on:
            column[places[name]] = column[places[name]] + translate(engine, value, at.scope)
        columns.append(column)
    return [[column[i] for column in columns] for i in range(model.n)]


def applied_forces(engine: Engine, model: Model, at: Walk) -> list[Symbol]:
    """Q_a."""
    places = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    applied = [engine.number(Fraction(0))] * model.n
    for force in model.applied_forces:
        place = places[force.coordinate]
        applied[place] = applied[place] + translate(engine, force.expression, at.scope)
    for element in model.forces:
        magnitude = translate(engine, element.magnitude, at.scope)
        shares = engine.gradient(translate(engine, element.velocity, at.scope), at.inputs["qd"])
        applied = [a if engine.is_zero(x) else a + magnitude * x for a, x in zip(applied, shares, strict=True)]
    return applied


def mechanics_by_frames(engine: Engine, model: Model) -> PeerSystem:
    """tau, B and M; tau = d/dt dT/dqd - dT/dq + dU/dq - Q_a by derivatives along directions."""
    s = written(engine, model)
    q, qd, qdd = s.inputs["q"], s.inputs["qd"], s.inputs["qdd"]
    momentum = engine.gradient(s.kinetic, qd)
    rates = engine.rates(momentum, [*q, *qd], [*qd, *qdd])
    shifts = engine.gradient(s.kinetic - s.potential, q)
    balance = [engine.name(a - b - c) for a, b, c in zip(rates, shifts, s.applied, strict=True)]
    B = [engine.gradient(row, q) for row in s.geometric] + [engine.gradient(row, qd) for row in s.nonholonomic]
    return PeerSystem(s.inputs, balance, B, s.control)


def lagrange_by_frames(model: Model, world_axes: bool = False) -> Lagrange:
    """The matrices of CasADi's user."""
    s = written(CasadiEngine(), model, world_axes)
    q, qd, qdd, p = (_column(s.inputs[array]) for array in ("q", "qd", "qdd", "p"))
    control = casadi.SX.zeros(model.n, model.m)
    for i, row in enumerate(s.control):
        for j, value in enumerate(row):
            control[i, j] = value
    return lagrange(
        (q, qd, qdd, casadi.SX.sym("u", model.m), p),
        s.kinetic,
        s.potential,
        _column(s.geometric),
        _column(s.nonholonomic),
        control,
        _column(s.applied),
        casadi.SX(0, 1),
        {},
    )


def _column(values: list[Symbol]) -> casadi.SX:
    return casadi.densify(casadi.vertcat(casadi.SX(0, 1), *values))


def _energies(
    engine: Engine, model: Model, scalars: _Scalars, kinematics: Kinematics[Symbol, Symbol], world_axes: bool
) -> tuple[Symbol, Symbol]:
    space, combination = kinematics.space, scalars.combination
    half = engine.number(Fraction(1, 2))
    gravity = space.values(model.mechanism.gravity)
    weightless = all(engine.is_zero(g) for g in gravity)
    kinetic, weights = [], []
    for body in model.mechanism.bodies:
        twist, com, mass = kinematics.twist(body.frame), space.values(body.com), scalars.value(body.mass)
        arm, moving = com, twist
        if world_axes:
            moving, arm = kinematics.twist(body.frame, WORLD), applied(kinematics.axes(body.frame), com)
        speed = space.summed(moving.linear, space.crossed(moving.angular, arm))
        tensor = [space.values(row) for row in body.inertia.rows]
        momentum = [combination(zip(row, twist.angular, strict=True)) for row in tensor]
        kinetic.append(half * mass * combination(zip(speed, speed, strict=True)))
        kinetic.append(half * combination(zip(momentum, twist.angular, strict=True)))
        if not weightless:
            place = plus(kinematics.position(body.frame), arm) if world_axes else kinematics.place(body.frame, com)
            weights.append(-mass * combination(zip(gravity, place, strict=True)))
    for rotor in model.mechanism.rotor_inertias:
        rate = scalars.scope[f"{rotor.coordinate}_dot"]
        kinetic.append(half * scalars.value(rotor.inertia) * rate * rate)
    return total(engine, kinetic), total(engine, weights)
