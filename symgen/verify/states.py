"""Admissible states for verification: on the constraint manifold, away from singularities, seeded and deterministic."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from math import comb, isfinite, pi, sqrt
from typing import Any

from symgen.activity import working
from symgen.ir.kernel import Scalar
from symgen.verify.reference import Reference, ReferenceValueError, State
from symgen.verify.reference_manifold import admissible, exceeds, onto_manifold, starts
from symgen.verify.reference_quantities import NEED_GRADIENTS
from symgen.verify.reference_system import ParameterValues, default_parameters
from symgen.verify.reference_tape import ball, precision

FEWEST_STATES = 8
USUAL_STATES = 64
LONGEST_SECONDS = 20.0
REGULAR = 1e-3
SAMPLING_BITS = 128
DRIFT = 1e-3
REST = 1e-25
# How far angles may lie outside of their ranges in states.
TURNS = 2
TYPICAL_POINTS = 8
PROJECTED = ("admissible_velocity", "admissible_acceleration")


class VerificationError(Exception):
    """Verification could not be carried out at all; the text says why."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A state with exact floats; `admissible` when rates and accelerations satisfy the constraints up to rounding."""

    state: State
    admissible: bool
    measures: tuple[float, float]


def affordable_states(reference: Reference, quantities: Sequence[str], wanted: int) -> int:
    """How many of `wanted` states fit in 20 s, by a count of operations (never by a clock), but 8 at least."""
    system, ranks = reference.system, reference.ranks
    subsets = comb(system.r, ranks.constraints)
    operations = system.operations(gradients=not NEED_GRADIENTS.isdisjoint(quantities)) + 40 * system.n**3 * subsets
    seconds_per_state = 30 * 1.3e-7 * operations
    return max(FEWEST_STATES, min(wanted, int(LONGEST_SECONDS / seconds_per_state)))


def sample_states(reference: Reference, quantities: Sequence[str], count: int, seed: int = 0) -> tuple[Sample, ...]:
    """`count` states (fewer when V is hard to find), rounded to float64.

    Rates and accelerations are projected onto the constraints in the even ones and arbitrary in the others; every
    fourth is moved off V by about 1e-3, as measured states are, unless the constraints depend on each other or the
    inputs reach more directions there than on V: what they give is defined on V alone then.
    Raises VerificationError when fewer than 8 are found.
    """
    with precision(SAMPLING_BITS):
        inside: list[Sample] = []
        outside: list[_Regular] = []
        with working("", count) as work:
            for found_state, in_range in _candidates(reference, count, seed):
                if not in_range:
                    outside.append(found_state)
                elif (sample := _sample(reference, quantities, found_state)) is not None:
                    inside.append(sample)
                if len(inside) == count:
                    break
                work.done, work.part = len(inside), f"{len(inside)} of {count} found"
        others = (_sample(reference, quantities, found_state) for found_state in outside)
        found = [*inside, *islice((sample for sample in others if sample is not None), count - len(inside))]
    if len(found) < FEWEST_STATES:
        raise VerificationError(
            f"{reference.model.name}: only {len(found)} regular configurations on the constraint manifold were found "
            f"({FEWEST_STATES} are needed); give a start under `configuration` and the ranges of the coordinates"
        )
    return tuple(found)


def rounded(sample: Sample, scalar: Scalar) -> Sample:
    """The sample with every number rounded to the scalar type."""
    if scalar == "float64":
        return sample
    state = sample.state
    parts = (state.q, state.qd, state.qdd, state.u, state.parameters)
    return replace(sample, state=State(*(tuple(_single(x) for x in part) for part in parts)))


def _single(value: Any) -> float:
    return float(struct.unpack("f", struct.pack("f", value))[0])


@dataclass(frozen=True, slots=True)
class _Regular:
    """A regular state as drawn, rates and accelerations not projected yet, and the inputs as shares of their size."""

    state: State
    shares: tuple[float, ...]
    admissible: bool
    values: dict[str, tuple[float, ...]]


