"""The families of trouble of a model: curves of states, each towards something that goes wrong as d falls."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from symgen.laboratory.stress.determinants import Choices, Trouble, choices, common_troubles, joint_troubles
from symgen.laboratory.stress.variants.dimensions import parameter_dimensions
from symgen.laboratory.stress.zeros import BITS as PLACE_BITS
from symgen.laboratory.stress.zeros import Place, places
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.states import sample_states

Kind: TypeAlias = Literal[
    "parameter",
    "input",
    "constraint",
    "large angles",
    "small angles",
    "mass ratios",
    "drift",
    "near-redundant",
    "incompatible inputs",
]
ORDER: tuple[Kind, ...] = ("constraint", "input", "parameter")  # from bad to harmless
SAMPLES = 2  # places or states of each family
SINGULAR = 1e-24  # a measure below this at a place is zero
BITS = 128
MOST_JOINT = 12  # common zeros looked for
FAMILIES_OF_KIND = 3


@dataclass(frozen=True, slots=True)
class Family:
    """States at distance d for d in (0, 1]; `partitions` and `inputs` are the choices that fail as d falls.

    `meaning` says what d is.  A curve gives None where it has no state.  With `truths` (one for each curve) results
    are compared with those at that state, and what the distance from it does to the exact result is allowed for.
    """

    kind: Kind
    label: str
    meaning: str
    curves: tuple[Callable[[float], State | None], ...]
    partitions: tuple[tuple[int, ...], ...] = ()
    inputs: tuple[tuple[int, ...], ...] = ()
    truths: tuple[State, ...] = ()


@dataclass(frozen=True, slots=True)
class SingularFamilies:
    """What was found: the families, whether determinants were factored, and what has no singularity (in words).

    `partitions` counts the choices of independent coordinates, `failing` those that fail along one of the families.
    """

    families: tuple[Family, ...]
    factored: bool
    nowhere: tuple[str, ...]
    partitions: int = 0
    failing: int = 0


def search(reference: Reference, most: int | None = None) -> SingularFamilies:
    """All families of a model, in a fixed order; with `most` only that many determinants of each kind are looked at."""
    known = choices(reference)
    singular, nowhere = _singularities(reference, known, most)
    partitions = {*known.partitions, *(subset for trouble in known.troubles for subset in trouble.partitions)}
    failing = {subset for family in singular for subset in family.partitions}
    families = (*singular, *_extremes(reference))
    return SingularFamilies(families, known.factored, nowhere, len(partitions), len(failing))


def _singularities(
    reference: Reference, known: Choices, most: int | None
) -> tuple[list[Family], tuple[str, ...]]:
    families: list[Family] = []
    nowhere: list[str] = []
    for trouble in known.troubles[:most]:
        at = [(_kind(reference, place), place) for place in _places(reference, trouble)]
        if at:
            # a choice may also fail where more goes wrong; what it shows elsewhere is its own
            kind = max((kind for kind, _ in at), key=ORDER.index)
            families.append(_family(reference, kind, trouble, [place for its_kind, place in at if its_kind == kind]))
        else:
            nowhere.append(f"{trouble.label} = 0: not found on the constraint manifold")
    together = list(common_troubles(known)) if known.factored else list(joint_troubles(reference))
    for kind in ORDER[:2]:
        candidates = [trouble for its_kind, trouble in together if its_kind == kind]
        for trouble in candidates[: most or MOST_JOINT]:
            if sum(family.kind == kind for family in families) == FAMILIES_OF_KIND:
                break
            wanted = [place for place in _places(reference, trouble) if _kind(reference, place) == kind]
            if wanted:
                families.append(_family(reference, "constraint" if kind == "constraint" else "input", trouble, wanted))
        if not any(family.kind == kind for family in families):
            what = "the rank of B drops" if kind == "constraint" else "the degree of actuation drops"
            proven = known.factored and not candidates
            nowhere.append(f"{what} nowhere" if proven else f"{what}: no such configuration was found")
    return sorted(families, key=lambda family: ORDER.index(family.kind)), tuple(nowhere)


def _places(reference: Reference, trouble: Trouble) -> list[Place]:
    return places(reference, trouble, SAMPLES + 1) or places(reference, trouble, SAMPLES, parameters_too=True)


def _kind(reference: Reference, place: Place) -> Kind:
    """By the measures of singularity at the place."""
    zero = (0,) * reference.model.n
    state = State(place.q, zero, zero, (0,) * reference.model.m, place.parameters)
    try:
        first, second = reference.matrices(state, ("singularity",), 384)["singularity"].entries()
    except ReferenceValueError:
        return "constraint"
    if abs(float(first)) < SINGULAR:
        return "constraint"
    return "input" if reference.model.m and abs(float(second)) < SINGULAR else "parameter"


def _family(reference: Reference, kind: Kind, trouble: Trouble, at: Sequence[Place]) -> Family:
    curves = tuple(_curve(reference, place, f"{trouble.label} {k}") for k, place in enumerate(at[:SAMPLES]))
    return Family(
        kind, trouble.label, "distance from the singular configuration", curves, trouble.partitions, trouble.inputs
    )


def _curve(reference: Reference, place: Place, seed: str) -> Callable[[float], State | None]:
    model = reference.model
    draws = _draws(model, seed)
    scale: list[float] = []

    def at(d: float) -> State | None:
        q = place.at(reference, d)
        if q is None:
            return None
        # rounded first: rates are admissible where the kernel looks
        q = tuple(float(x) for x in q)
        state = State(q, draws.qd, draws.qdd, (0.0,) * model.m, tuple(float(x) for x in place.parameters))
        try:
            names = ("admissible_velocity", "admissible_acceleration")
            values = reference.matrices(state, names, BITS)
            rates, accelerations = (tuple(float(x) for x in values[name].entries()) for name in names)
            state = replace(state, qd=rates, qdd=accelerations)
            if model.m and not scale:
                u = reference.matrices(state, ("inverse_dynamics",), BITS)["inverse_dynamics"].entries()
                scale.append(2 * max(1.0, *(abs(float(x)) for x in u)))
        except ReferenceValueError:
            return replace(state, u=tuple(draws.u))
        return replace(state, u=tuple(x * (scale[0] if scale else 1.0) for x in draws.u))

    return at


@dataclass(frozen=True, slots=True)
class _Draws:
    qd: tuple[float, ...]
    qdd: tuple[float, ...]
    u: tuple[float, ...]


def _draws(model: Model, seed: str) -> _Draws:
    generator = random.Random(f"rates {seed}")
    return _Draws(
        tuple(generator.uniform(*map(float, c.rate_range)) for c in model.coordinates),
        tuple(generator.uniform(*map(float, c.acceleration_range)) for c in model.coordinates),
        tuple(generator.uniform(-1, 1) for _ in model.inputs),
    )


def _extremes(reference: Reference) -> list[Family]:
    """Families around regular states: angles, masses, drift, rates that violate the constraints."""
    model = reference.model
    regular = _regular(reference)
    angles = [i for i, c in enumerate(model.coordinates) if c.is_angle]
    families: list[Family] = []
    curves: tuple[Callable[[float], State | None], ...]
    dependent = reference.ranks.constraints < model.r
    if angles:
        curves = tuple(_large_angles(state, angles) for state in regular)
        families.append(Family("large angles", "whole turns added to every angle", "one radian over the angle", curves))
        curves = tuple(_small_angles(reference, state, angles, k) for k, state in enumerate(regular))
        families.append(Family("small angles", "every angle near zero", "size of the angles in rad", curves))
    heavy = [i for i, d in enumerate(parameter_dimensions(model)) if d is not None and d[0] == 1 and d[2] == 0]
    for i in heavy:
        name = model.parameters[i].name
        curves = tuple(_scaled(state, i, sign) for state in regular[:1] for sign in (1, -1))
        meaning = f"{name} multiplied or divided by d"
        families.append(Family("mass ratios", name, meaning, curves))
    if any(row.kind == "geometric" for row in model.constraints):
        families.append(_near_redundant(regular) if dependent else _drift(regular))
    if model.r:
        curves = tuple(_moved(state, "qd", f"rates {k}", 1.0) for k, state in enumerate(regular))
        label = "rates and accelerations that violate the constraints"
        families.append(Family("incompatible inputs", label, "relative size of the violation", curves))
    return families


def _drift(regular: Sequence[State]) -> Family:
    curves = tuple(_moved(state, "q", f"drift {k}", 0.1) for k, state in enumerate(regular))
    return Family("drift", "configuration off the constraints", "ten times the distance from V", curves)


def _near_redundant(regular: Sequence[State]) -> Family:
    """Rows that depend on each other on V are independent off it by as much as the configuration has drifted.

    A result off V is a matter of definition there: the one on V is what is meant.
    """
    curves = tuple(_moved(state, "q", f"drift {k}", 0.01) for k, state in enumerate(regular))
    label = "dependent rows, configuration off the constraints"
    return Family("near-redundant", label, "a hundred times the distance from V", curves, truths=tuple(regular))


def near_redundant(reference: Reference) -> Family:
    """The family of a system with dependent geometric rows."""
    return _near_redundant(_regular(reference))


def _regular(reference: Reference) -> list[State]:
    names = ("inverse_dynamics",) if reference.model.m else ()
    return [s.state for s in sample_states(reference, names, 8) if s.admissible][:SAMPLES]


def _large_angles(state: State, angles: Sequence[int]) -> Callable[[float], State]:
    def at(d: float) -> State:
        turns = round((1 / d - 1) / 6.283185307179586)
        q = [x + turns * 6.283185307179586 if i in angles else x for i, x in enumerate(state.q)]
        return replace(state, q=tuple(q))

    return at


def _small_angles(
    reference: Reference, state: State, angles: Sequence[int], seed: int
) -> Callable[[float], State | None]:
    """Off V in general, as measured states are; on it where rows depend on each other."""
    generator = random.Random(f"small {seed}")
    shares = [generator.uniform(0.2, 1) * generator.choice((-1, 1)) for _ in state.q]
    dependent = reference.ranks.constraints < reference.model.r

    def at(d: float) -> State | None:
        q = [d * shares[i] if i in angles else x for i, x in enumerate(state.q)]
        if dependent:
            with precision(PLACE_BITS):
                parameters = [ball(x) for x in state.parameters]
                near = onto_manifold(reference.system, q, parameters, reference.literals(), 1e-40)
            if near is None:
                return None
            q = [float(x) for x in near]
        return replace(state, q=tuple(q))

    return at


def _scaled(state: State, index: int, sign: int) -> Callable[[float], State]:
    p = state.parameters
    return lambda d: replace(state, parameters=(*p[:index], p[index] * d**sign, *p[index + 1 :]))


def _moved(state: State, part: Literal["q", "qd"], seed: str, share: float) -> Callable[[float], State]:
    """A configuration, or rates and accelerations, off by `share` d of their size."""
    generator = random.Random(seed)
    shifts = [[generator.uniform(-1, 1) for _ in state.q] for _ in range(2)]

    def moved(values: Sequence[Any], d: float, by: Sequence[float]) -> tuple[float, ...]:
        size = max(abs(x) for x in values) or 1.0
        return tuple(x + share * d * size * s for x, s in zip(values, by, strict=True))

    if part == "q":
        return lambda d: replace(state, q=moved(state.q, d, shifts[0]))
    return lambda d: replace(state, qd=moved(state.qd, d, shifts[0]), qdd=moved(state.qdd, d, shifts[1]))
