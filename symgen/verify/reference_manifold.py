"""Points of the constraint manifold V, and the generic ranks found on it."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from symgen.verify.reference_linear import (
    RANK_NOISE,
    column,
    columns_of,
    identity,
    norm,
    numerical_rank,
    right_pseudoinverse,
    rows_of,
    solve,
)
from symgen.verify.reference_system import System, default_parameters
from symgen.verify.reference_tape import precision
from symgen.verify.reference_translation import literal_values

RANK_BITS = 256
RANK_STARTS = 24
RANK_POINTS = 6
MOST_STEPS = 60
MOST_SLOW_STEPS = 6


@dataclass(frozen=True)
class Ranks:
    """Generic ranks: of B, of its geometric rows, and of F'M (the degree of actuation)."""

    constraints: int
    geometric: int
    actuation: int


def onto_manifold(
    system: System, start: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any], tolerance: float = 1e-30
) -> list[Any] | None:
    """A point with |g| <= `tolerance` near `start`, by Levenberg-Marquardt; None when it does not converge."""
    q = column(start)
    if system.r_geometric == 0:
        return list(q.entries())
    residual, jacobian = system.geometry(q.entries(), parameters, literals)
    size = norm(residual)
    damping = 1e-3
    slow = 0
    for _ in range(MOST_STEPS):
        if size <= tolerance:
            return [entry.mid() for entry in q.entries()]
        gram = jacobian * jacobian.transpose()
        shift = damping * max(float(gram.trace().mid()) / system.r_geometric, 1e-30)
        step = jacobian.transpose() * solve(gram + identity(system.r_geometric) * shift, residual)
        trial = (q - step).mid()
        residual_trial, jacobian_trial = system.geometry(trial.entries(), parameters, literals)
        size_trial = norm(residual_trial)
        slow = slow + 1 if size_trial > 0.9 * size else 0
        if slow > MOST_SLOW_STEPS:
            return None
        if size_trial < size:
            q, residual, jacobian = trial, residual_trial, jacobian_trial
            damping = max(damping * min(0.03, size_trial / size), 1e-25)
            size = size_trial
        elif damping < 1e6:
            damping *= 10
        else:
            return None
    return None


def generic_ranks(system: System) -> Ranks | None:
    """The largest ranks over random points of V at the default parameters; None when no point of V is found.

    Points are exact to about 170 bits, so that a rank shows as a gap of 40 binary orders at least.
    """
    with precision(RANK_BITS):
        parameters = default_parameters(system.model)
        literals = literal_values(system.literals)
        generator = random.Random("ranks")
        found: list[Ranks] = []
        for start in starts(system, generator, RANK_STARTS):
            q = onto_manifold(system, start, parameters, literals, tolerance=2.0**-170)
            ranks = None if q is None else _ranks_at(system, q, parameters, literals)
            if ranks is not None:
                found.append(ranks)
            if len(found) == RANK_POINTS:
                break
    if not found:
        return None
    constraints = max(ranks.constraints for ranks in found)
    regular = [ranks for ranks in found if ranks.constraints == constraints]
    return Ranks(constraints, max(r.geometric for r in regular), max(r.actuation for r in regular))


def starts(system: System, generator: random.Random, count: int) -> list[list[float]]:
    """Starting points: the model's `configuration`, then random ones in the ranges of the coordinates."""
    given = dict(system.model.configuration)
    points = []
    for index in range(count):
        draw = [generator.uniform(float(c.range[0]), float(c.range[1])) for c in system.model.coordinates]
        if index == 0:
            draw = [float(given.get(c.name, x)) for c, x in zip(system.model.coordinates, draw, strict=True)]
        points.append(draw)
    return points


def _ranks_at(system: System, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> Ranks | None:
    """Ranks at one point of V; the degree of actuation is rank [B; M'] minus rank B."""
    at = system.configuration(q, parameters, literals)
    constraints = numerical_rank(at.constraints)
    geometric = numerical_rank(rows_of(at.constraints, range(system.r_geometric)))
    if constraints is None or geometric is None:
        return None
    inverse = right_pseudoinverse(at.constraints, constraints)
    projected = at.control - inverse * (at.constraints * at.control)
    # an input that only loads the constraints leaves rounding alone, which is no direction of motion
    moving = [j for j in range(system.m) if _size(projected, j) > _size(at.control, j) * 2.0**RANK_NOISE]
    actuation = numerical_rank(columns_of(projected, moving)) if moving else 0
    return None if actuation is None else Ranks(constraints, geometric, actuation)


def _size(matrix: Any, column: int) -> float:
    return max((abs(float(matrix[i, column])) for i in range(matrix.nrows())), default=0.0)