def _candidates(reference: Reference, count: int, seed: int) -> Iterator[tuple[_Regular, bool]]:
    """Regular states, and whether the coordinates lie in their ranges."""
    generator = random.Random(f"states {seed}")
    system = reference.system
    points = starts(system, generator, 6 * count + 60)
    literals = reference.literals()
    known = reference.model.assembly
    tied = () if known is None else known.tied
    ranged = [p.name for p in reference.model.parameters if p.range is not None and p.name not in tied]
    varied = ParameterValues(reference.model, ranged)
    usual = [float(x) for x in _parameters(varied, generator, vary=False)]
    typical = _row_lengths(reference, points[:TYPICAL_POINTS], usual)
    if known is not None and reference.ranks.constraints < reference.model.r:
        # of rows that depend on each other some have no gradient anywhere on V, and are no drop of rank there
        on_it = _row_lengths(reference, [place.q for place in known.places[:TYPICAL_POINTS]], usual)
        typical = [0.0 if here < REGULAR * x else x for here, x in zip(on_it, typical, strict=True)]
    least = _least_measures(reference, points[:TYPICAL_POINTS], usual)
    last: list[Any] | None = None
    kept = {True: 0, False: 0}
    met: list[tuple[Sequence[float], Sequence[float]]] = []
    for index in range(2 * len(points)):
        if index == len(points):
            if sum(kept.values()) >= FEWEST_STATES or not system.r_geometric:
                return
            if met and not sum(kept.values()):
                # where loops stand still measures and rows are the same all along a branch, and may be small
                measures, lengths = (map(max, zip(*sizes, strict=True)) for sizes in zip(*met, strict=True))
                least = tuple(min(low, most / 10) for low, most in zip(least, measures, strict=True))
                typical = [min(usual, most) for usual, most in zip(typical, lengths, strict=True)]
        exact = _parameters(varied, generator, vary=index > 0)
        parameters = [float(x) for x in exact]
        if index >= len(points):
            # most of V are other branches or singular: along the one that is meant
            start = _along(reference, last or _known(reference, points[0], index), exact, generator)
        elif last is not None and index % 4 and system.r_geometric:
            start = _step(reference, last, generator)
        else:
            start = points[index]
        # lengths that others follow from are rounded afterwards: a linkage may close for their exact values alone
        q = onto_manifold(system, start, exact, literals, rounded=reference.ranks.rounded)
        if q is None or exceeds(system, reference.ranks, q, exact, literals):
            continue
        if _turned_away(reference, q):
            continue
        in_range = _in_ranges(reference, q)
        place = _settled(q, [c.range for c in reference.model.coordinates])
        # what lies outside is rarely needed
        needed = _measured(reference) if in_range else ()
        regular = _regular(reference, place, parameters, typical, least, met, kept[in_range], generator, needed)
        if regular is None:
            continue
        last = q
        kept[in_range] += 1
        yield regular, in_range


def _known(reference: Reference, start: Sequence[float], index: int) -> Sequence[float]:
    """One of the configurations that loading found."""
    known = reference.model.assembly
    return start if known is None else known.places[index % len(known.places)].q


def _along(
    reference: Reference, q: Sequence[Any], parameters: Sequence[Any], generator: random.Random
) -> Sequence[float]:
    """A start off q in a direction that the geometric constraints allow, up to a fifth of the ranges away."""
    widths = [float(c.range[1] - c.range[0]) for c in reference.model.coordinates]
    reach = 0.2 * generator.random()
    shift = [reach * generator.gauss(0, 1) * width for width in widths]
    allowed = admissible(reference.system, q, shift, parameters, reference.literals())
    return [float(x) + float(a) for x, a in zip(q, allowed, strict=True)]


