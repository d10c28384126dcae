"""The rule of statuses on draws: states led towards singular sets, masses and lengths far apart, both scalar types.

Status 0 means that a result is within the tolerance, a status that rows, inputs or masses are near a drop of rank.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symgen.laboratory.zoo.approach import KINDS, Approach
from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.witness.generated import targets
from symgen.laboratory.zoo.witness.kkt import GenericRanks
from symgen.laboratory.zoo.witness.reading.expressions import NotReadError
from symgen.laboratory.zoo.witness.results import JudgedResult
from symgen.laboratory.zoo.witness.states import FloatState, Walker
from symgen.laboratory.zoo.witness.witness import ALLOWED, CERTAIN, Witness

# regular states that are led on, and how many of them are looked at in a decade
STARTS, PER_DECADE = 3, 2
# configurations that are scattered for starts, and how many of them are taken
SCATTERED, NEAREST = 60, 3
EXPONENTS = (-9, -6, -3, 3, 6, 9)
SCALED = "parameters"
# where one rounding of the inputs moves as much of the truth, a status needs no other reason
VAGUE = 0.1
STATUSES = {
    1: "not finite",
    2: "constraint rank",
    3: "actuation rank",
    4: "angle range",
    5: "mass rank",
    6: "parameter range",
    13: "coordinate range",
    11: "limits",
    12: "friction lock",
}
ANGLE_RANGE, PARAMETER_RANGE, COORDINATE_RANGE = 4, 6, 13
# angles up to twice this have sines in every kernel: sums of two are beyond it
ANGLES = {"float64": 5e4, "float32": 50.0}
BEYOND, UNEXPLAINED, UNKNOWN, ANSWERED = "beyond", "unexplained", "no truth", "answered"


@dataclass(frozen=True)
class LedState:
    """A state, in words where it was led, the generic ranks of its system, and how far what was led is from a drop."""

    kind: str
    where: str
    state: FloatState
    ranks: GenericRanks
    distance: float = 1.0


@dataclass(frozen=True)
class Violation:
    """A result of status 0 beyond the tolerance, in units of d + eps |y*|, or a status at a clear state."""

    kind: str
    where: str
    target: str
    quantity: str
    comparison: JudgedResult
    state: FloatState

    @property
    def text(self) -> str:
        """In a line."""
        case, at = self.comparison, f"{self.target}, {self.quantity}, {self.where}"
        if case.status:
            return f"{at}: {STATUSES[case.status]} although clear to {case.clear:.1e}"
        return f"{at}: {ALLOWED * case.units:.3g} units, relative error {case.relative:.1e}, clear {case.clear:.1e}"


@dataclass(frozen=True)
class SweepCounts:
    """What was counted of a draw by kind, scalar type and outcome, and what violates the rule."""

    counts: Mapping[tuple[str, str, str], int]
    violations: tuple[Violation, ...] = ()

    def of(self, *outcomes: str) -> int:
        """How often these outcomes were met."""
        return sum(count for (_, _, outcome), count in self.counts.items() if outcome in outcomes)


def sweep(description: Description, folder: Path) -> SweepCounts:
    """What was generated of a description, at all states that are led on; a text that is not read counts nothing."""
    try:
        witness = Witness(description.text, description.start, description.text, description.files)
    except NotReadError:
        return SweepCounts({})
    members = witness.opened(folder)
    defaults = witness.defaults()
    walker = witness.walker()
    starts, ranks = walker.states(defaults, STARTS)
    scaled = [name for name in members if name in witness.shaping and defaults[name]]
    near = _towards(walker, defaults, starts, ranks, description.text)
    far = _scaled(walker, defaults, starts, ranks, scaled)
    return compared(witness, folder, str(description.blocks["model"]), [*near, *far])


def compared(witness: Witness, folder: Path, model: str, led: Iterable[LedState]) -> SweepCounts:
    """The generated C of both types at given states."""
    called = [target for target in targets(folder, model) if target.name != "Python"]
    counts: Counter[tuple[str, str, str]] = Counter()
    violations = []
    for one in led:
        for target in called:
            for quantity in target.quantities:
                judged = witness.compare(target, quantity, one.state, one.ranks)
                far = one.distance > CERTAIN[target.scalar]
                if judged is not None and judged.status == PARAMETER_RANGE:
                    far = one.kind != SCALED
                elif judged is not None and judged.status == COORDINATE_RANGE:
                    far = True
                elif judged is not None and judged.status == ANGLE_RANGE:
                    far = max(map(abs, one.state.q)) < ANGLES[target.scalar]
                elif far and judged is not None and judged.certain:
                    far = witness.unit(quantity, one.state, one.ranks, target.scalar) < VAGUE
                for outcome in _outcomes(judged, far):
                    counts[one.kind, target.scalar, outcome] += 1
                    if judged is not None and outcome in (BEYOND, UNEXPLAINED):
                        violations.append(Violation(one.kind, one.where, target.name, quantity, judged, one.state))
    return SweepCounts(dict(counts), tuple(violations))


def _outcomes(judged: JudgedResult | None, far: bool) -> Iterator[str]:
    if judged is None:
        yield UNKNOWN
    elif judged.status:
        yield STATUSES[judged.status]
        if judged.certain and far:
            yield UNEXPLAINED
    else:
        yield ANSWERED
        if not judged.units <= 1:
            yield BEYOND


def _towards(
    walker: Walker, parameters: Mapping[str, float], starts: Sequence[FloatState], ranks: GenericRanks, seed: object
) -> Iterator[LedState]:
    """Towards where rows, inputs and masses lose rank, from each start, down to where that leads.

    Starts are regular states, and of many configurations those from which the way is shortest.
    """
    if not starts:
        return
    approach = Approach(walker, parameters, ranks, walker.points(parameters, SCATTERED))
    for kind in KINDS:
        seen: Counter[int] = Counter()
        for number, start in enumerate([*(state.q for state in starts), *approach.nearest(kind, NEAREST)]):
            for decade, q in approach.towards(kind, start, Dice("approach", seed, kind, number)):
                nearest = walker.refined(q, parameters, ranks.geometric) if seen[decade] < PER_DECADE else None
                if nearest is not None:
                    seen[decade] += 1
                    state = walker.state(nearest, parameters, ranks.constraints)
                    distance = approach.distance(kind, state.q) or 0.0
                    yield LedState(kind, f"{kind} at 1e-{decade}", state, ranks, distance)


def _scaled(
    walker: Walker,
    parameters: Mapping[str, float],
    starts: Sequence[FloatState],
    ranks: GenericRanks,
    names: Sequence[str],
) -> Iterator[LedState]:
    """Each of these parameters far from its value, at a regular state where the loops still close."""
    for start in starts[:1]:
        for name in names:
            for exponent in EXPONENTS:
                far = {**parameters, name: parameters[name] * 10.0**exponent}
                q = walker.closed(start.q, far)
                q = None if q is None else walker.refined(q, far, ranks.geometric)
                if q is not None:
                    state = walker.state(q, far, ranks.constraints)
                    yield LedState(SCALED, f"{name} times 1e{exponent}", state, ranks)
