"""The shares of reactions that friction returns, at configurations with parameters all over their ranges.

Places, directions and coefficients decide on them, no masses, rates or accelerations: where all places slide the share
of place j in the reaction of place i is mu_j rho_j |R_ij|, R_ij being what a unit of friction at place j adds to it.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping, Sequence

from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.closing import Closer
from symgen.model.configurations.mechanics import NumericSystem, default_values
from symgen.model.configurations.sparse import Row
from symgen.model.expressions.walk import evaluate
from symgen.model.kinematics.released import released_model
from symgen.model.model import Input, Model

# Configurations at which shares are looked at, the seed of the starts that lead there, and how many of these there are.
SHARE_POINTS, SHARE_SEED, SHARE_STARTS = 200, 19040401, 600
# Of the largest entry of a row, a pivot that is none.
NO_PIVOT = 1e-10


def friction_shares(model: Model, assembly: Assembly, of_motion: bool) -> list[list[list[float]]]:
    """K at each configuration, by the place whose reaction changes, then by the one that rubs.

    For a motion the smallest inputs supply friction, `of_motion` for inputs the accelerations do.
    """
    released = released_model(model)
    mechanics = NumericSystem.of(released)
    samples = []
    for q, values in _points(model, assembly):
        try:
            shares = _shares(model, mechanics.having(values), [*q, *[0.0] * (released.n - model.n)], of_motion)
        except (ArithmeticError, ValueError):
            continue
        if shares is not None and all(math.isfinite(x) for row in shares for x in row):
            samples.append(shares)
    return samples


def _shares(
    model: Model, mechanics: NumericSystem, q: Sequence[float], of_motion: bool
) -> list[list[float]] | None:
    """K at one configuration; None where inputs or constraints lose rank."""
    rates = [Input(place.name, None, "", (), velocity=place.velocity) for place in model.rough]
    rows, units = mechanics.rows(q), mechanics.columns(q, rates)
    sizes = [evaluate(p.coefficient, mechanics.defaults) * evaluate(p.radius, mechanics.defaults) for p in model.rough]
    n, r = model.n, model.r
    # what supplies friction: (M M^T) y - B^T lambda = s with B y = 0, u = M^T y being the least; or -G q_ddot
    if of_motion:
        supply = [[-x for x in row] for row in mechanics.mass_matrix(q)]
    else:
        controls = mechanics.columns(q, model.inputs)
        size = len(q)
        supply = [[sum(c.get(i, 0.0) * c.get(j, 0.0) for c in controls) for j in range(size)] for i in range(size)]
    matrix = [[*supply[i][:n], *(-row.get(i, 0.0) for row in rows)] for i in range(n)]
    matrix += [[*(row.get(j, 0.0) for j in range(n)), *[0.0] * r] for row in rows]
    columns = _solved(matrix, [[*(unit.get(i, 0.0) for i in range(n)), *[0.0] * r] for unit in units])
    if columns is None:
        return None
    names = {name: n + k for k, name in enumerate(name for joint in model.released for name, _ in joint.coordinates)}
    number = {row.name: k for k, row in enumerate(model.constraints)}
    shares = [[0.0] * len(units) for _ in units]
    for j, (unit, solution) in enumerate(zip(units, columns, strict=True)):
        for i, place in enumerate(model.rough):
            reaction = [solution[n + number[name]] for name in place.rows]
            reaction += [_held(names[name], unit, supply, rows, solution, n) for name in place.released]
            shares[i][j] = sizes[j] * math.hypot(*reaction)
    return shares


def _held(
    place: int, unit: Row, supply: Sequence[Sequence[float]], rows: Sequence[Row], solution: Sequence[float], n: int
) -> float:
    """What keeps a joint shut along a coordinate of its own."""
    supplied = sum(x * y for x, y in zip(supply[place][:n], solution[:n], strict=True))
    pressed = sum(row.get(place, 0.0) * x for row, x in zip(rows, solution[n:], strict=True))
    return unit.get(place, 0.0) - supplied + pressed


def _solved(matrix: list[list[float]], right: Sequence[list[float]]) -> list[list[float]] | None:
    """The solutions of a square system by elimination with row pivots; None where it has none."""
    size = len(matrix)
    work = [[*row, *(column[i] for column in right)] for i, row in enumerate(matrix)]
    scale = [max(map(abs, row), default=0.0) for row in matrix]
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(work[i][k]) / (scale[i] or 1.0))
        if abs(work[best][k]) <= NO_PIVOT * scale[best]:
            return None
        work[k], work[best], scale[k], scale[best] = work[best], work[k], scale[best], scale[k]
        for i in range(size):
            factor = work[i][k] / work[k][k] if i != k else 0.0
            if factor:
                work[i] = [x - factor * y for x, y in zip(work[i], work[k], strict=True)]
    return [[work[i][size + j] / work[i][i] for i in range(size)] for j in range(len(right))]


def _points(model: Model, assembly: Assembly) -> Iterator[tuple[Sequence[float], dict[str, float]]]:
    """Configurations with values of the parameters: where loading has been, then all over the ranges."""
    numbers = NumericSystem.of(model)
    for place in assembly.places:
        yield place.q, numbers.defaults
    source, met = random.Random(SHARE_SEED), 0
    varied = {p.name: p.range for p in model.parameters if p.range is not None and p.name not in assembly.tied}
    for _ in range(SHARE_STARTS):
        if met == SHARE_POINTS:
            return
        chosen = {name: source.uniform(float(low), float(high)) for name, (low, high) in varied.items()}
        drawn = [source.uniform(float(c.range[0]), float(c.range[1])) for c in model.coordinates]
        values = default_values(model.parameters, chosen)
        q = _closed(numbers.having(values), model, drawn)
        if q is not None:
            met += 1
            yield q, values


def _closed(mechanics: NumericSystem, model: Model, start: Sequence[float]) -> tuple[float, ...] | None:
    """The configuration that a start leads to, in the ranges; None where it leads to none."""
    widths = [1.0 if c.is_angle else max(float(c.range[1] - c.range[0]) / 2, 1e-300) for c in model.coordinates]
    try:
        slopes = mechanics.residuals(start, range(len(mechanics.geometric)))[1]
    except (ArithmeticError, ValueError):
        return None
    lengths: list[Mapping[int, float]] = [{j: abs(x) for j, x in row.items()} for row in slopes]
    reached = Closer(mechanics.residuals, [dict(row) for row in lengths], widths).close(start)
    inside = all(
        (c.is_angle and not c.has_range) or float(c.range[0]) <= x <= float(c.range[1])
        for c, x in zip(model.coordinates, reached.q, strict=True)
    )
    return reached.q if inside and not reached.open else None
