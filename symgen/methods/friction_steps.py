"""How many steps the fixed point of friction takes, from the gains of reactions over the ranges of a model.

The gains are looked at at configurations on the constraints, with parameters drawn from their ranges, and a margin is
added.  Place by place the error of the loads falls as T = (D - L)^-1 U of I - K = D - L - U does, K holding the gains:
no entry is below 0, so that the largest row sum of T^N bounds what N steps leave of the error of the first.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction

from symgen.mechanics.genericity import assembly_of
from symgen.mechanics.system import System
from symgen.model.configurations.closing import Closer
from symgen.model.configurations.mechanics import NumericSystem, default_values
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import Matrix, flatten

# Configurations at which gains are looked at, the seed of the starts that lead there, and how many of these there are.
GAIN_POINTS = 200
GAIN_SEED = 19040401
GAIN_STARTS = 600
# Gains between configurations are no larger than those at them by more than this.
GAIN_MARGIN = Fraction(5, 4)
# Row sums that are not gone beyond: there a kernel returns a status.
LARGEST_GAIN = Fraction(1, 2)
# What steps leave of the error of the first: less than a rounding.
LEFT_OVER = 2.0**-54
# Steps that are enough for row sums up to the largest one.
MOST_FRICTION_STEPS = 54


@dataclass(frozen=True, slots=True)
class FrictionSteps:
    """The steps, the largest kappa that was met at full sliding, and at how many configurations.

    `locking` is at how many of them a kernel has a status as soon as all places slide.
    """

    steps: int
    kappa: float
    points: int
    locking: int


def friction_steps(mechanics: System, gains: Matrix) -> FrictionSteps:
    """How often reactions are worked out; once where none changes another one."""
    count = len(gains)
    evaluate = Evaluator(flatten(gains))
    steps, largest, points, locking = 1, 0.0, 0, 0
    for values in points_of(mechanics.model):
        flat = evaluate(values)
        if not all(abs(x) < float("inf") for x in flat):
            continue
        rows = [[abs(x) for x in flat[k * count : (k + 1) * count]] for k in range(count)]
        kappa = max(map(sum, rows))
        points, largest, locking = points + 1, max(largest, kappa), locking + (kappa >= LARGEST_GAIN)
        margin = float(min(GAIN_MARGIN, LARGEST_GAIN / Fraction(kappa))) if kappa else 1.0
        steps = max(steps, steps_for([[margin * x for x in row] for row in rows]))
    return FrictionSteps(steps, largest, points, locking)


def steps_for(gains: Sequence[Sequence[float]]) -> int:
    """The steps after which less than a rounding is left of the first error."""
    errors = [1.0] * len(gains)
    for step in range(1, MOST_FRICTION_STEPS):
        for i, row in enumerate(gains):
            errors[i] = sum(x * e for j, (x, e) in enumerate(zip(row, errors, strict=True)) if j != i) / (1 - row[i])
        if max(errors) <= LEFT_OVER:
            return step
    return MOST_FRICTION_STEPS


def points_of(model: Model) -> Iterator[dict[str, float]]:
    """Coordinates and parameters on the geometric constraints: where loading has been, then all over the ranges."""
    numbers = NumericSystem(
        model.coordinates, model.parameters, model.definitions, model.constraints, model.kinetic_energy, model.mechanism
    )
    names, assembly = [c.name for c in model.coordinates], assembly_of(model)
    for place in assembly.places:
        yield numbers.defaults | dict(zip(names, place.q, strict=True))
    source, met = random.Random(GAIN_SEED), 0
    varied = [p for p in model.parameters if p.range is not None and p.name not in assembly.tied]
    for _ in range(GAIN_STARTS):
        chosen = {p.name: source.uniform(float(p.range[0]), float(p.range[1])) for p in varied if p.range is not None}
        drawn = [source.uniform(float(c.range[0]), float(c.range[1])) for c in model.coordinates]
        if met == GAIN_POINTS:
            return
        system = numbers.having(default_values(model.parameters, chosen))
        q = _closed(system, model, drawn)
        if q is not None:
            met += 1
            yield system.defaults | dict(zip(names, q, strict=True))


def _closed(system: NumericSystem, model: Model, start: Sequence[float]) -> tuple[float, ...] | None:
    """The configuration that a start leads to, in the ranges; None where it leads to none."""
    widths = [1.0 if c.is_angle else max(float(c.range[1] - c.range[0]) / 2, 1e-300) for c in model.coordinates]
    try:
        lengths = system.residuals(start, range(len(system.geometric)))[1]
        found = Closer(system.residuals, [{j: abs(x) for j, x in row.items()} for row in lengths], widths).close(start)
    except (ArithmeticError, ValueError):
        return None
    inside = all(
        c.is_angle and not c.has_range or float(c.range[0]) <= x <= float(c.range[1])
        for c, x in zip(model.coordinates, found.q, strict=True)
    )
    return found.q if inside and not found.open else None
