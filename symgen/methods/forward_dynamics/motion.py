"""The equations of motion as one linear system, and its solution.

G q_ddot + B^T lambda = f and B q_ddot = -a, with f = M u - C q_dot - Q + Q_a and a = B_dot q_dot (3), (1).
"""

from __future__ import annotations

from functools import cached_property

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.system import System
from symgen.model.quantities import MOTIONS
from symgen.records import dataclass
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.polynomials.polynomial import Multiplier, refactored
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class Motion:
    """q_ddot (n) and lambda (r) with the denominators they depend on.

    Of `divisors` no theorem says that they vanish nowhere.
    """

    accelerations: Vector
    multipliers: Vector
    guards: tuple[Guard, ...]
    divisors: Vector = ()

    def part(self, quantity: str) -> Vector:
        """The one of both that a quantity is."""
        return self.accelerations if quantity == MOTIONS[0] else self.multipliers


class Problem:
    """A system's equations of motion; `guards` tell where B loses rank.

    Where rows may be `rows_in_line`, what rounding leaves along them while they are solved with is taken out again.
    """

    rows_in_line = False

    def __init__(self, mechanics: System, guards: tuple[Guard, ...]) -> None:
        self.graph: Graph = mechanics.graph
        self.guards = guards
        self.n, self.r = mechanics.n, mechanics.r
        self.mechanics = mechanics
        self._multipliers: dict[frozenset[Scalar], Multiplier] = {}

    @property
    def mass_matrix(self) -> Matrix:
        """G (n x n)."""
        return self.mechanics.mass_matrix

    @property
    def rows(self) -> Matrix:
        """B (r x n)."""
        return self.mechanics.constraint_jacobian

    @cached_property
    def force(self) -> Vector:
        """f (n)."""
        return self.mechanics.applied_balance

    @cached_property
    def bias(self) -> Vector:
        """a (r)."""
        return self.mechanics.constraint_acceleration_bias(self.mechanics.qd) if self.r else ()

    def multiplied_out(self, values: list[Scalar], kept: frozenset[Scalar] = frozenset()) -> list[Scalar]:
        """The values with sums of parameters multiplied out too, where that is not too long; sums in `kept` stay whole.

        Inertias that occur in several entries of G (an angle relative to a turning body) then cancel exactly.  What
        becomes small where a rank drops has to be kept: the square of a small difference, multiplied out, is the
        difference of numbers that are not small.
        """
        factoring = self.mechanics.factoring
        if kept not in self._multipliers:
            self._multipliers[kept] = factoring.multiplier(lambda node: node in kept)
        shared = share_angles(self.graph, values)
        expanded = refactored(self.graph, shared, self._multipliers[kept], factoring.fixed)
        same_values("multiplying sums of parameters out", shared, expanded)
        return expanded
