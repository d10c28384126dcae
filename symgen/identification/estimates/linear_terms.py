"""Parameters beside those of bodies in which the inputs are linear: friction, dampers, springs.

Which these are is asked of the generated inputs themselves, at states of the log.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from symgen.identification.acting import acting
from symgen.identification.arrays import Array
from symgen.identification.combinations import default_like
from symgen.identification.machine_functions import MachineFunctions
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.expressions.expression import Expression, Number
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
    """Parameters of the file: those of bodies, others in which u is linear, and what is kept, each with the reason.

    `gains` are factors of inputs.
    """

    inertial: tuple[str, ...]
    linear: tuple[str, ...]
    kept: tuple[tuple[str, str], ...]
    gains: tuple[str, ...] = ()

    @property
    def with_columns(self) -> tuple[str, ...]:
        """Those that have a column of their own, in the order of these."""
        return (*self.linear, *self.gains)

    def with_gain_kept(self, name: str, why: str) -> EstimatedNames:
        """The same, where a gain stays as it is."""
        return replace(self, kept=(*self.kept, (name, why)), gains=tuple(one for one in self.gains if one != name))


def some_states(state: State) -> State:
    """Some of the states, all along a motion."""
    step = max(1, len(state[0]) // STATES_TRIED)
    return state[0][::step], state[1][::step], state[2][::step]


def estimated_names(functions: MachineFunctions, state: State) -> EstimatedNames:
    """Which parameters a log can say something of."""
    model = functions.model
    seen = some_states(state)
    fixed = names_reached(model, [*geometric_expressions(model), *acting(model)]) | functions.combinations.held
    of_bodies = functions.combinations.reached - fixed
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
    gains = () if model.identify is None else model.identify.gains
    return EstimatedNames(tuple(inertial), tuple(linear), tuple(kept), gains)


class _Linearity:
    """How the inputs depend on parameters, at some states."""

    def __init__(self, functions: MachineFunctions, state: State) -> None:
        self._functions, self._state = functions, state
        self._values = functions.parameters
        self._inputs = functions.inputs(state)
        self._columns = functions.columns(state)
        self._size = float(np.max(np.abs(self._inputs))) or 1.0

    def acts_through_bodies(self, name: str) -> bool:
        """Whether all of its effect is that of the inertial parameters that it changes."""
        made = self._functions.combinations
        changed = default_like(self._functions.model, self._values, {name: _changed(self._values[name])})
        predicted = self._columns @ (made.at(changed) - made.at(self._values))
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
    """What a parameter is changed by: half of itself, as kernels may be bounded to values other than 0."""
    return value / 2 or USUAL_CHANGE


def _changed(value: float) -> float:
    return value * (1 + INERTIAL_CHANGE) if value else INERTIAL_CHANGE


def _beside_bodies(model: Model) -> Iterable[Expression]:
    yield from (model.kinetic_energy, model.potential_energy)
    for force in model.forces:
        yield from (force.magnitude, force.velocity)
    yield from (force.expression for force in model.applied_forces)
