"""Points of the constraint manifold V, and the generic ranks found on it."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import arb_mat

from symgen.verify.reference.arithmetic.linear import (
    RANK_NOISE,
    RANK_SIGNAL,
    independent_rows,
    numerical_rank,
    right_pseudoinverse,
    rows_of,
)
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import onto_manifold, powers
from symgen.verify.reference.configurations.parts import piece, placed
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values

# Binary digits that ranks are told in.
RANK_BITS = 256
# Starts towards V, at most.
RANK_STARTS = 24
# Points on V at which ranks are looked at.
RANK_POINTS = 6
# Thresholds for ranks where lengths are rounded.
ROUNDED_NOISE, ROUNDED_SIGNAL = -36, -20
# Of a direction that an input reaches: below this it is what numbers with sixteen digits in a file leave of none.
ROUNDED_DIRECTION = -44


@dataclass(frozen=True)
class ManifoldRanks:
    """Generic ranks: of B, of its geometric rows, and of F'M (the degree of actuation).

    `rounded` says that loops close up to rounding only: an overconstrained linkage whose lengths are rounded numbers.
    `of_parts` are the ranks of B and of F'M of each part of the system, where they are known.
    """

    constraints: int
    geometric: int
    actuation: int
    rounded: bool = False
    of_parts: tuple[tuple[int, int], ...] = field(default=(), compare=False)


def generic_ranks(system: ReferenceSystem) -> ManifoldRanks | None:
    """The largest ranks over points of V at the default parameters; None when no point of V is found.

    Where loading found configurations, these say which branch of V is meant, else points are random.
    Points are exact to about 170 bits, so that a rank shows as a gap of 40 binary orders at least; those that close up
    to rounding only show it as a gap of 16.
    """
    with precision(RANK_BITS):
        return _sampled_ranks(system, rounded=False) or _sampled_ranks(system, rounded=True)


def _sampled_ranks(system: ReferenceSystem, rounded: bool) -> ManifoldRanks | None:
    parameters = default_parameters(system.model)
    literals = literal_values(system.literals)
    generator = random.Random("ranks")
    sampled: list[ManifoldRanks] = []
    known = () if system.model.assembly is None else system.model.assembly.places[:RANK_POINTS]
    for start in (*(place.q for place in known), *(() if known else starts(system, generator, RANK_STARTS))):
        q = onto_manifold(system, start, parameters, literals, 2.0**-170, rounded)
        ranks = None if q is None else _ranks_at(system, q, parameters, literals, rounded)
        if ranks is not None:
            sampled.append(ranks)
        if len(sampled) == RANK_POINTS:
            break
    if not sampled:
        return None
    constraints = max(ranks.constraints for ranks in sampled)
    regular = [ranks for ranks in sampled if ranks.constraints == constraints]
    best = max(regular, key=lambda ranks: ranks.actuation)
    return ManifoldRanks(constraints, max(r.geometric for r in regular), best.actuation, rounded, best.of_parts)


def exceeds(
    system: ReferenceSystem, ranks: ManifoldRanks, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]
) -> bool:
    """Whether a point of V has greater ranks than are meant, as other branches may: kernels give a status there."""
    if ranks.constraints == system.r and ranks.actuation == min(system.m, system.n - ranks.constraints):
        return False
    ranks_here = _ranks_at(system, q, parameters, literals, rounded=True)
    if ranks_here is None or ranks_here.constraints != ranks.constraints:
        return ranks_here is None or ranks_here.constraints > ranks.constraints
    return ranks_here.actuation > ranks.actuation


def starts(system: ReferenceSystem, generator: random.Random, count: int) -> list[list[float]]:
    """Starting points: the model's `configuration` (where loading found it singular, a regular one), then random ones
    in the ranges of the coordinates."""
    given: dict[str, Any] = dict(system.model.configuration)
    known = system.model.assembly
    if known is not None and known.start is not None:
        given = dict(zip((c.name for c in system.model.coordinates), known.places[0].q, strict=True))
    points = []
    for index in range(count):
        draw = [generator.uniform(float(c.range[0]), float(c.range[1])) for c in system.model.coordinates]
        if index == 0:
            draw = [float(given.get(c.name, x)) for c, x in zip(system.model.coordinates, draw, strict=True)]
        points.append(draw)
    return points


def _ranks_at(
    system: ReferenceSystem, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any], rounded: bool
) -> ManifoldRanks | None:
    """Ranks at one point of V; the degree of actuation is rank [B; M'] minus rank B."""
    noise, signal = (ROUNDED_NOISE, ROUNDED_SIGNAL) if rounded else (RANK_NOISE, RANK_SIGNAL)
    constraints, control = system.matrices(q, parameters, literals)
    # beside rows in units of their own others would count as what rounding leaves of none
    if system.model.assembly is not None:
        constraints = powers(system.model.assembly.units) * constraints
    rows = independent_rows(constraints, noise, signal)
    geometric = numerical_rank(rows_of(constraints, range(system.r_geometric)), noise, signal)
    if rows is None or geometric is None:
        return None
    try:
        projected = _projected(system, constraints, control, rows)
    except ZeroDivisionError:
        return None
    # an input that only loads the constraints leaves rounding alone, which is no direction of motion
    sizes = [_size(control, j) for j in range(system.m)]
    noise, signal = max(noise, ROUNDED_DIRECTION), max(signal, ROUNDED_DIRECTION)
    moving = [j for j in range(system.m) if _size(projected, j) > sizes[j] * 2.0**noise]
    # units of inputs are no measure of each other
    entries = [projected[i, j] / sizes[j] for i in range(system.n) for j in moving]
    reached = independent_rows(arb_mat(system.n, len(moving), entries), noise, signal) if moving else []
    if reached is None:
        return None
    of_parts = (
        (len({*rows} & {*part.rows}), len({*reached} & {*part.coordinates})) for part in system.parts
    )
    return ManifoldRanks(len(rows), geometric, len(reached), rounded, tuple(of_parts))


def _projected(system: ReferenceSystem, constraints: Any, control: Any, rows: Sequence[int]) -> Any:
    """N M by rows that span all: on V, where sums over all subsets of rows in other units lose far more digits."""
    pieces = []
    for part in system.parts:
        own = piece(control, part.coordinates, part.inputs)
        basis = piece(constraints, [i for i in part.rows if i in rows], part.coordinates)
        held = right_pseudoinverse(basis, basis.nrows()) * (basis * own)
        pieces.append((part.coordinates, part.inputs, own - held))
    return placed(system.n, system.m, pieces)


def _size(matrix: Any, column: int) -> float:
    """The largest entry of a column; what may be 0 is 0."""
    entries = (matrix[i, column] for i in range(matrix.nrows()))
    return max((abs(float(entry)) for entry in entries if not entry.contains(0)), default=0.0)