def _row_lengths(reference: Reference, points: Sequence[Sequence[float]], parameters: Sequence[float]) -> list[float]:
    """The largest length of each row of B over some points, on V or off it."""
    lengths = [0.0] * reference.model.r
    for q in points:
        try:
            rows = reference.matrices(_at_rest(reference, q, parameters), ["constraint_jacobian"], SAMPLING_BITS)
        except ReferenceValueError:
            continue
        found = _lengths(_floats(rows["constraint_jacobian"]), reference.model.n)
        lengths = [max(pair) if isfinite(pair[1]) else pair[0] for pair in zip(lengths, found, strict=True)]
    return lengths


def _least_measures(
    reference: Reference, points: Sequence[Sequence[float]], parameters: Sequence[float]
) -> tuple[float, ...]:
    """What the measures of `singularity` must be at a regular state.

    They are products of about delta numbers between 0 and 1; many rows, or units that make columns of very different
    size, leave them small everywhere, so that no more than a tenth of the largest found is asked for.
    """
    regular = REGULAR ** max(1.0, (reference.model.n - reference.ranks.constraints) / 2)
    found = []
    for q in points:
        try:
            state = _at_rest(reference, q, parameters)
            found.append(_floats(reference.matrices(state, ["singularity"], SAMPLING_BITS)["singularity"]))
        except ReferenceValueError:
            continue
    largest = [max((x for x in column if isfinite(x)), default=1.0) for column in zip(*found, strict=True)]
    return tuple(min(regular, x / 10) for x in largest or (1.0, 1.0))


def _at_rest(reference: Reference, q: Sequence[float], parameters: Sequence[float]) -> State:
    n, m = reference.model.n, reference.model.m
    return State(tuple(q), (0.0,) * n, (0.0,) * n, (0.0,) * m, tuple(parameters))


def _parameters(varied: ParameterValues, generator: random.Random, vary: bool) -> list[Any]:
    """Parameter values as balls: those with a range drawn from it."""
    chosen = {
        parameter.name: generator.uniform(float(parameter.range[0]), float(parameter.range[1]))
        for parameter in varied.model.parameters
        if parameter.range is not None
    }
    return varied(chosen) if vary else default_parameters(varied.model)


def _step(reference: Reference, q: Sequence[Any], generator: random.Random) -> list[float]:
    """A start near q: a random step, a tenth of the ranges wide, that the projection brings back to V."""
    return [
        float(x) + generator.gauss(0, 0.1) * float(c.range[1] - c.range[0])
        for x, c in zip(q, reference.model.coordinates, strict=True)
    ]


def _lengths(rows: Sequence[float], n: int) -> list[float]:
    """The length of each row of n numbers."""
    return [sqrt(sum(x**2 for x in rows[start : start + n])) for start in range(0, len(rows), n)]


def _measured(reference: Reference) -> tuple[str, ...]:
    """What makes a sample of a regular state."""
    return *PROJECTED, *(("inverse_dynamics",) if reference.model.m else ())


def _regular(
    reference: Reference,
    q: Sequence[float],
    parameters: Sequence[float],
    typical: Sequence[float],
    least: Sequence[float],
    met: list[tuple[Sequence[float], Sequence[float]]],
    index: int,
    generator: random.Random,
    needed: Sequence[str],
) -> _Regular | None:
    """A state at q with what is `needed` of it, or None near a singularity; adds to what was `met`: the measures of
    ranks, and the lengths of rows."""
    model = reference.model
    rates = [generator.uniform(*map(float, c.rate_range)) for c in model.coordinates]
    accelerations = [generator.uniform(*map(float, c.acceleration_range)) for c in model.coordinates]
    shares = [generator.uniform(-1, 1) for _ in model.inputs]
    shifts = [generator.uniform(-1, 1) for _ in model.coordinates]
    admissible = index % 2 == 0
    if index % 4 == 3 and reference.system.r_geometric and reference.ranks.constraints == model.r:
        moved = [x + DRIFT * s * max(abs(x), 0.1) for x, s in zip(q, shifts, strict=True)]
        given = [*map(ball, moved)], [*map(ball, parameters)]
        if not exceeds(reference.system, reference.ranks, *given, reference.literals()):
            q = moved
    zero = (0.0,) * model.m
    state = State(tuple(q), tuple(rates), tuple(accelerations), zero, tuple(parameters))
    try:
        values = _values(reference, state, ("singularity", "constraint_jacobian", *needed))
    except ReferenceValueError:
        return None
    lengths = _lengths(values["constraint_jacobian"], model.n)
    if all(map(isfinite, (*values["singularity"], *lengths))):
        met.append((values["singularity"], lengths))
    if not all(x >= low and isfinite(x) for x, low in zip(values["singularity"], least, strict=True)):
        return None
    # the measures compare directions of rows only; a row that all but vanishes is a drop of rank, too
    if not all(isfinite(x) and x >= REGULAR * usual for x, usual in zip(lengths, typical, strict=True)):
        return None
    return _Regular(state, tuple(shares), admissible, values)


