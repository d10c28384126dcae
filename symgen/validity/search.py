"""A search for regular states at which a scalar vanishes: many seeded starts, counted steps, decided in 40 digits.

Starts are followed in double precision; only where one ends close to a zero do 40 digits go on from there.  Levenberg
and Marquardt's method drives the constraint residuals and the scalar (each of its squares, if it is a sum of squares)
to 0 together, over all coordinates and over the parameters within their ranges (Nocedal and Wright, Numerical
Optimization, ch. 10).  Angles run through the whole circle whatever range they are sampled from.  A state counts only
where the ranks of B and of [B; M^T] are beyond doubt, so a scalar that vanishes with a rank is not blamed.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.model.configurations.sparse import Row, pivots, solve_gram, transposed_product
from symgen.records import dataclass
from symgen.symbolic.matrix import flatten
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import topological
from symgen.validity.descent import STALLED, STALLED_STEPS, Evaluated, zero_beside
from symgen.validity.floats import FloatGradients
from symgen.validity.precise import Precise, PreciseEvaluator, UndefinedError, precise, precision

# The seed of starts: a search finds the same for the same model.
SEARCH_SEED = 20120731
# Points from which a search for zeros starts.
SEARCH_STARTS = 12
# Newton steps of a search from one start.
SEARCH_STEPS = 40
# Terms of a sum of squares that are driven to 0 one by one.
MOST_DRIVEN_SQUARES = 12
# Share of its usual size up to which a scalar has vanished; the same of constraint residuals.
VANISHED = 1e-12
# Share of its usual size below which a scalar in double precision goes on in 40 digits.
NEAR = 1e-8
# Share of the largest pivot that is no drop of rank, for a matrix with rows that usually have length 1.
REGULAR = 1e-4
# Points that tell how long rows of [B; M^T] usually are.
LENGTH_POINTS = 4
Point = dict[str, Precise]


@dataclass(frozen=True, slots=True)
class RegularZero:
    """A regular state at which a scalar vanishes: coordinates and parameters."""

    point: tuple[tuple[str, float], ...]


class ZeroSearch:
    """Looks for zeros of scalars on V, away from drops of rank."""

    def __init__(self, mechanics: System, generic: Genericity) -> None:
        self._generic = generic
        model = mechanics.model
        self._box: dict[str, tuple[Precise, Precise]] = {}
        self._angles: set[str] = set()
        turn = 2 * PI
        self._coordinates = frozenset(c.name for c in model.coordinates)
        for c in model.coordinates:
            lower, upper = (Fraction(0), turn) if c.is_angle else c.range
            self._box[c.name] = (precise(lower), precise(upper))
            if c.is_angle:
                self._angles.add(c.name)
        for p in model.parameters:
            if p.range is not None:
                self._box[p.name] = (precise(p.range[0]), precise(p.range[1]))
        self._fixed = self._defaults(mechanics)
        self._residuals = mechanics.constraint_residual
        inputs = [entry for column in mechanics.inputs for entry in column]
        self._rows = PreciseEvaluator([*flatten(mechanics.constraint_jacobian), *inputs])

    def zero_of(self, scalar: Scalar) -> RegularZero | None:
        """A regular state at which the scalar vanishes, or None if no start led to one.

        Of loops that share no coordinate with the scalar, nor with others that do, none is closed before there is a
        zero without them.
        """
        own = self._connected(scalar)
        if len(own) < len(self._residuals) and self._zero_of(scalar, own) is None:
            return None
        return self._zero_of(scalar, self._residuals)

    def _connected(self, scalar: Scalar) -> list[Scalar]:
        """The residuals that hold coordinates of the scalar, or of another one that does."""
        held = [symbols([residual]) & self._coordinates for residual in self._residuals]
        reached, left = symbols([scalar]) & self._coordinates, [*range(len(held))]
        while near := [k for k in left if held[k] & reached]:
            reached = reached.union(*(held[k] for k in near))
            left = [k for k in left if k not in near]
        return [residual for k, residual in enumerate(self._residuals) if k not in left]

    def _zero_of(self, scalar: Scalar, residuals: Sequence[Scalar]) -> RegularZero | None:
        with precision():
            terms = squares(scalar)
            if len(terms) > MOST_DRIVEN_SQUARES:
                terms = [scalar]
            reached = symbols([scalar, *residuals])
            names = [name for name in self._box if name in reached]
            evaluator = PreciseEvaluator([*residuals, *terms])
            floats = FloatGradients([*residuals, *terms], names)
            source = random.Random(SEARCH_SEED)
            sizes: list[float] = []
            for start in range(SEARCH_STARTS):
                point = self._start(source, inner=start < SEARCH_STARTS // 2)
                near = self._approach(floats, point, names, sizes, len(residuals))
                zero = None if near is None else self._descend(evaluator, *near, names, len(residuals))
                if zero is not None and self._regular(zero):
                    shown = [*self._angles, *names]
                    return RegularZero(tuple((name, float(zero[name])) for name in self._box if name in shown))
            return None

    def _start(self, source: random.Random, inner: bool) -> Point:
        """Anywhere in the box; parameters at their defaults in the first half of the starts."""
        point = dict(self._fixed)
        for name, (lower, upper) in self._box.items():
            share = precise(Fraction(source.randrange(10**9), 10**9))
            if not (inner and name in self._fixed):
                point[name] = (lower + (upper - lower) * share).mid()
        return point

    def _approach(
        self, evaluate: FloatGradients, point: Point, names: Sequence[str], sizes: list[float], rows: int
    ) -> tuple[Point, float] | None:
        """Where the way from a start ends close to a zero, and the scalar's usual size."""
        at = {name: float(value) for name, value in point.items()}
        state = evaluate(at)
        if state is None:
            return None
        values, slopes = state
        sizes.append(max(map(abs, values[rows:])))
        usual = sorted(sizes)[len(sizes) // 2] or 1.0
        weights = [1.0] * rows + [1 / usual] * (len(values) - rows)
        limits = [(float(lower), float(upper)) for lower, upper in (self._box[name] for name in names)]
        damping, size = 1e-3, max(abs(v) * w for v, w in zip(values, weights, strict=True))
        slow = 0
        for _ in range(SEARCH_STEPS):
            if slow == STALLED_STEPS:
                return None
            scaled = [
                {k: w * slope * (limits[k][1] - limits[k][0]) for k, slope in row.items()}
                for w, row in zip(weights, slopes, strict=True)
            ]
            scale = sum(x * x for row in scaled for x in row.values()) / len(scaled)
            right = [w * v for w, v in zip(weights, values, strict=True)]
            y = solve_gram(scaled, right, damping * scale + 1e-30)
            fresh = None
            if y is not None:
                trial = dict(at)
                for k, share in transposed_product(scaled, y).items():
                    lower, upper = limits[k]
                    moved = at[names[k]] - (upper - lower) * share
                    trial[names[k]] = moved if names[k] in self._angles else min(max(moved, lower), upper)
                fresh = evaluate(trial)
                if fresh is None:
                    return None
            fresh_size = math.inf if fresh is None else max(abs(v) * w for v, w in zip(fresh[0], weights, strict=True))
            slow = slow + 1 if fresh_size > STALLED * size else 0
            if fresh is not None and fresh_size < size:
                at, (values, slopes), size, damping = trial, fresh, fresh_size, damping / 10
            elif size <= NEAR:
                break
            else:
                damping = damping * 10
                if damping > 1000:
                    return None
        return ({name: precise(value) for name, value in at.items()}, usual) if size <= NEAR else None

    def _descend(
        self, evaluator: PreciseEvaluator, point: Point, usual: float, names: Sequence[str], rows: int
    ) -> Point | None:
        """The zero beside a point, if there is one."""
        boxes = [self._box[name] for name in names]

        def evaluate(x: list[Precise]) -> Evaluated:
            values, slopes = evaluator.gradients(point | dict(zip(names, x, strict=True)), names)
            weights = [1.0] * rows + [1 / usual] * (len(values) - rows)
            scaled = [[w * slope for slope in row] for w, row in zip(weights, slopes, strict=True)]
            return [w * value for w, value in zip(weights, values, strict=True)], scaled

        def inside(x: list[Precise]) -> list[Precise]:
            bounded = zip(names, x, boxes, strict=True)
            return [y if name in self._angles else min(max(y, lower), upper) for name, y, (lower, upper) in bounded]

        start, widths = [point[name] for name in names], [upper - lower for lower, upper in boxes]
        try:
            x = zero_beside(evaluate, start, VANISHED, SEARCH_STEPS, 1e-12, widths, inside)
        except UndefinedError:
            return None
        return None if x is None else point | dict(zip(names, x, strict=True))

    def _regular(self, point: Point) -> bool:
        """Whether B and [B; M^T] have their generic ranks beyond doubt."""
        generic = self._generic
        try:
            values = self._rows.values(point)
        except UndefinedError:
            return False
        rows = [
            {j: x / (length or 1.0) for j, x in enumerate(row) if x}
            for row, length in zip(self._matrix(values), self._lengths, strict=True)
        ]
        constraints, together = generic.rank, generic.rank + generic.alpha
        return _has_rank(rows[: generic.r], constraints) and _has_rank(rows, together)

    def _matrix(self, values: Sequence[Precise]) -> list[list[float]]:
        n = self._generic.n
        return [[float(x) for x in values[i * n : (i + 1) * n]] for i in range(self._generic.r + self._generic.m)]

    @cached_property
    def _lengths(self) -> list[float]:
        """The largest length of each row of [B; M^T] at some points: a row that all but vanishes is a drop of rank."""
        source = random.Random(SEARCH_SEED)
        lengths = [0.0] * (self._generic.r + self._generic.m)
        for _ in range(LENGTH_POINTS):
            try:
                values = self._rows.values(self._start(source, inner=True))
            except UndefinedError:
                continue
            row_lengths = (math.hypot(*row) for row in self._matrix(values))
            lengths = [max(pair) for pair in zip(lengths, row_lengths, strict=True)]
        return lengths

    @staticmethod
    def _defaults(mechanics: System) -> Point:
        graph = mechanics.graph
        with precision():
            values: Point = {}
            for parameter in mechanics.model.parameters:
                names = {name: graph.symbol(name) for name in values}
                values[parameter.name] = PreciseEvaluator([translate(graph, parameter.value, names)]).values(values)[0]
        return values


def symbols(scalars: Sequence[Scalar]) -> frozenset[str]:
    """The names of the symbols that scalars hold."""
    return frozenset(str(node.payload) for node in topological(scalars) if node.op == "symbol")


def squares(scalar: Scalar) -> list[Scalar]:
    """What is squared in a sum of squares; the scalar itself if it is none."""
    match scalar.op:
        case "add":
            left, right = (squares(argument) for argument in scalar.args)
            own = any(parts == [argument] for parts, argument in zip((left, right), scalar.args, strict=True))
            return [scalar] if own else [*left, *right]
        case "mul" if scalar.args[0] is scalar.args[1]:
            return [scalar.args[0]]
        case _:
            return [scalar]


def _has_rank(rows: Sequence[Row], rank: int) -> bool:
    """Whether rows have a rank beyond doubt."""
    sizes = pivots(rows)
    return sizes is not None and len(sizes) >= rank and min(sizes[:rank], default=1.0) > REGULAR
