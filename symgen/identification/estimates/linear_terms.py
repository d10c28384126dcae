"""Parameters beside those of bodies in which the inputs are linear: friction, dampers, springs.

Which these are is asked of the generated inputs themselves, at states of the log.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.machine_functions import MachineFunctions
from symgen.model.combinations.base_parameters import BaseParameters
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.walk import evaluate
from symgen.model.inertial_parameters import values
from symgen.model.model import Model
from symgen.records import dataclass

State = tuple[Array, Array, Array]
# States at which linearity is looked at.
STATES_TRIED = 256
# Of the inputs, what rounding changes.
ROUNDED = 1e-9
# A parameter that is 0 is changed by this.
USUAL_CHANGE = 1.0
# Inertial parameters are changed by this share of themselves.
INERTIAL_CHANGE = 0.5


@dataclass(frozen=True, slots=True)
class EstimatedNames:
    """Parameters of the file: those of bodies, others in which u is linear, and what is kept, each with the reason."""

    inertial: tuple[str, ...]
    linear: tuple[str, ...]
    kept: tuple[tuple[str, str], ...]


def inertial_values(model: Model, numbers: Mapping[str, float]) -> Array:
    """The inertial parameters (p) for values of the parameters of the file."""
    known = dict(numbers)
    for definition in model.definitions:
        try:
            known[definition.name] = evaluate(definition.value, known)
        except KeyError:  # made of coordinates, which inertias are not
            continue
    return np.array(values(model.mechanism, lambda expression: evaluate(expression, known)))


def base_map(base: BaseParameters) -> Array:
    """Base parameters (b) from inertial parameters (p): a matrix (b, p) of numbers at this geometry."""
    made = np.zeros((len(base.base), len(base.parameters)))
    for row, one in zip(made, base.base, strict=True):
        row[base.parameters.index(one.stays)] = 1.0
        for other, form in one.added:
            row[base.parameters.index(other)] = form.value
    return made


def estimated_names(functions: MachineFunctions, state: State) -> EstimatedNames:
    """Which parameters a log can say something of."""
    model = functions.model
    step = max(1, len(state[0]) // STATES_TRIED)
    seen = state[0][::step], state[1][::step], state[2][::step]
    fixed = names_reached(model, [*geometric_expressions(model), *_acting(model)])
    of_bodies = names_reached(model, _of_bodies(model)) - fixed
    # another parameter follows from these, and its expression is worth more than a number
    free = [p.name for p in model.parameters if isinstance(p.value, Number) and p.name not in fixed]
    kept: list[tuple[str, str]] = []
    test = _Linearity(functions, seen)
    inertial = []
    for name in (name for name in free if name in of_bodies):
        if test.acts_through_bodies(name):
            inertial.append(name)
        else:
            kept.append((name, "it acts outside of bodies, too"))
    linear: list[str] = []
    beside = names_reached(model, _beside_bodies(model))
    for name in (name for name in free if name in beside and name not in of_bodies):
        why = test.why_not_linear(name, linear)
        if why is None:
            linear.append(name)
        else:
            kept.append((name, why))
    return EstimatedNames(tuple(inertial), tuple(linear), tuple(kept))


class _Linearity:
    """How the inputs depend on parameters, at some states."""

    def __init__(self, functions: MachineFunctions, state: State) -> None:
        self._functions, self._state = functions, state
        self._values = functions.parameters
        self._inputs = functions.inputs(state)
        self._columns, self._base = functions.columns(state), base_map(functions.base)
        self._size = float(np.max(np.abs(self._inputs))) or 1.0

    def acts_through_bodies(self, name: str) -> bool:
        """Whether all of its effect is that of the inertial parameters that it changes."""
        model = self._functions.model
        changed = default_like(model, self._values, {name: _changed(self._values[name])})
        moved = inertial_values(model, changed) - inertial_values(model, self._values)
        predicted = self._columns @ (self._base @ moved)
        return self._alike(self._functions.inputs(self._state, changed) - self._inputs, predicted)

    def why_not_linear(self, name: str, others: Sequence[str]) -> str | None:
        """None for a parameter in which u is linear together with the others."""
        up = self._moved({name: 1})
        slope = up - self._inputs
        if np.isfinite(slope).all() and np.max(np.abs(slope)) <= ROUNDED * self._size:
            return "this motion does not show it"
        if not self._alike(slope, self._inputs - self._moved({name: -1})):
            return "the inputs are not linear in it"
        for other in others:
            if not self._alike(self._moved({name: 1, other: 1}) - self._moved({other: 1}), slope):
                return f"the inputs are not linear in it and `{other}` together"
        return None

    def _moved(self, steps: Mapping[str, int]) -> Array:
        changed = {name: self._values[name] + sign * step_of(self._values[name]) for name, sign in steps.items()}
        return self._functions.inputs(self._state, default_like(self._functions.model, self._values, changed))

    def _alike(self, one: Array, other: Array) -> bool:
        return bool(np.isfinite(one - other).all() and np.max(np.abs(one - other)) <= ROUNDED * self._size)


def step_of(value: float) -> float:
    """What a parameter is changed by: itself, so that one step back is 0."""
    return value or USUAL_CHANGE


def default_like(model: Model, known: Mapping[str, float], changed: Mapping[str, float]) -> dict[str, float]:
    """All values, where some are changed; others that are expressions of these follow."""
    numbers: dict[str, float] = {}
    for p in model.parameters:
        if p.name in changed:
            numbers[p.name] = changed[p.name]
        else:
            numbers[p.name] = known[p.name] if isinstance(p.value, Number) else evaluate(p.value, numbers)
    return numbers


def _changed(value: float) -> float:
    return value * (1 + INERTIAL_CHANGE) if value else INERTIAL_CHANGE


def _acting(model: Model) -> Iterable[Expression]:
    """By what inputs and gravity act: neither is linear in what stands there."""
    yield from model.mechanism.gravity
    for one in model.inputs:
        yield from (expression for _, expression in one.acts_on)
        if one.velocity is not None:
            yield one.velocity


def _beside_bodies(model: Model) -> Iterable[Expression]:
    yield from (model.kinetic_energy, model.potential_energy)
    for force in model.forces:
        yield from (force.magnitude, force.velocity)
    yield from (force.expression for force in model.applied_forces)


def _of_bodies(model: Model) -> Iterable[Expression]:
    for body in model.mechanism.bodies:
        yield body.mass
        yield from body.com
        yield from (entry for row in body.inertia.rows for entry in row)
    yield from (rotor.inertia for rotor in model.mechanism.rotor_inertias)
