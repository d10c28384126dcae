"""τ, B and M of a model as its user derives them with a symbolic tool: from the energies, by its own derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Matrix, Symbol, scope_of, translate
from symgen.laboratory.bench.peers.formulas.algebra import total
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model


@dataclass(frozen=True, slots=True)
class PeerSystem:
    """τ = G q̈ + C q̇ + Q − Q_a (n), built as a vector; B (r×n) and M (n×m)."""

    inputs: Inputs
    balance: list[Symbol]
    B: Matrix
    M: Matrix


def mechanics(engine: Engine, model: Model) -> PeerSystem:
    """Lagrange's equations of the first kind without their multipliers, all in the tool's scalars."""
    model = energy_form(model)
    lengths = {"q": model.n, "qd": model.n, "qdd": model.n, "p": len(model.parameters)}
    inputs = {array: engine.symbols(array, length) for array, length in lengths.items()}
    scope = scope_of(engine, model, inputs)
    B = []
    for row in model.constraints:
        by = inputs["q"] if row.kind == "geometric" else inputs["qd"]
        value = translate(engine, row.expression, scope)
        B.append([engine.derivative(value, x) for x in by])
    order = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    M = [[engine.number(Fraction(0)) for _ in model.inputs] for _ in model.coordinates]
    for j, actuator in enumerate(model.inputs):
        for coordinate, coefficient in actuator.acts_on:
            M[order[coordinate]][j] = M[order[coordinate]][j] + translate(engine, coefficient, scope)
    return PeerSystem(inputs, _balance(engine, model, inputs, scope), B, M)


def _balance(engine: Engine, model: Model, inputs: Inputs, scope: dict[str, Symbol]) -> list[Symbol]:
    """d/dt ∂T/∂q̇ − ∂T/∂q + ∂U/∂q − Q_a."""
    kinetic = translate(engine, model.kinetic_energy, scope)
    potential = translate(engine, model.potential_energy, scope)
    applied: dict[str, list[Symbol]] = {}
    for force in model.applied_forces:
        applied.setdefault(force.coordinate, []).append(translate(engine, force.expression, scope))
    balance = []
    for i, coordinate in enumerate(model.coordinates):
        momentum = engine.derivative(kinetic, inputs["qd"][i])
        terms = [engine.derivative(momentum, v) * a for v, a in zip(inputs["qd"], inputs["qdd"], strict=True)]
        terms += [engine.derivative(momentum, x) * v for x, v in zip(inputs["q"], inputs["qd"], strict=True)]
        terms.append(-engine.derivative(kinetic, inputs["q"][i]))
        terms.append(engine.derivative(potential, inputs["q"][i]))
        terms += [-force for force in applied.get(coordinate.name, [])]
        balance.append(engine.name(total(engine, terms)))
    return balance
