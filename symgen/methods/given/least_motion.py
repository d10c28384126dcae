"""Motions of a task with fewer functions than directions: the least of them, and those that leave the task still.

Rows and functions stacked are A = [B; X], X the derivatives of x(q).  Of all rates with A q_dot = [0; x_dot] the least
are A^+ [0; x_dot], in the norm of the coordinates as they are given; N_x = I - A^+ A projects onto those that change
nothing of the task, and q_dot + N_x z has the same x_dot for every z (Siciliano et al., Robotics, 3.5).

Rows turned and added to each other have the same solutions, the least among them: of a planar arm what is left are
the lengths and the sines of its joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import MinorSpace, NullSpace, has_few_minors
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.linear_algebra.rows.sparser_rows import SparserRows
from symgen.linear_algebra.rows.turned_rows import TurnedRows
from symgen.methods.given.functions import Given
from symgen.methods.given.motion import GivenMotion
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.scalar import Scalar
from symgen.validity.solvable import standing_out

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation


class LeastMotion:
    """The null space of rows and functions together, found as that of B is."""

    def __init__(self, derivation: Derivation, given: Given) -> None:
        self._derivation, self._given = derivation, given
        graph, mechanics, n = derivation.graph, derivation.mechanics, derivation.n
        self._turned = TurnedRows(graph, (*mechanics.constraint_jacobian, *given.slopes), mechanics.q)
        self._combined = SparserRows(self._turned.matrix)
        rows, rank = self._combined.matrix, derivation.generic.rank + len(given.slopes)
        self._space: NullSpace = reflected(graph, rows, n, rank)
        if isinstance(derivation.space, MinorSpace) and has_few_minors(rows, rank):
            # multiplied out they are products of lengths and sines, all of whose digits hold beside a singularity
            self._space = MinorSpace(graph, rows, n, rank, mechanics.factoring.cancelled)

    @property
    def velocity(self) -> Vector:
        """The least q_dot with B q_dot = 0 and the given rates."""
        return self._least(self._given.rates)

    @property
    def acceleration(self) -> Vector:
        """q_ddot of the motion that has these rates at all times: their derivative.

        Less its part along N_x it is the least q_ddot with B q_ddot + B_dot q_dot = 0 and the given accelerations; a
        motion that has those would leave the rates that are least.
        """
        graph, velocity = self._derivation.graph, self.velocity
        change = derivative_along(graph, velocity, dict(zip(self._derivation.mechanics.q, velocity, strict=True)))
        return tuple(a + b for a, b in zip(self._least(self._given.accelerations), change, strict=True))

    @property
    def projector(self) -> Matrix:
        """N_x, n x n."""
        return self._space.projector

    @property
    def guards(self) -> tuple[Guard, ...]:
        """Where B loses rank, which is named first, and where the functions do beside it."""
        given, of_rows = self._given, self._derivation.space.guards
        of_both = (replace(guard, status=given.status, first=of_rows) for guard in self._space.guards)
        short = standing_out(self._derivation.mechanics, given.slopes, given.status, of_rows)
        return tuple(dict.fromkeys((*short, *of_both)))

    def _least(self, values: Sequence[Scalar]) -> Vector:
        """A^+ [0; values]."""
        right = ((self._derivation.graph.zero,) * self._derivation.r, values)
        return self._space.lift(tuple(self._combined.of(self._turned.of([x for part in right for x in part]))))


MotionOfGiven: TypeAlias = GivenMotion | LeastMotion


def motion_of(derivation: Derivation, given: Given) -> MotionOfGiven:
    """What is given determines the motion, or leaves directions open."""
    leaves_open = len(given.functions) < derivation.generic.delta
    return LeastMotion(derivation, given) if leaves_open else GivenMotion(derivation, given)
