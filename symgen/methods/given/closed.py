"""The configuration with given values of functions in closed form, by the steps that `steps` finds."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard, tested
from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.given.functions import Given, given_of
from symgen.methods.given.row_solution import RowSolution, SolvableRow, solved, within_a_quarter
from symgen.methods.given.steps import ClosedSteps, Last, ReplacedUnknown, Side, TurnedByAngle, steps
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.arcs import turn_of
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute


@dataclass(frozen=True, slots=True)
class ClosedConfiguration:
    """The configuration, and where it is none."""

    outputs: Vector
    guards: tuple[Guard, ...]


def closed_configuration(mechanics: System, given: Given) -> ClosedConfiguration | None:
    """In closed form; None where rows are not of these kinds, or not as many as there are unknowns."""
    pairs = zip(given.places, given.values, strict=True)
    known = {mechanics.q[place]: value for place, value in pairs if place >= 0}
    others = [k for k, place in enumerate(given.places) if place < 0]
    rows = [*mechanics.constraint_residual, *(given.functions[k] - given.values[k] for k in others)]
    closed_steps = steps(mechanics.graph, rows, [x for x in mechanics.q if x not in known])
    if closed_steps is None:
        return None
    unknowns = _Unknowns(mechanics.graph, given, known, closed_steps)
    return ClosedConfiguration(tuple(unknowns.known[x] for x in mechanics.q), tuple(dict.fromkeys(unknowns.guards)))


class _Unknowns:
    """Their values one after the other: what is known so far, at first what is given."""

    def __init__(self, graph: Graph, given: Given, known: dict[Scalar, Scalar], closed_steps: ClosedSteps) -> None:
        self._graph, self._given = graph, given
        self._signs = {one.sign: graph.function("copysign", (graph.one, one.start)) for one in closed_steps.sides}
        self.known, self.guards = dict(known), list[Guard]()
        for side in closed_steps.sides:
            self._on_its_side(side)
        for one in closed_steps.first:
            self._of_row(one) if isinstance(one, SolvableRow) else self._of_angle(one)
        for last in closed_steps.last:
            self._of_replaced(last)

    def _on_its_side(self, side: Side) -> None:
        """Neither the start nor what is given lies where both sides meet, and what is given is not beyond."""
        square, size = self._now((side.square, side.size))
        beyond = Guard(Status.NOT_CLOSED, -square, 2, scale=size, positive=True, small=True)
        self.guards += [
            Guard(self._given.status, side.start * side.start, 2),
            Guard(self._given.status, square, 2, scale=size, first=(beyond,)),
        ]

    def _of_row(self, row: SolvableRow) -> None:
        """One row, for its unknown."""
        value, slope, bend = self._now(row.scalars)
        first = substitute(self._graph, row.scalars, self._signs)
        start = first[0], first[1], first[2]
        self._take(row.unknown, solved(self._graph, row, (value, slope, bend), start, self._given.status))

    def _of_replaced(self, one: Last) -> None:
        if isinstance(one, ReplacedUnknown):
            (value,) = self._now([one.value])
            self.known[one.unknown] = self._graph.rounded(value)
        else:
            self._of_angle(one)

    def _of_angle(self, turned: TurnedByAngle) -> None:
        """The turn from its part of the rows to what is to balance it."""
        graph = self._graph
        x, y, first, second = self._now((*turned.arm, *turned.rows))
        square = x * x + y * y
        across = x * second - y * first
        tangent = (across if turned.backwards else -across) / (2 * square - (x * first + y * second))
        guards = Guard(self._given.status, square, 2), within_a_quarter(graph, tangent)
        self._take(turned.angle, RowSolution(turn_of(graph, tangent), guards))

    def _now(self, scalars: Sequence[Scalar]) -> list[Scalar]:
        """With what is known in its place, and on the sides of the start."""
        return substitute(self._graph, scalars, {**self._signs, **self.known})

    def _take(self, unknown: Scalar, one: RowSolution) -> None:
        """A number from here on: there is no place for algebra with what led to it."""
        self.known[unknown] = self._graph.rounded(unknown + one.change)
        self.guards += one.guards


@dataclass(frozen=True, slots=True)
class _Closed(ByTheorem):
    """`theorem` says why it is valid wherever rows and functions keep their rank together."""

    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The configuration (n), or why there is none."""
        system = MethodInput.fresh(workspace.model, workspace.generic)
        closed = closed_configuration(system.mechanics, given_of(quantity, system.mechanics))
        if closed is None:
            return "its rows are no chains of two links, and hold more than one unknown"
        return Candidate(system, Quantity(quantity, (len(closed.outputs),), closed.outputs, tested(closed.guards)))


CLOSED: Method = _Closed("its roots multiplied are the determinant of the rows and of what is given together")