def _values(reference: Reference, state: State, names: Sequence[str]) -> dict[str, tuple[float, ...]]:
    found = reference.matrices(state, names, SAMPLING_BITS)
    return {name: (_rates if name in PROJECTED else _floats)(matrix) for name, matrix in found.items()}


def _sample(reference: Reference, quantities: Sequence[str], regular: _Regular) -> Sample | None:
    """A regular state with its inputs, rates and accelerations, or None outside the domain of a quantity."""
    state, values = regular.state, regular.values
    try:
        if missing := [name for name in _measured(reference) if name not in values]:
            values = values | _values(reference, state, missing)
        if regular.admissible:
            coordinates = reference.model.coordinates
            rates = _settled(values["admissible_velocity"], [c.rate_range for c in coordinates])
            accelerations = _settled(values["admissible_acceleration"], [c.acceleration_range for c in coordinates])
            state = replace(state, qd=tuple(rates), qdd=tuple(accelerations))
        if regular.shares:
            scale = 2 * max(1.0, *(abs(x) for x in values["inverse_dynamics"]))
            state = replace(state, u=tuple(scale * share for share in regular.shares))
        everything = reference.matrices(state, quantities, SAMPLING_BITS)
    except ReferenceValueError:
        return None
    if not all(isfinite(x) for matrix in everything.values() for x in _floats(matrix)):
        return None
    first, second = values["singularity"]
    return Sample(state, regular.admissible, (first, second))


def _settled(values: Sequence[Any], ranges: Sequence[tuple[Any, Any]]) -> list[float]:
    """Floats, with 0 for what searches and projections leave of it: squares of such rests underflow in float32."""
    pairs = zip(map(float, values), ranges, strict=True)
    return [0.0 if abs(x) < REST * float(high - low) else x for x, (low, high) in pairs]


def _floats(matrix: Any) -> tuple[float, ...]:
    return tuple(map(float, matrix.entries()))


def _rates(matrix: Any) -> tuple[float, ...]:
    """Entries rounded to float64; what cannot be told from 0 is 0, such as the rate of a joint that cannot move."""
    return tuple(0.0 if x.is_finite() and x.contains(0) else float(x) for x in matrix.entries())


def _in_ranges(reference: Reference, q: Sequence[Any]) -> bool:
    """Whether every coordinate lies in its range, but for a hundredth of its width."""
    for x, coordinate in zip(q, reference.model.coordinates, strict=True):
        low, high = map(float, coordinate.range)
        slack = 0.01 * (high - low)
        if not low - slack <= x <= high + slack:
            return False
    return True


def _turned_away(reference: Reference, q: Sequence[Any]) -> bool:
    """Whether an angle is turns outside of its range, where one step after another leads and nothing new is met."""
    return any(
        c.is_angle and not float(c.range[0]) - TURNS * 2 * pi <= x <= float(c.range[1]) + TURNS * 2 * pi
        for x, c in zip(q, reference.model.coordinates, strict=True)
    )
