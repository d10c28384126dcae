"""The rule of statuses: status 0 means within the tolerance, and a status means that some measure says so.

A model is swept towards its singular sets and with masses and lengths far apart, in both scalar types.  Counted are
results of status 0 beyond 16 units of d + eps |y*|, and statuses where no measure is below its threshold.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from symgen.generation.runnable import SCALARS, STRESSED, RunnableKernels, rounded_state
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar, Status
from symgen.laboratory.stress.statuses.rule_measures import ScaledMeasures
from symgen.laboratory.stress.statuses.rule_states import Pushed
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.tolerance import FACTOR, Expectation, expectations

# Before a result is called wrong, d is the largest change in so many more draws of 8 directions (decision 25).
MORE_DRAWS = 7
# A measure below this many n eps (squared for squares of volumes) is a reason for a status.
SMALL = 1e3
# Beyond half of these sums of angles may leave the range of sine and cosine.
ANGLE_LIMITS: dict[Scalar, float] = {"float64": 1e5, "float32": 100.0}
RANGES: dict[Scalar, tuple[float, float]] = {"float64": (2.0**-1022, 2.0**1023), "float32": (2.0**-126, 2.0**127)}


@dataclass(frozen=True, slots=True)
class Case:
    """One state of one kernel: `units` of error with status 0, else the status and the smallest measure."""

    where: str
    status: int
    units: float
    measure: float
    state: State


@dataclass(frozen=True, slots=True)
class Held:
    """What was counted of one kernel in one scalar type; `beyond` and `unexplained` break the rule."""

    quantity: str
    scalar: Scalar
    states: int
    answered: int
    largest: float
    beyond: tuple[Case, ...]
    unexplained: tuple[Case, ...]

    @property
    def statuses(self) -> int:
        """How many states have another status than 0."""
        return self.states - self.answered

    def to_json(self) -> dict[str, Any]:
        """The counts."""
        return {
            "quantity": self.quantity,
            "scalar": self.scalar,
            "states": self.states,
            "answered": self.answered,
            "largest": self.largest,
            "beyond": len(self.beyond),
            "unexplained": len(self.unexplained),
        }


def counted(
    reference: Reference,
    kernels: RunnableKernels,
    pushed: Iterable[Pushed],
    quantities: Sequence[str] = STRESSED,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Held, ...]:
    """The rule at given states, for those of the quantities that there are kernels of."""
    names = tuple(name for name in quantities if name in kernels.names)
    counts = {(name, scalar): _Count() for scalar in SCALARS for name in names}
    measures = ScaledMeasures(reference)
    for one in pushed:
        progress(one.where)
        for scalar in SCALARS:
            for name, case in _cases(reference, kernels, names, measures, one, scalar):
                counts[name, scalar].add(case)
    return tuple(
        Held(name, scalar, c.states, c.answered, c.largest, tuple(c.beyond), tuple(c.unexplained))
        for (name, scalar), c in counts.items()
    )


def breaches(held: Sequence[Held]) -> tuple[str, ...]:
    """In words, what breaks the rule worst in each kernel."""
    sentences = []
    for one in held:
        if one.beyond:
            worst = max(one.beyond, key=lambda case: case.units)
            sentences.append(
                f"{one.quantity}, {one.scalar}: {len(one.beyond)} of {one.answered} results of status 0 are beyond the "
                f"tolerance, at most {worst.units:.2g} units: {worst.where}"
            )
        if one.unexplained:
            case = one.unexplained[0]
            sentences.append(
                f"{one.quantity}, {one.scalar}: {len(one.unexplained)} of {one.states} states have a status while no "
                f"measure is below its threshold, as status {case.status}: {case.where}"
            )
    return tuple(sentences)


class _Count:
    def __init__(self) -> None:
        self.states = self.answered = 0
        self.largest = 0.0
        self.beyond: list[Case] = []
        self.unexplained: list[Case] = []

    def add(self, case: Case) -> None:
        self.states += 1
        if case.status == Status.OK:
            self.answered += 1
            self.largest = max(self.largest, case.units)
            if not case.units <= FACTOR:
                self.beyond.append(case)
        elif case.measure > 1:
            self.unexplained.append(case)


def _cases(
    reference: Reference,
    kernels: RunnableKernels,
    names: Sequence[str],
    measures: ScaledMeasures,
    pushed: Pushed,
    scalar: Scalar,
) -> Iterator[tuple[str, Case]]:
    state = rounded_state(pushed.state, scalar)
    if not all(map(math.isfinite, (*state.q, *state.qd, *state.qdd, *state.u, *state.parameters))):
        return
    outcomes = {name: kernels.run(name, state, scalar) for name in names}
    seed = f"{scalar} {pushed.where}"
    expected = _expected(reference, state, names, scalar, seed)
    known = measures.at(state) if any(outcome.status for outcome in outcomes.values()) else {}
    for name, outcome in outcomes.items():
        one = expected.get(name)
        if outcome.status == Status.OK:
            if one is None:
                continue  # the reference has no value to compare with
            units = _units(one, outcome.entries)
            if not units <= FACTOR:
                units = _units(of_more_draws(reference, state, name, scalar, seed, one), outcome.entries)
            yield name, Case(pushed.where, 0, units, 1.0, state)
        else:
            smallest = _in_thresholds(reference.model, known, Status(outcome.status), state, scalar, one)
            yield name, Case(pushed.where, outcome.status, 0.0, smallest, state)


def _expected(
    reference: Reference, state: State, names: Sequence[str], scalar: Scalar, seed: str
) -> dict[str, Expectation]:
    try:
        return expectations(reference, state, names, scalar, seed, all_literals=True)
    except ReferenceValueError:
        by_name: dict[str, Expectation] = {}
        for name in names:
            try:
                by_name |= expectations(reference, state, (name,), scalar, seed, all_literals=True)
            except ReferenceValueError:
                continue
        return by_name


def _units(expected: Expectation, entries: Sequence[float]) -> float:
    if not all(map(math.isfinite, entries)):
        return math.inf
    return expected.in_units(expected.distance(entries))


def of_more_draws(
    reference: Reference, state: State, name: str, scalar: Scalar, seed: str, known: Expectation
) -> Expectation:
    """The expectation with the largest d of more draws."""
    draws = [
        expectations(reference, state, (name,), scalar, f"{seed} {k}", all_literals=True)[name]
        for k in range(MORE_DRAWS)
    ]
    return replace(known, unit=max(one.unit for one in (known, *draws)))


def _in_thresholds(
    model: Model,
    known: dict[Status, float],
    status: Status,
    state: State,
    scalar: Scalar,
    expected: Expectation | None,
) -> float:
    """The smallest measure that explains a status, in units of its threshold: at most 1 where there is a reason."""
    small = SMALL * model.n * float(UNIT_ROUNDOFF[scalar])
    if status == Status.PARAMETER_RANGE:
        return 0.0  # a bound that derivation.json gives, and nothing else
    if status == Status.COORDINATE_RANGE:
        ranges = [map(float, c.range) for c in model.coordinates if c.has_range]
        places = [x for x, c in zip(state.q, model.coordinates, strict=True) if c.has_range]
        return 2.0 if all(low <= x <= high for x, (low, high) in zip(places, ranges, strict=True)) else 0.0
    if status == Status.ANGLE_RANGE:
        angles = [abs(x) for x, c in zip(state.q, model.coordinates, strict=True) if c.is_angle]
        return 2.0 if max(angles, default=0.0) < ANGLE_LIMITS[scalar] / 2 else 0.0
    if status == Status.FRICTION_LOCK:
        return known.get(status, 2.0)
    if status == Status.NOT_FINITE:
        return 2.0 if _representable(expected, scalar) else 0.0
    given: Any = {
        Status.CONSTRAINT_RANK: model.constraint_rank_tolerance,
        Status.ACTUATION_RANK: model.actuation_rank_tolerance,
    }.get(status)
    # where rows meet, masses along what they leave are not determined either, and the other way round
    ranks = min(known[Status.CONSTRAINT_RANK], known[Status.ACTUATION_RANK] if status == Status.ACTUATION_RANK else 1.0)
    reasons = [ranks / max(small**2, float(given or 0) * SMALL)]
    if status == Status.MASS_RANK:
        reasons.append(known[Status.MASS_RANK] / small)
    return min(reasons)


def _representable(expected: Expectation | None, scalar: Scalar) -> bool:
    """Whether a result is one of the scalar type at all."""
    low, high = RANGES[scalar]
    return expected is not None and (expected.size == 0 or low < expected.size < high)
