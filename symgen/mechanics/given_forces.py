"""Forces that are given part by part: inputs, applied forces and the written potential, without those of bodies."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from symgen.model.expressions.expression import Expression
from symgen.symbolic.calculus import gradient
from symgen.symbolic.matrix import Vector, matvec
from symgen.symbolic.scalar import Scalar

if TYPE_CHECKING:
    from symgen.mechanics.system import System


class GivenForces:
    """M u + Q_a less the gradient of the written potential (n), and what it is the sum of."""

    def __init__(self, mechanics: System) -> None:
        self._mechanics, self._graph = mechanics, mechanics.graph

    @cached_property
    def total(self) -> Vector:
        """The force of all parts."""
        mechanics = self._mechanics
        driven = matvec(self._graph, mechanics.control_matrix, mechanics.u)
        slopes = self._slopes()
        return tuple(u + a - f for u, a, f in zip(driven, mechanics.applied_force, slopes, strict=True))

    @cached_property
    def parts(self) -> list[tuple[Scalar, Vector, Expression | None]]:
        """For each a magnitude, the force of 1, and the rate that it works on where it has one."""
        mechanics, model = self._mechanics, self._mechanics.model
        slopes = self._slopes()
        rates = [*(i.velocity for i in model.inputs), None, *(force.velocity for force in model.forces)]
        forces = [*zip(mechanics.u, mechanics.inputs, strict=True), *mechanics.applied_parts]
        parts = [(x, force, velocity) for (x, force), velocity in zip(forces, rates, strict=True)]
        return [*parts, (self._graph.const(-1), slopes, None)]

    def along(self, direction: Mapping[int, Scalar]) -> Scalar:
        """The component of the total along a direction in the coordinates.

        Input by input and force by force, because it is exactly 0 of each of them that does no work there.
        """
        along = ((x, self._graph.sum(force[j] * d for j, d in direction.items())) for x, force, _ in self.parts)
        return self._graph.sum(x * component for x, component in along if not component.is_zero)

    def _slopes(self) -> Vector:
        return tuple(gradient(self._graph, self._mechanics.written_potential, self._mechanics.q))
