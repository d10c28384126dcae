"""Points of the constraint manifold V, and the generic ranks found on it."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from math import frexp, inf
from typing import Any

from flint import arb_mat

from symgen.verify.reference_linear import (
    RANK_NOISE,
    RANK_SIGNAL,
    column,
    identity,
    independent_rows,
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
MOST_DAMPING = 1e6
# What rounded lengths leave open of a closed loop, relative to the rows' lengths; thresholds for ranks there.
ROUNDED = 1e-13
ROUNDED_NOISE, ROUNDED_SIGNAL = -36, -20


@dataclass(frozen=True)
class Ranks:
    """Generic ranks: of B, of its geometric rows, and of F'M (the degree of actuation).

    `rounded` says that loops close up to rounding only: an overconstrained linkage whose lengths are rounded numbers.
    """

    constraints: int
    geometric: int
    actuation: int
    rounded: bool = False


def onto_manifold(
    system: System,
    start: Sequence[Any],
    parameters: Sequence[Any],
    literals: Sequence[Any],
    tolerance: float = 1e-30,
    rounded: bool = False,
) -> list[Any] | None:
    """A point with |g| <= `tolerance` near `start`, by Levenberg-Marquardt; None when it does not converge.

    Steps are numbers, not bounds: only where they end is |g| looked at.  Rows may depend on each other: the damping
    falls with |g|, so that the step has least norm and convergence stays superlinear where dg/dq keeps its rank on V.
    Where loops are `rounded`, what rounding leaves of |g| is near enough.  Rows count in powers of 2 of their usual
    size, so that a row in other units is the same row.
    """
    q = column(start)
    if system.r_geometric == 0:
        return list(q.entries())
    residual, jacobian = system.geometry(q.entries(), parameters, literals)
    units = _units(system, jacobian)
    residual, jacobian = units * residual, units * jacobian
    size = norm(residual)
    damping = 1e-3
    slow = 0
    for _ in range(MOST_STEPS):
        if size <= tolerance:
            break
        step = _step(residual.mid(), jacobian.mid(), damping)
        if step is None:
            damping *= 10
            continue
        trial = (q - step).mid()
        residual_trial, jacobian_trial = (units * x for x in system.geometry(trial.entries(), parameters, literals))
        size_trial = norm(residual_trial)
        slow = slow + 1 if not size_trial <= 0.9 * size else 0
        if slow > MOST_SLOW_STEPS or damping > MOST_DAMPING:
            break
        if size_trial < size:
            q, residual, jacobian = trial, residual_trial, jacobian_trial
            damping = max(damping * min(0.03, size_trial / size), 1e-25)
            size = size_trial
        else:
            damping *= 10
    near = ROUNDED * norm(jacobian) * max(1.0, norm(q)) if rounded else 0.0
    return [entry.mid() for entry in q.entries()] if size <= max(tolerance, near) else None


def _step(residual: Any, jacobian: Any, damping: float) -> Any:
    """J' (J J' + shift)^-1 g (n x 1); None where rounding leaves the matrix singular, so that more damping is due."""
    gram = (jacobian * jacobian.transpose()).mid()
    shift = damping * max(float(gram.trace()) / gram.nrows(), 1e-30)
    try:
        return jacobian.transpose() * solve(gram + identity(gram.nrows()) * shift, residual)
    except ZeroDivisionError:
        return None


def admissible(
    system: System, q: Sequence[Any], shift: Sequence[float], parameters: Sequence[Any], literals: Sequence[Any]
) -> list[Any]:
    """The part of a shift that leaves the geometric rows as they are to first order; rows may depend on each other."""
    jacobian = system.geometry(column(q).entries(), parameters, literals)[1].mid()
    units = _units(system, jacobian)
    moved = column(shift)
    step = _step(units * jacobian * moved, units * jacobian, 1e-25)
    return list((moved if step is None else moved - step).mid().entries())


def _units(system: System, jacobian: Any) -> Any:
    """Diagonal of factors that bring rows to ordinary size.

    Where loading found what rows usually are that counts: of some nothing but rounding is left on V.
    """
    if system.model.assembly is not None and system.model.assembly.units:
        return _powers(system.model.assembly.units[: system.r_geometric])
    sizes = [max((abs(float(entry)) for entry in row), default=0.0) for row in jacobian.tolist()]
    return _powers([-frexp(size)[1] if 0 < size < inf else 0 for size in sizes])


def _powers(exponents: Sequence[int]) -> Any:
    """Powers of 2 on a diagonal."""
    count = len(exponents)
    return arb_mat(count, count, [2.0 ** exponents[i] if i == j else 0 for i in range(count) for j in range(count)])


def generic_ranks(system: System) -> Ranks | None:
    """The largest ranks over points of V at the default parameters; None when no point of V is found.

    Where loading found configurations, these say which branch of V is meant, else points are random.
    Points are exact to about 170 bits, so that a rank shows as a gap of 40 binary orders at least; those that close up
    to rounding only show it as a gap of 16.
    """
    with precision(RANK_BITS):
        return _found_ranks(system, rounded=False) or _found_ranks(system, rounded=True)


def _found_ranks(system: System, rounded: bool) -> Ranks | None:
    parameters = default_parameters(system.model)
    literals = literal_values(system.literals)
    generator = random.Random("ranks")
    found: list[Ranks] = []
    known = () if system.model.assembly is None else system.model.assembly.places[:RANK_POINTS]
    for start in (*(place.q for place in known), *(() if known else starts(system, generator, RANK_STARTS))):
        q = onto_manifold(system, start, parameters, literals, 2.0**-170, rounded)
        ranks = None if q is None else _ranks_at(system, q, parameters, literals, rounded)
        if ranks is not None:
            found.append(ranks)
        if len(found) == RANK_POINTS:
            break
    if not found:
        return None
    constraints = max(ranks.constraints for ranks in found)
    regular = [ranks for ranks in found if ranks.constraints == constraints]
    return Ranks(constraints, max(r.geometric for r in regular), max(r.actuation for r in regular), rounded)


def exceeds(
    system: System, ranks: Ranks, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]
) -> bool:
    """Whether a point of V has greater ranks than are meant, as other branches may: kernels give a status there."""
    if ranks.constraints == system.r and ranks.actuation == min(system.m, system.n - ranks.constraints):
        return False
    found = _ranks_at(system, q, parameters, literals, rounded=True)
    if found is None or found.constraints != ranks.constraints:
        return found is None or found.constraints > ranks.constraints
    return found.actuation > ranks.actuation


def starts(system: System, generator: random.Random, count: int) -> list[list[float]]:
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
    system: System, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any], rounded: bool
) -> Ranks | None:
    """Ranks at one point of V; the degree of actuation is rank [B; M'] minus rank B."""
    noise, signal = (ROUNDED_NOISE, ROUNDED_SIGNAL) if rounded else (RANK_NOISE, RANK_SIGNAL)
    at = system.configuration(q, parameters, literals)
    # beside rows in units of their own others would count as what rounding leaves of none
    known = system.model.assembly
    constraints = at.constraints if known is None else _powers(known.units) * at.constraints
    rows = independent_rows(constraints, noise, signal)
    geometric = numerical_rank(rows_of(constraints, range(system.r_geometric)), noise, signal)
    if rows is None or geometric is None:
        return None
    # on V they span all rows: the sums over all subsets of rows in other units lose far more digits
    basis = rows_of(constraints, rows)
    try:
        projected = at.control - right_pseudoinverse(basis, len(rows)) * (basis * at.control)
    except ZeroDivisionError:
        return None
    # an input that only loads the constraints leaves rounding alone, which is no direction of motion
    sizes = [_size(at.control, j) for j in range(system.m)]
    moving = [j for j in range(system.m) if _size(projected, j) > sizes[j] * 2.0**noise]
    # units of inputs are no measure of each other
    entries = [projected[i, j] / sizes[j] for i in range(system.n) for j in moving]
    actuation = numerical_rank(arb_mat(system.n, len(moving), entries), noise, signal) if moving else 0
    return None if actuation is None else Ranks(len(rows), geometric, actuation)


def _size(matrix: Any, column: int) -> float:
    """The largest entry of a column; what may be 0 is 0."""
    entries = (matrix[i, column] for i in range(matrix.nrows()))
    return max((abs(float(entry)) for entry in entries if not entry.contains(0)), default=0.0)
