"""Whether the mass matrix is positive definite everywhere, or at least wherever the motion is determined.

The smallest pivot of G = L D L^T in units of its diagonal entry, and the smallest diagonal entry in units of what it is
elsewhere, are minimised over configurations and parameters within their ranges, from many seeded starts, by moving one
number at a time (Hooke and Jeeves' pattern search).  A coordinate without mass, or a quaternion's, shows as a pivot
that vanishes somewhere.  Steps are taken in double precision, with sines and cosines that are the same on every
machine; what decides is the pivot at their end, in 40 digits.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from operator import add
from typing import TypeVar

from symgen.linear_algebra.constrained_inverse import Cholesky
from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten, matmul, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological
from symgen.validity.precise import PreciseEvaluator, UndefinedError, precise

Decided = TypeVar("Decided")

# The seed of configurations: the same model is looked at at the same ones.
PIVOT_SEED = 15
# Configurations from which the smallest pivot is driven down.
PIVOT_STARTS = 4
# Configurations that tell how large an entry gets.
LOOKED_AT = 32
# Lengths of a step that are tried on the way to the smallest pivot, each half of the one before.
STEP_HALVINGS = 11
# Between what inertias of one machine differ by and what is left of a pivot that vanishes after the last halving.
SMALLEST = 1e-4
# A step counts that makes the smallest pivot, 1 at most, smaller by this: less is rounding.
GAIN = 1e-9


@dataclass(frozen=True, slots=True)
class Indefinite:
    """A pivot of G that vanishes: of which coordinate (index), its value, and where (coordinates and parameters)."""

    coordinate: int
    pivot: Scalar
    state: tuple[tuple[str, float], ...]


def positive_definite(mechanics: System) -> bool:
    """Whether G is positive definite at every configuration, for parameters in their ranges."""
    return indefinite(mechanics) is None


def indefinite(mechanics: System) -> Indefinite | None:
    """Where G is not positive definite, or None where it is so everywhere."""
    return indefinite_model(mechanics.model)


@lru_cache(maxsize=2)  # asked for each quantity, by each method
def indefinite_model(model: Model) -> Indefinite | None:
    """The same of a model."""
    return _decided_apart(model, _indefinite)


@lru_cache(maxsize=2)
def definite_beside_rows(model: Model) -> bool:
    """Whether G, of bodies, is singular only where rows leave the same direction free: the motion is not determined.

    With H = G + B^T W B each pivot of G is at most that of H, and both vanish there.  Where a row holds what has no
    mass, one of G vanishes beside its own of H.  W makes rows as large as the inertia that they act on.
    """
    return _decided_apart(model, _definite_beside_rows)


def _decided_apart(model: Model, decide: Callable[[System], Decided]) -> Decided:
    """What is decided of a model on a graph of its own, so that no kernel shares what it takes."""
    mechanics = System(model)
    decided = decide(mechanics)
    mechanics.graph.dissolve()
    return decided


def _definite_beside_rows(mechanics: System) -> bool:
    graph, n, rows = mechanics.graph, mechanics.n, mechanics.constraint_jacobian
    entries = _largest(mechanics, [*flatten(mechanics.mass_matrix), *flatten(rows)])
    sizes = [entries[i * n + i] for i in range(n)]
    weights = [
        sum(x * x / size for x, size in zip(entries[k : k + n], sizes, strict=True) if size)
        for k in range(n * n, len(entries), n)
    ]
    if not all(weights):
        # rows that hold nothing but what has no mass
        return False
    scaled = [[x / Fraction(weight) for x in row] for row, weight in zip(rows, weights, strict=True)]
    holding = matmul(graph, transpose(rows, n), tuple(map(tuple, scaled)), n)
    held = tuple(tuple(map(add, *pair)) for pair in zip(mechanics.mass_matrix, holding, strict=True))
    own, beside = Cholesky(graph, mechanics.mass_matrix).pivots, Cholesky(graph, held).pivots
    if any(pivot.is_zero for pivot in own):
        return False
    return smallest(mechanics, [x / y for x, y in zip(own, beside, strict=True)])[0] > SMALLEST


def _indefinite(mechanics: System) -> Indefinite | None:
    graph = mechanics.graph
    for i, row in enumerate(mechanics.mass_matrix):
        if row[i].is_zero:
            return Indefinite(i, row[i], ())
    pivots: list[Scalar] = []
    factor = Cholesky(graph, mechanics.mass_matrix)
    for i, pivot in enumerate(factor.pivots):
        if pivot.is_zero:
            return Indefinite(i, pivot, ())
        pivots.append(pivot / mechanics.mass_matrix[i][i])
    if mechanics.r:
        # without constraints the motion is not determined where a diagonal entry vanishes, and no method is to blame
        pivots += _beside_the_largest(mechanics, factor.scales)
    if all(pivot.constant is not None for pivot in pivots):
        negative = (i % factor.size for i, pivot in enumerate(pivots) if not (pivot.constant or 0) > 0)
        return next((Indefinite(i, factor.pivots[i], ()) for i in negative), None)
    least, point, i = smallest(mechanics, pivots)
    if least > SMALLEST:
        return None
    i %= factor.size
    reached = {str(node.payload) for node in topological([factor.pivots[i]]) if node.op == "symbol"}
    state = tuple((name, value) for name, value in point.items() if name in reached)
    return Indefinite(i, factor.pivots[i], state)


def _beside_the_largest(mechanics: System, entries: Sequence[Scalar]) -> list[Scalar]:
    """Entries in units of the largest values found of them; bounds may be far above what turns leave of them."""
    largest = _largest(mechanics, entries)
    return [entry / Fraction(size) if size else entry for entry, size in zip(entries, largest, strict=True)]


def _largest(mechanics: System, entries: Sequence[Scalar]) -> list[float]:
    """The largest magnitude found of each."""
    evaluate, source = Evaluator(entries), random.Random(PIVOT_SEED)
    known, ranges = parameter_values(mechanics), _ranges(mechanics, entries)
    points = ({name: source.uniform(*limits) for name, limits in ranges.items()} for _ in range(LOOKED_AT))
    by_entry = zip(*(evaluate(known | point) for point in points), strict=True)
    return [max((abs(x) for x in values if math.isfinite(x)), default=0.0) for values in by_entry]


def _ranges(mechanics: System, values: Sequence[Scalar]) -> dict[str, tuple[float, float]]:
    """What values depend on and may be chosen, by name."""
    reached = {str(node.payload) for node in topological(values) if node.op == "symbol"}
    ranges = {c.name: (float(c.range[0]), float(c.range[1])) for c in mechanics.model.coordinates if c.name in reached}
    for parameter in mechanics.model.parameters:
        if parameter.name in reached and parameter.range is not None:
            ranges[parameter.name] = float(parameter.range[0]), float(parameter.range[1])
    return ranges


def smallest(mechanics: System, pivots: Sequence[Scalar]) -> tuple[float, dict[str, float], int]:
    """The smallest of pivots found in the ranges, where it was found, and whose it is."""
    evaluate = Evaluator(pivots)
    known, ranges = parameter_values(mechanics), _ranges(mechanics, pivots)
    exact = PreciseEvaluator(pivots)

    def measure(point: dict[str, float]) -> tuple[float, int]:
        values = [-math.inf if math.isnan(x) else x for x in evaluate(point)]
        return min(zip(values, range(len(values)), strict=True))

    def decisive(point: dict[str, float]) -> tuple[float, int]:
        try:
            values = exact.values({name: precise(value) for name, value in point.items()})
        except UndefinedError:  # at this point, or a function without a rule there
            return measure(point)
        return min((float(value), index) for index, value in enumerate(values))

    source = random.Random(PIVOT_SEED)
    best, place, index = math.inf, known, 0
    for start in range(PIVOT_STARTS):
        point = known | {
            name: source.uniform(*limits) if start or name not in known else known[name]
            for name, limits in ranges.items()
        }
        least, _ = measure(point)
        for halving in range(1, STEP_HALVINGS):
            for name, (low, high) in ranges.items():
                for step in (-1, 1):
                    moved = min(high, max(low, point[name] + step * (high - low) * 0.5**halving))
                    if moved == point[name]:
                        continue
                    trial = point | {name: moved}
                    value, _ = measure(trial)
                    if value < least - GAIN:
                        point, least = trial, value
        least, which = decisive(point)
        if least < best - GAIN:
            best, place, index = least, point, which
    return best, place, index
