"""u with friction that grows with the reactions it changes itself (Remark 3).

M u - B^T lambda = tau + D(lambda),  D(lambda) = sum_j s_j d_j n_j,  n_j = |R_j| the reaction that place j carries.

u is the smallest one that produces the motion with the friction as it is, u = M~^+ (tau + D), and
lambda = (B^+)^T (M u - tau - D): both are affine in the loads n_j, which `friction_loads` works out.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import chain

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import NullSpace
from symgen.mechanics.system import System
from symgen.methods.friction.loads import FrictionLoads
from symgen.methods.friction.rough_columns import RoughColumns
from symgen.methods.method import divisors
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.symbolic.scalar import Scalar


class ReactionFriction:
    """The friction of one model's rough places along one null space; `solve` gives u for a generalized force."""

    def __init__(self, mechanics: System, space: NullSpace, solve: Callable[[Vector], Vector]) -> None:
        self._mechanics, self._space, self._solve = mechanics, space, solve
        self._rough = RoughColumns(mechanics)

    @cached_property
    def _smooth_inputs(self) -> Vector:
        """u (m) without friction."""
        return self._solve(self._mechanics.balance)

    @cached_property
    def _unit_inputs(self) -> tuple[Vector, ...]:
        """M~^+ s_j (m): the inputs that a unit of friction at each place takes."""
        return tuple(self._solve(column) for column in self._rough.columns)

    @cached_property
    def _point(self) -> FrictionLoads:
        rough, balance = self._rough, self._mechanics.balance
        free = rough.loaded(self._reactions(balance, rough.balance, self._smooth_inputs))
        units = zip(rough.columns, rough.beside, self._unit_inputs, strict=True)
        answers = [rough.unloaded(self._reactions(*unit)) for unit in units]
        steps = self._mechanics.model.friction_steps
        return FrictionLoads(self._mechanics.graph, free, answers, rough.sizes, rough.directions, steps)

    def _reactions(self, force: Vector, beside: Vector, inputs: Vector) -> tuple[Vector, ...]:
        """What each place carries where a generalized force, and one along what is let go, is met by these inputs."""
        supplied = matvec(self._mechanics.graph, self._mechanics.control_matrix, inputs)
        rest = subtract_vectors(supplied, force)
        return self._rough.reactions(beside, inputs, self._space.lift_transposed(rest) if self._mechanics.r else ())

    @property
    def guards(self) -> tuple[Guard, ...]:
        """That friction does not lock."""
        return self._point.guards

    @property
    def inputs(self) -> Vector:
        """u (m), friction included."""
        return self._point.added(self._smooth_inputs, self._unit_inputs, self._point.loads)

    @property
    def force(self) -> Vector:
        """D (n): what friction takes, with each load worked out once more from the others."""
        none = (self._mechanics.graph.zero,) * self._mechanics.n
        return self._point.added(none, self._rough.columns, self._point.once_more)

    @property
    def harmless_divisors(self) -> tuple[Scalar, ...]:
        """What loads are divided by beside what u and reactions without friction are: none is below one half."""
        known = {*divisors((*self._smooth_inputs, *chain(*self._unit_inputs), *self._point.given))}
        return tuple(one for one in divisors(self.inputs) if one not in known)
