"""Rates and accelerations from what is given, leg by leg: [B; X] q_dot = [0; x_dot], X the derivatives of x(q).

As many functions as directions and rows that do not depend on each other make a square system.  Rows of numbers are
solved first, the others are turned and added to each other where that leaves fewer entries, and what is left falls into
blocks of a few unknowns each.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.linear_algebra.guards import Guard, tested
from symgen.linear_algebra.rows.constant_rows import ConstantRows
from symgen.linear_algebra.rows.sparser_rows import SparserRows
from symgen.linear_algebra.rows.turned_rows import TurnedRows
from symgen.linear_algebra.triangular_blocks import BlockwiseSolution, triangular_blocks
from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.given.functions import Given, given_of, turning
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.spaces import along_minors, along_reflections
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost


@dataclass(frozen=True, slots=True)
class LegMotion:
    """The square system of rows and functions: without rows of numbers, turned, combined, and in blocks."""

    mechanics: System
    given: Given
    numbers: ConstantRows
    turned: TurnedRows
    rows: SparserRows
    solution: BlockwiseSolution

    @property
    def velocity(self) -> Vector:
        """q_dot with B q_dot = 0 and the given rates."""
        right = (*self._zeros, *self.given.rates)
        return self.numbers.completed(self.solution.solve(self._of(right)), right)

    @property
    def acceleration(self) -> Vector:
        """q_ddot with B q_ddot + B_dot q_dot = 0 at that velocity and the given ones.

        With what rows change by taken of their combinations, or of rows as they stand, whichever counts less.
        """
        velocity = self.velocity
        motion = dict(zip(self.mechanics.q, velocity, strict=True))
        graph, zeros = self.mechanics.graph, self._zeros
        bias = self.mechanics.constraint_acceleration_bias(velocity) if self.mechanics.r else ()
        bent = (*bias, *turning(graph, self.given.slopes, motion, velocity))
        given = (*zeros, *self.given.accelerations)
        right = [x - y for x, y in zip(given, bent, strict=True)]
        # the right-hand sides of combinations change, too, with what they were combined by
        together = turning(graph, self.rows.matrix, motion, self.numbers.kept(velocity))
        sides = derivative_along(graph, self._of((*zeros, *self.given.rates)), motion)
        changes = (x - y for x, y in zip(sides, together, strict=True))
        combined = [x + y for x, y in zip(self._of(given), changes, strict=True)]
        solutions = map(self.solution.solve, (self._of(right), combined))
        return self.numbers.completed(min(solutions, key=lambda one: cost(one).weight if one else 0), right)

    def _of(self, right: Sequence[Scalar]) -> list[Scalar]:
        """The right-hand sides of the blocks."""
        return self.rows.of(self.turned.of(self.numbers.of(right)))

    @property
    def _zeros(self) -> Vector:
        return (self.mechanics.graph.zero,) * self.mechanics.r


def leg_motion(system: MethodInput, given: Given) -> LegMotion | str:
    """The motion leg by leg, or why there is none."""
    mechanics = system.mechanics
    if system.regular is not None:
        return system.regular
    if len(given.functions) + mechanics.r != mechanics.n:
        return "what is given is more than determines the motion, or less"
    numbers = ConstantRows((*mechanics.constraint_jacobian, *given.slopes))
    turned = TurnedRows(mechanics.graph, numbers.matrix, mechanics.q)
    rows = SparserRows(turned.matrix)
    blocks = triangular_blocks([[not x.is_zero for x in row] for row in rows.matrix])
    if blocks is None:
        return "what is given does not determine the motion"
    solution = BlockwiseSolution(mechanics.graph, rows.matrix, blocks, mechanics.factoring.cancelled)
    return LegMotion(mechanics, given, numbers, turned, rows, solution)


@dataclass(frozen=True, slots=True)
class _ByLegs(ByTheorem):
    """`theorem` says why it is valid wherever rows and functions keep their rank together."""

    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """Rates or accelerations (n), or why there are none."""
        system = MethodInput.fresh(workspace.model, workspace.generic)
        given = given_of(quantity, system.mechanics)
        motion = leg_motion(system, given)
        if isinstance(motion, str):
            return motion
        outputs = motion.velocity if quantity.startswith("velocity") else motion.acceleration
        guards = motion.solution.guards(given.status, _of_rows(system))
        return Candidate(system, Quantity(quantity, (len(outputs),), outputs, tested(guards)))


def _of_rows(system: MethodInput) -> tuple[Guard, ...]:
    """Where B itself loses rank, which is told first."""
    for along in (along_minors, along_reflections):
        derivation = along(system.mechanics, system.generic)
        if not isinstance(derivation, str):
            return derivation.space.guards
    return ()


BY_LEGS: Method = _ByLegs("its determinants multiplied are that of the rows and of what is given together")
