"""Places on the constraint manifold where functions vanish, found from seeded starts in 384-bit arithmetic."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb

from symgen.laboratory.stress.determinants import Trouble
from symgen.validity.descent import Evaluated, zero_beside
from symgen.verify.reference.arithmetic.linear import column, norm
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.configurations.manifold import starts
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference

BITS = 384
STARTS = 16
STEPS = 150
RESIDUAL = 1e-55  # so that a double zero is still known to 27 digits
DIFFERENCE = arb(2) ** -128
ROUNDED = 1e-9
RANK_GAP = 1e-20  # places are known to 27 digits at least
DIRECTIONS = 4
NEAR = 1e-2
FLAT = 1e-12  # a gradient below this has no direction


@dataclass(frozen=True, slots=True)
class Place:
    """A singular configuration with its parameters (balls), and a direction along V (norm 1) that leaves it."""

    q: tuple[Any, ...]
    parameters: tuple[Any, ...]
    direction: tuple[Any, ...]

    def at(self, reference: Reference, distance: float) -> tuple[Any, ...] | None:
        """The configuration on V at about a distance; None where there is none nearby."""
        with precision(BITS):
            start = [x + distance * t for x, t in zip(self.q, self.direction, strict=True)]
            if distance == 0:
                return self.q
            q = onto_manifold(reference.system, start, self.parameters, reference.literals(), 1e-45)
            if q is None:
                # beside a singularity of V itself; a tangent leaves V by less than rounding does
                return tuple(start) if distance <= ROUNDED else None
            return tuple(q)


def places(reference: Reference, trouble: Trouble, count: int, parameters_too: bool = False) -> list[Place]:
    """Up to `count` different places in or near the ranges where all functions of a trouble vanish on V.

    With `parameters_too`, parameters with a range may move within it.
    """
    model, system = reference.model, reference.system
    generator = random.Random(f"places {trouble.label}")
    distinct: list[Place] = []
    with precision(BITS):
        parameters = default_parameters(model)
        free = [i for i, p in enumerate(model.parameters) if p.range is not None] if parameters_too else []
        for start in starts(system, generator, STARTS):
            x = _solved(reference, trouble, [arb(v) for v in start], parameters, free)
            if x is None:
                continue
            q = tuple(x[: system.n])
            chosen = list(parameters)
            for i, value in zip(free, x[system.n :], strict=True):
                chosen[i] = value
            if not (_allowed(reference, q, chosen, free) and _new(q, distinct)):
                continue
            direction = _direction(reference, trouble, q, chosen, generator)
            if direction is not None:
                distinct.append(Place(q, tuple(chosen), direction))
            if len(distinct) == count:
                break
    return distinct


def _solved(
    reference: Reference, trouble: Trouble, start: list[Any], parameters: Sequence[Any], free: Sequence[int]
) -> list[Any] | None:
    """A zero of [g; functions] in q and the free parameters beside a start."""
    n = reference.system.n

    def gaps(x: Sequence[Any]) -> list[Any]:
        p = list(parameters)
        for i, value in zip(free, x[n:], strict=True):
            p[i] = value
        values = list(trouble.values(x[:n], p))
        if reference.system.r_geometric:
            values += reference.system.geometry(x[:n], p, reference.literals())[0].entries()
        return [arb(v.mid()) for v in values]

    def evaluate(x: list[Any]) -> Evaluated:
        here = gaps(x)
        moved = [gaps([*x[:j], x[j] + DIFFERENCE, *x[j + 1 :]]) for j in range(len(x))]
        slopes = [[((there[i] - gap) / DIFFERENCE).mid() for there in moved] for i, gap in enumerate(here)]
        return here, slopes

    return zero_beside(evaluate, [*start, *(parameters[i] for i in free)], RESIDUAL, STEPS, 1e-2)


def _allowed(reference: Reference, q: Sequence[Any], parameters: Sequence[Any], free: Sequence[int]) -> bool:
    """Whether coordinates are not far outside their ranges, and free parameters inside theirs."""
    for x, coordinate in zip(q, reference.model.coordinates, strict=True):
        low, high = map(float, coordinate.range)
        if not low - (high - low) <= float(x) <= high + (high - low):
            return False
    for i in free:
        limits = reference.model.parameters[i].range
        assert limits is not None
        slack = 1e-12
        if not float(limits[0]) * (1 - slack) - slack <= float(parameters[i]) <= float(limits[1]) * (1 + slack) + slack:
            return False
    return True


def _new(q: Sequence[Any], known: Sequence[Place]) -> bool:
    return all(any(abs(float(a - b)) > 1e-3 for a, b in zip(q, place.q, strict=True)) for place in known)


def _direction(
    reference: Reference, trouble: Trouble, q: Sequence[Any], parameters: Sequence[Any], generator: random.Random
) -> tuple[Any, ...] | None:
    """Along V where the functions change most, else a random direction; None where V has no tangent."""
    n = reference.system.n
    before = trouble.values(q, parameters)
    random_ones = [[arb(generator.gauss(0, 1)) for _ in range(n)] for _ in range(DIRECTIONS)]
    weights = [arb(generator.gauss(0, 1)) for _ in before]
    gradient = []
    for j in range(n):
        moved = trouble.values([*q[:j], q[j] + DIFFERENCE, *q[j + 1 :]], parameters)
        gradient.append(sum((w * (b - a).mid() for w, a, b in zip(weights, before, moved, strict=True)), arb(0)))
    largest = max(abs(float(x / DIFFERENCE)) for x in gradient)
    steepest = [[x / DIFFERENCE for x in gradient]] if largest > FLAT else []
    for candidate in (*steepest, *random_ones):
        tangent = _along_manifold(reference, q, parameters, candidate)
        size = norm(tangent)
        if not size > FLAT:
            continue
        direction = tuple((x / size).mid() for x in tangent.entries())
        # at a singularity of V itself not every tangent leads along it
        if Place(tuple(q), tuple(parameters), direction).at(reference, NEAR) is not None:
            return direction
    return None


def _along_manifold(
    reference: Reference, q: Sequence[Any], parameters: Sequence[Any], direction: Sequence[Any]
) -> Any:
    """The part of a direction that the geometric rows do not see, at the rank that they have there."""
    if not reference.system.r_geometric:
        return column(direction)
    _, jacobian = reference.system.geometry(q, parameters, reference.literals())
    rest = column(direction)
    for row in independent_rows(jacobian):
        rest = rest - row * (row.transpose() * rest)[0, 0]
    return rest.mid()


def independent_rows(jacobian: Any) -> list[Any]:
    """An orthonormal basis of the rows (columns n x 1), by Gram-Schmidt with the largest remaining row first."""
    rows = [column([arb(x.mid()) for x in row]) for row in jacobian.tolist()]
    scale = max((norm(row) for row in rows), default=0.0)
    basis: list[Any] = []
    while rows:
        row = max(rows, key=norm)
        size = norm(row)
        if not size > RANK_GAP * scale:
            break
        unit = (row * (1 / arb(size))).mid()
        basis.append(unit)
        rows = [(other - unit * (unit.transpose() * other)[0, 0]).mid() for other in rows if other is not row]
    return basis
