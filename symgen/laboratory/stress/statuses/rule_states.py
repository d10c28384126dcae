"""States at which a result may be wrong: towards every singular set of a model, and masses and lengths far apart.

Each state is admissible where the model allows for it, and of ordinary size in everything that is not pushed.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from symgen.laboratory.stress.families import SingularFamilies
from symgen.laboratory.stress.variants.dimensions import Dimension, parameter_dimensions
from symgen.records import dataclass
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.states import sample_states

BITS = 256
CLOSEST = 30  # half decades below 1
DECADES = (1, 2, 3, 4, 6, 9)
LENGTH: Dimension = (Fraction(0), Fraction(1), Fraction(0))
MIXED = 4  # draws of all masses, or all lengths, at random
TOWARDS = ("parameter", "input", "constraint")


@dataclass(frozen=True, slots=True)
class Pushed:
    """A state, and in words where it was pushed."""

    where: str
    state: State


def towards_singular_sets(searched: SingularFamilies, closest: int = CLOSEST) -> Iterator[Pushed]:
    """States on the curves of the families, in half decades down to `closest` of them."""
    for family in searched.families:
        if family.kind not in TOWARDS:
            continue
        for curve in family.curves:
            for k in range(closest + 1):
                d = 10 ** (-k / 2)
                state = curve(d)
                if state is not None:
                    yield Pushed(f"{family.kind} {family.label}, d = {d:.2g}", state)


def far_apart(reference: Reference, states: int = 1, decades: Sequence[int] = DECADES) -> Iterator[Pushed]:
    """Each mass, inertia and length alone times 10^k, all of a kind at random, and all masses but one made small."""
    model = reference.model
    dimensions = parameter_dimensions(model)
    heavy = [i for i, d in enumerate(dimensions) if _is_mass(d) and _given(reference, i)]
    long = [i for i, d in enumerate(dimensions) if d == LENGTH and _given(reference, i)]
    names = ("inverse_dynamics",) if model.m else ()
    regular = [sample.state for sample in sample_states(reference, names, 8) if sample.admissible][:states]
    for number, state in enumerate(regular):
        for exponent in (sign * k for k in decades for sign in (1, -1)):
            for i in (*heavy, *long):
                name = model.parameters[i].name
                yield from _with(reference, state, {i: exponent}, f"{name} times 1e{exponent}", number)
            if len(heavy) > 1 and exponent < 0:
                for i in heavy:
                    others = {j: exponent for j in heavy if j != i}
                    what = f"all masses but {model.parameters[i].name} times 1e{exponent}"
                    yield from _with(reference, state, others, what, number)
        for kind, which in (("masses", heavy), ("lengths", long)):
            for draw in range(MIXED if len(which) > 1 else 0):
                source = random.Random(f"{kind} {number} {draw}")
                drawn = {i: source.uniform(-max(decades), max(decades)) for i in which}
                yield from _with(reference, state, drawn, f"{kind} at random, draw {draw}", number)


def _is_mass(dimension: Dimension | None) -> bool:
    return dimension is not None and dimension[0] == 1 and dimension[2] == 0


def _given(reference: Reference, index: int) -> bool:
    """Whether a parameter has a value that can be multiplied."""
    value = reference.model.parameters[index].range
    return value is None or value[1] != 0


def _with(
    reference: Reference, state: State, exponents: Mapping[int, float], what: str, seed: int
) -> Iterator[Pushed]:
    parameters = [p * 10.0 ** exponents.get(i, 0) for i, p in enumerate(map(float, state.parameters))]
    pushed = admissible(reference, state.q, parameters, f"{what} {seed}")
    if pushed is not None:
        yield Pushed(what, pushed)


def admissible(
    reference: Reference, q: Sequence[Any], parameters: Sequence[float], seed: str
) -> State | None:
    """The state on V beside q with rates, accelerations and inputs that belong to these parameters."""
    model, source = reference.model, random.Random(seed)
    with precision(BITS):
        near = onto_manifold(reference.system, list(q), [ball(x) for x in parameters], reference.literals(), 1e-40)
    if near is None:
        return None
    rates = tuple(source.uniform(*map(float, c.rate_range)) for c in model.coordinates)
    accelerations = tuple(source.uniform(*map(float, c.acceleration_range)) for c in model.coordinates)
    shares = tuple(source.uniform(-1, 1) for _ in model.inputs)
    state = State(tuple(float(x) for x in near), rates, accelerations, shares, tuple(parameters))
    try:
        names = ("admissible_velocity", "admissible_acceleration")
        projected = reference.matrices(state, names, BITS)
        rates, accelerations = (tuple(float(x) for x in projected[name].entries()) for name in names)
        state = replace(state, qd=rates, qdd=accelerations)
        if model.m:
            u = reference.matrices(state, ("inverse_dynamics",), BITS)["inverse_dynamics"].entries()
            size = 2 * max(abs(float(x)) for x in u)
            state = replace(state, u=tuple(size * share for share in shares))
    except ReferenceValueError:
        return None
    return state
