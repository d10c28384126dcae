"""u, accelerations and multipliers of the witness at one state, from their definitions.

u is the smallest of those that leave the least of the projected load, accelerations and multipliers solve
G q'' + B^T lambda = M u - bias, B q'' = -drift; where rows depend on each other the smallest multipliers are meant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from symgen.laboratory.zoo.witness.numbers.fields import settled
from symgen.laboratory.zoo.witness.numbers.linear import (
    NOTHING,
    Matrix,
    Vector,
    basis,
    complement,
    determinant,
    inner,
    least,
    size,
    solve,
    times,
    transposed,
)
from symgen.laboratory.zoo.witness.numbers.tape import FileNumber, NodeProgram
from symgen.laboratory.zoo.witness.reading.mechanics import Equations


@dataclass(frozen=True)
class GenericRanks:
    """Generic ranks: of the constraints, and of the inputs on what they leave free; usual `lengths` of rows, the rank
    of the `geometric` ones where it is known, and how many rows `kept` there are in what was generated."""

    constraints: int
    actuation: int
    lengths: tuple[float, ...] = ()
    geometric: int | None = None
    kept: int | None = None


@dataclass(frozen=True)
class EquationValues:
    """The equations of motion at a state."""

    mass: Matrix
    rows: Matrix
    control: Matrix
    bias: Vector
    drift: Vector
    residual: Vector

    @property
    def n(self) -> int:
        """How many coordinates."""
        return len(self.mass)


class EquationEvaluator:
    """Numbers of a model's equations at any state."""

    def __init__(self, program: NodeProgram, equations: Equations) -> None:
        self.program = program
        self._n, self._r = len(equations.mass), len(equations.rows)
        self._m = len(equations.control[0]) if equations.control else 0

    def __call__(
        self, values: Mapping[str, Any], field: Any, literals: Mapping[FileNumber, Any] | None = None
    ) -> EquationValues:
        """At these values of coordinates, rates and parameters."""
        return self._parts(self.program.run(values, field, literals))

    def settled(self, values: Mapping[str, float]) -> EquationValues:
        """The same in floats, worked out in so many digits that what cancels is 0."""
        return self._parts(settled(self.program.run, values))

    def _parts(self, values: list[Any]) -> EquationValues:
        n, r, m = self._n, self._r, self._m
        flat = iter(values)

        def matrix(rows: int, columns: int) -> Matrix:
            return [[next(flat) for _ in range(columns)] for _ in range(rows)]

        return EquationValues(matrix(n, n), matrix(r, n), matrix(n, m), matrix(1, n)[0], matrix(1, r)[0], list(flat))


def onto_rows(rows: Matrix, residual: Vector, rank: int) -> Vector:
    """The smallest step that Newton's method takes towards residual 0, rows being of this rank."""
    held, _ = basis(rows, rank)
    along = [[inner(row, direction) for direction in held] for row in rows]
    columns = transposed(along, len(held))
    gram = [[inner(x, y) for y in columns] for x in columns]
    shares = solve(gram, times(columns, residual))
    return [-inner(shares, column) for column in transposed(held, len(rows[0]))]


@dataclass(frozen=True)
class DirectionSplit:
    """The directions that the rows hold and those that they leave free; `pivots` tell how far the rows are apart, and
    `stray` how far rows that depend on the others are from doing so, in their own length."""

    held: Matrix
    free: Matrix
    pivots: list[float]
    stray: float


def split(at: EquationValues, rank: int, one: Any) -> DirectionSplit:
    """Of the constraints at a state."""
    held, pivots = basis(at.rows, rank)
    free = complement(held, at.n, one)
    lengths = [(size(row), size(times(free, row))) for row in at.rows]
    stray = max((rest / length for length, rest in lengths if length > NOTHING), default=0.0)
    return DirectionSplit(held, free, pivots, stray)


def along(at: EquationValues, parts: DirectionSplit) -> tuple[Matrix, list[float]]:
    """The inputs along the free directions, and their lengths in all: less is left of them where they lose rank."""
    columns = transposed(at.control, len(at.control[0]))
    return [times(columns, direction) for direction in parts.free], [size(column) for column in columns]


