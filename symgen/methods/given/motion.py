"""Rates and accelerations that what is given determines along a null space: measured coordinates, or a task.

Rows of B that leave delta directions, and functions x(q) that tell these apart, determine the rest (Merlet, Parallel
Robots, ch. 4).  With M the columns of their gradients, q_dot = (M~^+)^T x_dot; of more functions than directions that
is what is nearest to all of them within ker B.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from symgen.linear_algebra.guards import Guard
from symgen.methods.given.functions import Given, turning
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Vector, dot, matvec
from symgen.symbolic.scalar import Scalar
from symgen.validity.solvable import solvable

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation


class GivenMotion:
    """What given rates and accelerations determine along a null space."""

    def __init__(self, derivation: Derivation, given: Given) -> None:
        self._derivation, self._space, self._given = derivation, derivation.space, given
        columns = list(given.slopes)
        forms, self._restriction = self._space.actuation(columns, self._space.delta)
        self._forms = forms.cancelled(derivation.mechanics.factoring.cancelled)
        guards = solvable(derivation.mechanics, derivation.generic, self._space, self._forms, columns, given.status)
        of_rows = self._space.guards
        self.guards: tuple[Guard, ...] = (*of_rows, *(guard for guard in guards if guard not in of_rows))

    @property
    def velocity(self) -> Vector:
        """q_dot with B q_dot = 0 and the given rates, or nearest to them."""
        return self._nearest(self._given.rates)

    @property
    def acceleration(self) -> Vector:
        """q_ddot with B q_ddot + B_dot q_dot = 0 at that velocity and the given ones, or nearest to them."""
        graph, mechanics, given = self._derivation.graph, self._derivation.mechanics, self._given
        velocity = self.velocity
        motion = dict(zip(mechanics.q, velocity, strict=True))
        if len(given.functions) == self._space.delta:
            # differentiated, what has been cancelled stays so
            change = derivative_along(graph, velocity, motion)
            return tuple(a + b for a, b in zip(self._nearest(given.accelerations), change, strict=True))
        bent = turning(graph, given.slopes, motion, velocity)
        left = [x - y for x, y in zip(given.accelerations, bent, strict=True)]
        if not mechanics.r:
            return self._nearest(left)
        least: Vector = tuple(-x for x in self._space.lift(mechanics.constraint_acceleration_bias(velocity)))
        rest = [x - y for x, y in zip(left, matvec(graph, given.slopes, least), strict=True)]
        return tuple(a + b for a, b in zip(least, self._nearest(rest), strict=True))

    def _nearest(self, values: Sequence[Scalar]) -> Vector:
        """(M~^+)^T y: what M~^+ f is linear in, in one reverse sweep."""
        graph = self._derivation.graph
        force = tuple(graph.symbol(f"force {k}") for k in range(self._derivation.n))
        work = dot(graph, values, self._forms.solve(self._restriction(force)))
        return tuple(gradient(graph, work, force))
