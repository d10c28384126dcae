"""Rates and accelerations that what is given determines: measured coordinates, or a task.

Rows of B that leave delta directions, and functions x(q) that tell these apart, determine the rest (Merlet, Parallel
Robots, ch. 4).  With M the columns of their gradients, q_dot = (M~^+)^T x_dot; of more functions than directions that
is what is nearest to all of them within ker B.  As many as directions, with rows that do not depend on each other, make
a square system [B; M^T] q_dot = [0; x_dot], which is solved leg by leg where that counts less.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.sparser_rows import SparserRows
from symgen.linear_algebra.triangular_blocks import BlockwiseSolution, triangular_blocks
from symgen.methods.given import Given
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Matrix, Vector, dot, flatten, matvec
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost
from symgen.validity.solvable import solvable

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation


@dataclass(frozen=True, slots=True)
class _Legs:
    """Combinations of rows and functions that are solved leg by leg."""

    rows: SparserRows
    solution: BlockwiseSolution

    def solve(self, right: Vector) -> Vector:
        """The unknowns, for the right-hand sides of rows and functions as they are given."""
        return self.solution.solve(self.rows.of(right))


class GivenMotion:
    """What given rates and accelerations determine along a null space."""

    def __init__(self, derivation: Derivation, given: Given) -> None:
        self._derivation, self._space, self._given = derivation, derivation.space, given
        columns = list(given.slopes)
        forms, self._restriction = self._space.actuation(columns, self._space.delta)
        self._forms = forms.cancelled(derivation.mechanics.factoring.cancelled)
        found = solvable(derivation.mechanics, derivation.generic, self._space, self._forms, columns, given.status)
        of_rows = self._space.guards
        self.guards: tuple[Guard, ...] = (*of_rows, *(guard for guard in found if guard not in of_rows))
        self._legs = self._solved_by_legs()
        if self._legs is not None:
            self.guards = self._legs.solution.guards(given.status, of_rows)

    def _solved_by_legs(self) -> _Legs | None:
        """Rows and functions together, where they are square and take fewer operations."""
        graph, mechanics, given = self._derivation.graph, self._derivation.mechanics, self._given
        if mechanics.r + len(given.functions) != mechanics.n or len(given.functions) != self._space.delta:
            return None
        rows = SparserRows((*mechanics.constraint_jacobian, *given.slopes))
        blocks = triangular_blocks([[not x.is_zero for x in row] for row in rows.matrix])
        if blocks is None:
            return None
        legs = _Legs(rows, BlockwiseSolution(graph, rows.matrix, blocks, mechanics.factoring.cancelled))
        shorter = cost(legs.solve(self._rates)).weight < cost(self._nearest(given.rates)).weight
        return legs if shorter else None

    @property
    def _rates(self) -> Vector:
        """Of rows and functions."""
        return (*(self._derivation.graph.zero for _ in range(self._derivation.mechanics.r)), *self._given.rates)

    @property
    def velocity(self) -> Vector:
        """q_dot with B q_dot = 0 and the given rates, or nearest to them."""
        return self._nearest(self._given.rates) if self._legs is None else self._legs.solve(self._rates)

    @property
    def acceleration(self) -> Vector:
        """q_ddot with B q_ddot + B_dot q_dot = 0 at that velocity and the given ones, or nearest to them."""
        graph, mechanics, given = self._derivation.graph, self._derivation.mechanics, self._given
        velocity = self.velocity
        motion = dict(zip(mechanics.q, velocity, strict=True))
        if self._legs is not None:
            return self._acceleration_of(self._legs, motion)
        if len(given.functions) == self._space.delta:
            # differentiated, what has been cancelled stays so
            turning = derivative_along(graph, velocity, motion)
            return tuple(a + b for a, b in zip(self._nearest(given.accelerations), turning, strict=True))
        bent = self._bent(given.slopes, motion)
        left = [x - y for x, y in zip(given.accelerations, bent, strict=True)]
        if not mechanics.r:
            return self._nearest(left)
        least: Vector = tuple(-x for x in self._space.lift(mechanics.constraint_acceleration_bias(velocity)))
        rest = [x - y for x, y in zip(left, matvec(graph, given.slopes, least), strict=True)]
        return tuple(a + b for a, b in zip(least, self._nearest(rest), strict=True))

    def _acceleration_of(self, legs: _Legs, motion: Mapping[Scalar, Scalar]) -> Vector:
        """With what rows change by taken of their combinations, or of rows as they stand, whichever counts less."""
        mechanics, given = self._derivation.mechanics, self._given
        bias = mechanics.constraint_acceleration_bias(tuple(motion.values())) if mechanics.r else ()
        changes = legs.rows.of((*bias, *self._bent(given.slopes, motion))), self._bent(legs.rows.matrix, motion)
        wanted = legs.rows.of((*(self._derivation.graph.zero for _ in bias), *given.accelerations))
        found = (legs.solution.solve([x - y for x, y in zip(wanted, one, strict=True)]) for one in changes)
        return min(found, key=lambda one: cost(one).weight)

    def _bent(self, rows: Matrix, motion: Mapping[Scalar, Scalar]) -> list[Scalar]:
        """How rows change along a velocity, times it."""
        graph = self._derivation.graph
        changes = iter(derivative_along(graph, flatten(rows), motion))
        return [dot(graph, [next(changes) for _ in row], tuple(motion.values())) for row in rows]

    def _nearest(self, values: Sequence[Scalar]) -> Vector:
        """(M~^+)^T y: what M~^+ f is linear in, in one reverse sweep."""
        graph = self._derivation.graph
        force = tuple(graph.symbol(f"force {k}") for k in range(self._derivation.n))
        work = dot(graph, values, self._forms.solve(self._restriction(force)))
        return tuple(gradient(graph, work, force))