def distances(at: EquationValues, ranks: GenericRanks, one: Any) -> dict[str, float]:
    """What tells how far rows, inputs and masses are from a drop of rank, 0 to 1, of those that there are."""
    parts = split(at, ranks.constraints, one)
    by_kind = {"rows": _smallest(parts.pivots, ranks.constraints)} if ranks.constraints else {}
    if ranks.actuation:
        projected, whole = along(at, parts)
        columns = transposed(projected, len(whole))
        by_kind["inputs"] = _smallest(basis(columns, ranks.actuation, whole)[1], ranks.actuation)
    if parts.free:
        by_kind["masses"] = _smallest(_scaled_pivots(_inside(at, parts)), len(parts.free))
    return by_kind


def _smallest(pivots: Sequence[float], rank: int) -> float:
    return min(pivots) if len(pivots) == rank else 0.0


def inverse_dynamics(
    at: EquationValues,
    parts: DirectionSplit,
    accelerations: Vector,
    rank: int,
    weights: Sequence[Any] | None = None,
    near: Sequence[Any] | None = None,
) -> tuple[Vector, list[float]]:
    """u, the nearest to `near` (absent: to 0) in the norm of the weights, and what tells how far inputs are apart."""
    load = [x + b for x, b in zip(times(at.mass, accelerations), at.bias, strict=True)]
    if near is not None:
        load = [x - y for x, y in zip(load, times(at.control, near), strict=True)]
    m = len(at.control[0])
    projected, whole = along(at, parts)
    if weights is not None:
        projected = [[x / weight**0.5 for x, weight in zip(row, weights, strict=True)] for row in projected]
        whole = [length / float(weight) ** 0.5 for length, weight in zip(whole, weights, strict=True)]
    u, pivots = least(projected, times(parts.free, load), m, rank, whole)
    if weights is not None:
        u = [x / weight**0.5 for x, weight in zip(u, weights, strict=True)]
    if near is not None:
        u = [x + y for x, y in zip(u, near, strict=True)]
    return u, pivots


def internal_force(at: EquationValues, weights: Sequence[Any]) -> Vector:
    """The direction in which inputs move nothing, with z^T W z = 1; for one input more than degrees of freedom."""
    m = len(weights)
    columns = [*transposed(at.control, m), *at.rows]
    minors = [
        (-1) ** k * determinant(transposed([column for j, column in enumerate(columns) if j != k], at.n))
        for k in range(m)
    ]
    length = sum((weight * minor * minor for weight, minor in zip(weights, minors, strict=True)), 0) ** 0.5
    return [minor / length for minor in minors]


def motion(at: EquationValues, parts: DirectionSplit, u: Vector) -> tuple[Vector, Vector, list[float]]:
    """Accelerations, multipliers, and what tells how well the masses determine them."""
    push = [f - b for f, b in zip(times(at.control, u) if u else [0] * at.n, at.bias, strict=True)]
    along = [[inner(row, direction) for direction in parts.held] for row in at.rows]
    gram = [[inner(x, y) for y in transposed(along, len(parts.held))] for x in transposed(along, len(parts.held))]
    particular: Vector = [0 * x for x in push]
    if parts.held:
        shares = solve(gram, [-x for x in times(transposed(along, len(parts.held)), at.drift)])
        particular = [inner(shares, column) for column in transposed(parts.held, at.n)]
    rest = [f - g for f, g in zip(push, times(at.mass, particular), strict=True)]
    inside = _inside(at, parts)
    pivots = _scaled_pivots(inside)
    if pivots and pivots[-1] < 1e-25:
        return [], [], pivots
    amounts = solve(inside, times(parts.free, rest)) if parts.free else []
    accelerations = [
        p + inner(amounts, column) for p, column in zip(particular, transposed(parts.free, at.n), strict=True)
    ]
    forces = [f - g for f, g in zip(push, times(at.mass, accelerations), strict=True)]
    multipliers = times(along, solve(gram, times(parts.held, forces))) if parts.held else [0 * x for x in at.drift]
    return accelerations, multipliers, pivots


def _inside(at: EquationValues, parts: DirectionSplit) -> Matrix:
    """The masses along the free directions."""
    moved = [times(at.mass, direction) for direction in parts.free]
    return [[inner(x, direction) for direction in parts.free] for x in moved]


def _scaled_pivots(a: Matrix) -> list[float]:
    """Pivots of a symmetric matrix with ones on its diagonal, largest first: small where it is nearly singular."""
    diagonal = [float(a[k][k]) for k in range(len(a))]
    if any(value <= 0 for value in diagonal):
        return [0.0]
    rows = [[a[i][j] / (diagonal[i] * diagonal[j]) ** 0.5 for j in range(len(a))] for i in range(len(a))]
    return basis(rows, len(rows))[1] if rows else []
