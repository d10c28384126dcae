"""A machine whose encoders say some of its coordinates: rates and accelerations of all others.

Rows of B that leave delta directions, and measured coordinates that tell these apart, determine the rest (Merlet,
Parallel Robots, ch. 4).  With M the columns that select the measured coordinates, q_dot = (M~^+)^T q_dot_m; of more
coordinates than directions that is what is nearest to all of them within ker B.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Vector, dot, identity
from symgen.symbolic.scalar import Scalar
from symgen.validity.solvable import solvable

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation


class MeasuredMotion:
    """What measured rates and accelerations determine along a null space."""

    def __init__(self, derivation: Derivation) -> None:
        self._derivation, self._space = derivation, derivation.space
        units = identity(derivation.graph, derivation.n)
        self._places = derivation.mechanics.model.measured_places
        columns = [units[k] for k in self._places]
        forms, self._restriction = self._space.actuation(columns, self._space.delta)
        self._forms = forms.cancelled(derivation.mechanics.factoring.cancelled)
        mechanics, status = derivation.mechanics, Status.MEASURED_RANK
        found = solvable(mechanics, derivation.generic, self._space, self._forms, columns, status)
        of_rows = self._space.guards
        self.guards: tuple[Guard, ...] = (*of_rows, *(guard for guard in found if guard not in of_rows))

    @property
    def velocity(self) -> Vector:
        """q_dot with B q_dot = 0 and the measured rates, or nearest to them."""
        _, rates, _ = self._derivation.mechanics.measured
        return self._nearest(rates)

    @property
    def acceleration(self) -> Vector:
        """q_ddot with B q_ddot + B_dot q_dot = 0 at that velocity and the measured ones, or nearest to them."""
        graph, mechanics = self._derivation.graph, self._derivation.mechanics
        _, _, given = mechanics.measured
        velocity = self.velocity
        if len(given) == self._space.delta:
            # differentiated, what has been cancelled stays so
            turning = derivative_along(graph, velocity, dict(zip(mechanics.q, velocity, strict=True)))
            return tuple(a + b for a, b in zip(self._nearest(given), turning, strict=True))
        if not mechanics.r:
            return self._nearest(given)
        least = [-x for x in self._space.lift(mechanics.constraint_acceleration_bias(velocity))]
        rest = [x - least[k] for x, k in zip(given, self._places, strict=True)]
        return tuple(a + b for a, b in zip(least, self._nearest(rest), strict=True))

    def _nearest(self, given: Sequence[Scalar]) -> Vector:
        """(M~^+)^T y: what M~^+ f is linear in, in one reverse sweep."""
        graph = self._derivation.graph
        force = tuple(graph.symbol(f"force {k}") for k in range(self._derivation.n))
        work = dot(graph, given, self._forms.solve(self._restriction(force)))
        return tuple(gradient(graph, work, force))
