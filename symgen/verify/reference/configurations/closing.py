"""Points of the constraint manifold V by Newton's method, each loop by steps of its own."""

from __future__ import annotations

from collections.abc import Sequence
from math import frexp, inf
from typing import Any

from flint import arb_mat

from symgen.verify.reference.arithmetic.linear import column, identity, norm
from symgen.verify.reference.configurations.parts import Part, piece, placed
from symgen.verify.reference.system import ReferenceSystem

# Steps onto V of all loops together, at most.
NEWTON_STEPS = 60
# Steps in a row that leave more than nine tenths: a loop is given up after more.
MOST_SLOW_STEPS = 6
# Of the mean square of the slopes: a loop whose steps need more damping is given up.
HIGHEST_DAMPING = 1e6
# The same: where loops are wide open, and least.
FIRST_DAMPING, LAST_DAMPING = 1e-3, 1e-25
# What rounded lengths leave open of a closed loop, relative to the rows' lengths.
ROUNDED_GAP = 1e-13


def onto_manifold(
    system: ReferenceSystem,
    start: Sequence[Any],
    parameters: Sequence[Any],
    literals: Sequence[Any],
    tolerance: float = 1e-30,
    rounded: bool = False,
) -> list[Any] | None:
    """A point with |g| <= `tolerance` near `start`; None when it does not converge."""
    q, still_open = closed(system, start, parameters, literals, tolerance, rounded)
    return None if still_open else q


def closed(
    system: ReferenceSystem,
    start: Sequence[Any],
    parameters: Sequence[Any],
    literals: Sequence[Any],
    tolerance: float = 1e-30,
    rounded: bool = False,
) -> tuple[list[Any], list[Part]]:
    """Where Levenberg-Marquardt leads from `start`, and the loops that stay open there.

    Steps are numbers, not bounds: only where they end is |g| looked at.  Rows may depend on each other: the damping
    falls with |g|, so that the step has least norm and convergence stays superlinear where dg/dq keeps its rank on V.
    Where loops are `rounded`, what rounding leaves of |g| is near enough.  Rows count in powers of 2 of their usual
    size, so that a row in other units is the same row.  Loops without a common coordinate have steps of their own.
    """
    q = list(column(start).entries())
    if system.r_geometric == 0:
        return q, []
    geometry = system.loop_geometry(q, parameters, literals)
    units = _units(system, geometry)
    own = zip(system.loops, units, geometry, strict=True)
    loops = [_PartIteration(place, part, unit, q, at_start) for place, (part, unit, at_start) in enumerate(own)]
    for _ in range(NEWTON_STEPS):
        moving = [loop for loop in loops if not loop.ended and not loop.size <= tolerance]
        if not moving:
            break
        trials = [(loop, trial) for loop in moving if (trial := loop.trial()) is not None]
        if not trials:
            continue
        place = list(q)
        for loop, trial in trials:
            loop.put(trial, place)
        geometry = system.loop_geometry(place, parameters, literals)
        for loop, trial in trials:
            loop.judge(trial, geometry[loop.place])
            loop.put(loop.q, q)
    length = max(1.0, norm(column(q)))
    near = {loop: ROUNDED_GAP * norm(loop.jacobian) * length if rounded else 0.0 for loop in loops}
    return [entry.mid() for entry in q], [x.part for x in loops if not x.size <= max(tolerance, near[x])]


class _PartIteration:
    """The rows of a part and what they know of Newton's method; `place` is its number."""

    def __init__(
        self, place: int, part: Part, units: Sequence[int], q: Sequence[Any], geometry: tuple[Any, Any]
    ) -> None:
        self.place, self.part = place, part
        self._units = powers(units)
        self.q = column([q[j] for j in part.coordinates])
        self.residual, self.jacobian = self._own(geometry)
        self.size = norm(self.residual)
        self.ended = False
        # a loop that is all but closed takes full steps: beside a singular pose some slopes are far smaller than others
        self._damping, self._slow = min(FIRST_DAMPING, max(self.size, LAST_DAMPING)), 0

    def trial(self) -> Any | None:
        """Where a step leads; None where that takes more damping first."""
        step = _step(self.residual.mid(), self.jacobian.mid(), self._damping)
        if step is None:
            self._damping *= 10
            return None
        return (self.q - step).mid()

    def judge(self, trial: Any, geometry: tuple[Any, Any]) -> None:
        """Takes a step that brings the loop closer."""
        residual, jacobian = self._own(geometry)
        size = norm(residual)
        self._slow = self._slow + 1 if not size <= 0.9 * self.size else 0
        if self._slow > MOST_SLOW_STEPS or self._damping > HIGHEST_DAMPING:
            self.ended = True
        elif size < self.size:
            self.q, self.residual, self.jacobian = trial, residual, jacobian
            self._damping = max(self._damping * min(0.03, size / self.size), LAST_DAMPING)
            self.size = size
        else:
            self._damping *= 10

    def put(self, own: Any, q: list[Any]) -> None:
        """Writes coordinates of the part among all."""
        for j, x in zip(self.part.coordinates, own.entries(), strict=True):
            q[j] = x

    def _own(self, geometry: tuple[Any, Any]) -> tuple[Any, Any]:
        residual, jacobian = geometry
        return self._units * residual, self._units * jacobian


def _step(residual: Any, jacobian: Any, damping: float) -> Any:
    """J' (J J' + shift)^-1 g (n x 1); None where rounding leaves the matrix singular, so that more damping is due.

    A step is a number: bounds of it would grow by 1 / damping for each row that depends on others, until they hold no
    digit of a step that is exact to half of the working precision.
    """
    gram = (jacobian * jacobian.transpose()).mid()
    shift = damping * max(float(gram.trace()) / gram.nrows(), 1e-30)
    try:
        return jacobian.transpose() * (gram + identity(gram.nrows()) * shift).solve(residual, algorithm="approx")
    except ZeroDivisionError:
        return None


def admissible(
    system: ReferenceSystem,
    q: Sequence[Any],
    shift: Sequence[float],
    parameters: Sequence[Any],
    literals: Sequence[Any],
) -> list[Any]:
    """The part of a shift that leaves the geometric rows as they are to first order; rows may depend on each other."""
    geometry = system.loop_geometry(column(q).entries(), parameters, literals)
    moved, pieces = column(shift), []
    for part, units, (_, jacobian) in zip(system.loops, _units(system, geometry), geometry, strict=True):
        rows = powers(units) * jacobian.mid()
        step = _step(rows * piece(moved, part.coordinates, (0,)), rows, LAST_DAMPING)
        if step is not None:
            pieces.append((part.coordinates, (0,), step))
    return list((moved - placed(system.n, 1, pieces)).mid().entries())


def _units(system: ReferenceSystem, geometry: Sequence[tuple[Any, Any]]) -> list[list[int]]:
    """Powers of 2 that bring the rows of each loop to ordinary size.

    Where loading found what rows usually are that counts: of some nothing but rounding is left on V.
    """
    if system.model.assembly is not None and system.model.assembly.units:
        return [[system.model.assembly.units[i] for i in loop.rows] for loop in system.loops]
    sizes = [[max((abs(float(x)) for x in row), default=0.0) for row in rows.tolist()] for _, rows in geometry]
    return [[-frexp(size)[1] if 0 < size < inf else 0 for size in these] for these in sizes]


def powers(exponents: Sequence[int]) -> Any:
    """Powers of 2 on a diagonal."""
    matrix = arb_mat(len(exponents), len(exponents))
    for i, exponent in enumerate(exponents):
        matrix[i, i] = 2.0**exponent
    return matrix
