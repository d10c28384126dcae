"""The variables of a unit: time, q, q_dot, q_ddot, u, parameters, and the step of the plant.

A variable's reference is its place in this order, the same in both versions of FMI.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from symgen.backends.comments import one_line
from symgen.backends.defaults import default_values
from symgen.backends.fmi.reserved import TIME, WORDS
from symgen.backends.literals import decimal_text
from symgen.model.model import Model
from symgen.naming import identifiers
from symgen.records import dataclass

# The longest step of a plant by itself in Co-Simulation; gets an ending where the model has the name.
STEP = "step_size"
# Seconds of a step inside of a communication step, unless a user says otherwise.
START_STEP = 1e-3
# Arrays of a motion, what their units have behind those of coordinates, and how what they are is told.
_ORDERS = (("q", "", ""), ("qd", "/s", "rate: "), ("qdd", "/s**2", "acceleration: "))
_HIGHEST = len(_ORDERS) - 1


@dataclass(frozen=True, slots=True)
class UnitVariable:
    """A variable of a unit, by the words of FMI.

    `place` is where the C holds it, `kind` what may be done with it there.  `initial` and `start` are empty where FMI
    has none.  Of a derivative `derivative_of` is the reference of its state.
    """

    name: str
    place: str
    kind: str
    causality: str
    variability: str
    initial: str
    start: str
    unit: str | None
    description: str
    derivative_of: int | None = None
    reference: int = 0

    @property
    def number(self) -> int:
        """Its place among the variables, counted from 1 as FMI 2.0 does."""
        return self.reference + 1


@dataclass(frozen=True, slots=True)
class Settled:
    """Which starts of a plant it brings onto the constraints: places, and rates."""

    places: bool
    rates: bool


def start_of(model: Model) -> tuple[float, ...]:
    """An assembled configuration: where the declared one leads, or the first that was found."""
    if model.assembly is not None and model.assembly.places:
        return model.assembly.places[0].q
    declared = dict(model.configuration)
    return tuple(float(declared.get(c.name, sum(c.range, Fraction(0)) / 2)) for c in model.coordinates)


def variables_of(model: Model, settled: Settled | None) -> tuple[UnitVariable, ...]:
    """Those of a plant that brings some of its starts onto the constraints, or with None those of a controller."""
    motion = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    others = [item.name for group in (model.parameters, model.inputs) for item in group]
    names = identifiers((*motion, *others), WORDS.is_taken)
    time = UnitVariable(TIME, "time", "TIME", "independent", "continuous", "", "", "s", "simulation time")
    own = [*_motion(model, settled), *_inputs(model, settled is not None), *_parameters(model)]
    listed = [time, *(replace(one, name=names[one.name]) for one in own)]
    if settled is not None:
        about = "steps of Co-Simulation are divided into steps of at most this"
        (step,) = identifiers((STEP,), {*names.values()}.__contains__).values()
        listed.append(UnitVariable(step, "step", "FIXED", "parameter", "fixed", "exact", str(START_STEP), "s", about))
    return tuple(replace(variable, reference=k) for k, variable in enumerate(listed))


def _motion(model: Model, settled: Settled | None) -> Iterator[UnitVariable]:
    """q, q_dot and q_ddot: of a plant states and what it works out, of a controller inputs."""
    starts = [decimal_text("float64", Fraction(x)) for x in start_of(model)]
    for order, (array, per, what) in enumerate(_ORDERS):
        for k, c in enumerate(model.coordinates):
            name = (c.name, c.rate, c.acceleration)[order]
            unit = None if c.unit is None else c.unit + per
            about = one_line(what + (c.description or c.name))
            start, place = "0.0" if order else starts[k], f"{array}[{k}]"
            # references of q begin at 1, behind that of time
            below = 1 + (order - 1) * model.n + k if order else None
            if settled is None:
                yield UnitVariable(name, place, "INPUT", "input", "continuous", "", start, unit, about)
            elif order == _HIGHEST:
                yield UnitVariable(
                    name, place, "COMPUTED", "output", "continuous", "calculated", "", unit, about, below
                )
            else:
                initial = "approx" if (settled.places, settled.rates)[order] else "exact"
                yield UnitVariable(name, place, "STATE", "output", "continuous", initial, start, unit, about, below)


def _inputs(model: Model, of_plant: bool) -> Iterator[UnitVariable]:
    given, made = ("INPUT", "input", "continuous", "", "0.0"), ("COMPUTED", "output", "continuous", "calculated", "")
    how = given if of_plant else made
    for k, control in enumerate(model.inputs):
        about = one_line(control.description or control.name)
        yield UnitVariable(control.name, f"u[{k}]", *how, control.unit, about)


def _parameters(model: Model) -> Iterator[UnitVariable]:
    """Their places are named by the parameter; the C may call its member otherwise."""
    values = default_values(model)
    for one in model.parameters:
        start = decimal_text("float64", values[one.name])
        how = "TUNABLE", "parameter", "tunable", "exact", start
        yield UnitVariable(one.name, f"p.{one.name}", *how, one.unit, one_line(one.description or one.name))
