"""Other units: lengths, masses and times by powers of two and by a thousand, angles in degrees.

The scale factors of inputs are those of the declared units.  What a result must be multiplied with is read off the
reference: where it scales by no power of the factors, a quantity depends on units (Remark 8) and is left out by name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

from symgen.generation.runnable import SCALARS, RunnableKernels, rounded_state
from symgen.ir.kernel import Scalar, Status
from symgen.laboratory.stress.variants.degrees import DEGREES, in_degrees
from symgen.laboratory.stress.variants.dimensions import (
    NUMBER,
    Dimension,
    coordinate_dimensions,
    dimension,
    parameter_dimensions,
)
from symgen.model.model import Model
from symgen.model.quantities import MAIN
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

STATES = 4
BITS = 256
POLYNOMIAL = ("minor", "minor factored", "elimination", "nullspace")  # methods without square roots
SAME = 1e-40
# Statuses that depend on units: bounds of parameters are in those of the model file.
IN_UNITS = (Status.CONSTRAINT_RANK, Status.ACTUATION_RANK, Status.PARAMETER_RANGE)
# exponents of two for mass, length, time
POWERS_OF_TWO = (("lengths", (0, 3, 0)), ("masses", (-4, 0, 0)), ("times", (0, 0, 2)), ("all three", (3, -2, 1)))
Factors: TypeAlias = tuple[Fraction, ...]  # of mass, length, time


@dataclass(frozen=True, slots=True)
class Scaled:
    """One quantity under one change of units, over all states: the largest error in units of d + eps |y*|.

    `refused` counts states with a status of rank or of parameters: relative ranks and bounds depend on units, and
    lengths are no longer O(1).
    `covariant` is false where the exact result depends on units, so that nothing is compared.  `identical` says that
    the bits are the same after conversion, `required` that they must be.
    """

    change: str
    quantity: str
    scalar: Scalar
    covariant: bool
    units: float
    refused: int
    identical: bool
    required: bool


def scaling(reference: Reference, kernels: RunnableKernels, folder: Path) -> tuple[tuple[Scaled, ...], tuple[str, ...]]:
    """All changes of units of a model, and what is wrong (empty: nothing)."""
    model = reference.model
    names = tuple(name for name in MAIN if name in kernels.names)
    quantities = names[:1] if model.m else ()
    regular = sample_states(reference, quantities, 2 * STATES)
    states = [sample.state for sample in regular if sample.admissible][:STATES]
    scaled: list[Scaled] = []
    changes = [(what, tuple(Fraction(2) ** e for e in powers), True) for what, powers in POWERS_OF_TWO]
    if any(d[1] for d in coordinate_dimensions(model)) or any(d and d[1] for d in parameter_dimensions(model)):
        changes.append(("m in mm", (Fraction(1), Fraction(1000), Fraction(1)), False))
    for what, factors, binary in changes:
        converted = [_converted(model, state, factors) for state in states]
        scaled += _compare(what, reference, kernels, reference, kernels, states, converted, names, binary)
    angles = [c.name for c in model.coordinates if c.is_angle]
    if angles:
        turned = in_degrees(model)
        other = Reference(turned, reference.ranks)
        converted = [_in_degrees(model, state) for state in states]
        (folder / "degrees").mkdir()
        names_other = RunnableKernels(turned, folder / "degrees", names, kernels.out)
        scaled += _compare("rad in deg", reference, kernels, other, names_other, states, converted, names, False)
    return tuple(scaled), tuple(_failures(scaled))


def _failures(scaled: Sequence[Scaled]) -> list[str]:
    failures = []
    for one in scaled:
        where = f"{one.quantity}, {one.change}, {one.scalar}"
        if one.covariant and not one.units <= FACTOR:
            failures.append(f"{where}: error {one.units:.3g} times d + eps |y*|, {FACTOR:g} is allowed")
        if one.covariant and one.required and not one.identical:
            failures.append(f"{where}: powers of two change bits")
    return failures


def _compare(
    what: str,
    reference: Reference,
    kernels: RunnableKernels,
    other: Reference,
    other_kernels: RunnableKernels,
    states: Sequence[State],
    converted: Sequence[State],
    names: Sequence[str],
    binary: bool,
) -> list[Scaled]:
    scaled = []
    for name in names:
        conversion = _conversion(reference, other, states, converted, name)
        required = binary and name == "inverse_dynamics" and kernels.method(name) in POLYNOMIAL
        # reactions come from the pseudoinverse of B, which adds up what has different units
        required = required and _one_dimension(reference) and not reference.model.rough
        for scalar in SCALARS:
            worst, refused, identical = 0.0, 0, True
            for index, (state, moved) in enumerate(zip(states, converted, strict=True)):
                moved = rounded_state(moved, scalar)
                outcome = other_kernels.run(name, moved, scalar)
                if outcome.status != Status.OK:
                    worst, identical = worst if outcome.status in IN_UNITS else float("inf"), False
                    refused += 1
                    continue
                expected = expectations(other, moved, (name,), scalar, f"{what} {index}", all_literals=True)[name]
                worst = max(worst, expected.in_units(expected.distance(outcome.entries)))
                if binary and conversion is not None:
                    plain = kernels.run(name, rounded_state(state, scalar), scalar)
                    pairs = zip(plain.entries, conversion, outcome.entries, strict=True)
                    identical = identical and all(factor is None or x * factor == y for x, factor, y in pairs)
            identical = identical and binary
            scaled.append(Scaled(what, name, scalar, conversion is not None, worst, refused, identical, required))
    return scaled


def _one_dimension(reference: Reference) -> bool:
    """Whether least norms do not depend on units: inputs of one dimension, or no more of them than needed."""
    model = reference.model
    alike = len({dimension(one.unit) for one in model.inputs}) == 1
    full = reference.ranks.actuation == model.n - reference.ranks.constraints
    return full and (alike or model.m == reference.ranks.actuation)


def _conversion(
    reference: Reference, other: Reference, states: Sequence[State], converted: Sequence[State], name: str
) -> list[float | None] | None:
    """The factor of each entry, the same at every state; None for one that vanishes, and where there is no factor."""
    factors: list[Any] = []
    with precision(BITS):
        for state, moved in zip(states, converted, strict=True):
            before = reference.matrices(state, (name,), BITS)[name].entries()
            after = other.matrices(moved, (name,), BITS)[name].entries()
            ratios = [None if x.contains(0) else (y / x).mid() for x, y in zip(before, after, strict=True)]
            if not factors:
                factors = ratios
            for k, ratio in enumerate(ratios):
                if ratio is None or factors[k] is None:
                    factors[k] = ratio if factors[k] is None else factors[k]
                elif abs(float(ratio / factors[k] - 1)) > SAME:
                    return None
    return [None if factor is None else float(factor) for factor in factors]


def _converted(model: Model, state: State, factors: Factors) -> State:
    """The state with numbers in units that are smaller by the factors of mass, length, time; exact."""

    def scaled(values: Sequence[Any], dimensions: Sequence[Dimension], seconds: int = 0) -> tuple[Fraction, ...]:
        return tuple(Fraction(x) * _factor(d, factors, seconds) for x, d in zip(values, dimensions, strict=True))

    coordinates = coordinate_dimensions(model)
    inputs = [dimension(one.unit) or NUMBER for one in model.inputs]
    parameters = [d or NUMBER for d in parameter_dimensions(model)]
    return State(
        scaled(state.q, coordinates),
        scaled(state.qd, coordinates, -1),
        scaled(state.qdd, coordinates, -2),
        scaled(state.u, inputs),
        scaled(state.parameters, parameters),
    )


def _factor(dimensions: Dimension, factors: Factors, seconds: int) -> Fraction:
    mass, length, time = dimensions
    total = Fraction(1)
    for base, exponent in zip(factors, (mass, length, time + seconds), strict=True):
        total *= base ** int(exponent)
    return total


def _in_degrees(model: Model, state: State) -> State:
    """Exact conversion is not possible: pi is rounded to 60 digits."""

    def turned(values: Sequence[Any]) -> tuple[Any, ...]:
        return tuple(
            Fraction(x) * DEGREES if c.is_angle else x for x, c in zip(values, model.coordinates, strict=True)
        )

    return State(turned(state.q), turned(state.qd), turned(state.qdd), state.u, state.parameters)


