"""The configuration with given values of functions, in closed form: one unknown a row, or two links that meet.

Rows that contain one unknown are solved for it, one after the other.  Where two rows share two unknowns x and y, and x
turns both alike, (f_1, f_2) = R(x) a(y) + c(y) as a link that turns about its joint does, |c|^2 = |a|^2 is one row for
y, and x is the turn from a to -c: chains of two links, four-bars, legs of parallel robots in the plane (Merlet,
Parallel Robots, ch. 2; Craig, Introduction to Robotics, ch. 4).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations, permutations

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.sparser_rows import SparserRows
from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.given.functions import Given, given_of
from symgen.methods.given.row_solution import RowSolution, SolvableRow, solvable_row, solved, within_a_quarter
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.arcs import turn_of
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import reached, substitute


@dataclass(frozen=True, slots=True)
class TurnedPair:
    """Two rows, an angle that turns both of them, their turning parts, and the row of the other unknown."""

    rows: tuple[Scalar, Scalar]
    angle: Scalar
    arm: tuple[Scalar, Scalar]
    backwards: bool
    other: SolvableRow


@dataclass(frozen=True, slots=True)
class ClosedConfiguration:
    """The configuration, and where it is none."""

    outputs: Vector
    guards: tuple[Guard, ...]


def closed_configuration(mechanics: System, given: Given) -> ClosedConfiguration | None:
    """In closed form; None where rows are not of these kinds, or not as many as there are unknowns."""
    graph = mechanics.graph
    pairs = zip(given.places, given.values, strict=True)
    known = {mechanics.q[place]: value for place, value in pairs if place >= 0}
    others = [k for k, place in enumerate(given.places) if place < 0]
    functions = [*mechanics.constraint_residual, *(given.functions[k] - given.values[k] for k in others)]
    unknown = [x for x in mechanics.q if x not in known]
    if len(functions) != len(unknown):
        return None
    slopes = (*mechanics.geometric_jacobian, *(given.slopes[k] for k in others))
    columns = [k for k, x in enumerate(mechanics.q) if x not in known]
    rows = SparserRows(tuple(tuple(row[k] for k in columns) for row in slopes)).of(functions)
    steps = _steps(graph, rows, unknown)
    if steps is None:
        return None
    unknowns = _Unknowns(graph, given, dict(known))
    for step in steps:
        if isinstance(step, SolvableRow):
            unknowns.of_row(step)
        else:
            unknowns.of_pair(step)
    return ClosedConfiguration(tuple(unknowns.known[x] for x in mechanics.q), tuple(dict.fromkeys(unknowns.guards)))


def _steps(graph: Graph, rows: Sequence[Scalar], unknown: Sequence[Scalar]) -> list[SolvableRow | TurnedPair] | None:
    """What is solved one after the other; None where it does not come to an end."""
    left, open_ = {row: reached([row]).intersection(unknown) for row in rows}, set(unknown)
    steps: list[SolvableRow | TurnedPair] = []
    while left:
        step = _next(graph, {row: found & open_ for row, found in left.items()}, unknown)
        if step is None:
            return None
        done, solved_for = step
        these = (done.value,) if isinstance(done, SolvableRow) else done.rows
        steps.append(done)
        open_ -= set(solved_for)
        left = {row: found for row, found in left.items() if row not in these}
    return None if open_ else steps


def _next(
    graph: Graph, left: Mapping[Scalar, set[Scalar]], order: Sequence[Scalar]
) -> tuple[SolvableRow | TurnedPair, tuple[Scalar, ...]] | None:
    """A row with one unknown, else two with two."""
    for row, found in left.items():
        if len(found) == 1:
            (x,) = found
            one = solvable_row(graph, row, x)
            if one is not None:
                return one, (x,)
    for first, second in combinations(left, 2):
        pair = [x for x in order if x in left[first] | left[second]]
        if len(pair) == 2:
            for angle, other in permutations(pair):
                found_pair = _turned_pair(graph, (first, second), angle, other)
                if found_pair is not None:
                    return found_pair, (angle, other)
    return None


def _turned_pair(
    graph: Graph, rows: tuple[Scalar, Scalar], angle: Scalar, other: Scalar
) -> TurnedPair | None:
    """The pair where the angle turns both rows alike, to either side, identically."""
    along = {angle: graph.one}
    slopes = derivative_along(graph, rows, along)
    bends = derivative_along(graph, slopes, along)
    x, y = (-bend for bend in bends)
    if not (x + bends[0]).is_zero or x.is_zero:
        return None
    turned = [(slopes[0] + y, slopes[1] - x), (slopes[0] - y, slopes[1] + x)]
    backwards = next((k for k, both in enumerate(turned) if all(one.is_zero for one in both)), None)
    if backwards is None:
        return None
    rests = [row - part for row, part in zip(rows, (x, y), strict=True)]
    difference = dot(graph, rests, rests) - dot(graph, (x, y), (x, y))
    # it is the same at every angle, and shortest at 0
    (difference,) = substitute(graph, [difference], {angle: graph.zero})
    one = solvable_row(graph, difference, other)
    return None if one is None else TurnedPair(rows, angle, (x, y), bool(backwards), one)


class _Unknowns:
    """Their values one after the other: what is known so far, at first what is given."""

    def __init__(self, graph: Graph, given: Given, known: dict[Scalar, Scalar]) -> None:
        self._graph, self._given = graph, given
        self.known, self.guards = known, list[Guard]()

    def of_row(self, row: SolvableRow) -> None:
        """One row, for its unknown."""
        value, slope, bend = self._now(row.scalars)
        one = solved(self._graph, row, (value, slope, bend), row.scalars, self._given.status)
        self._take(row.unknown, one)

    def of_pair(self, pair: TurnedPair) -> None:
        """The other unknown, then the angle: the turn from its part of the rows to what is to balance it."""
        graph = self._graph
        self.of_row(pair.other)
        x, y, first, second = self._now((*pair.arm, *pair.rows))
        square = x * x + y * y
        across = x * second - y * first
        tangent = (across if pair.backwards else -across) / (2 * square - (x * first + y * second))
        guards = Guard(self._given.status, square, 2), within_a_quarter(graph, tangent)
        self._take(pair.angle, RowSolution(turn_of(graph, tangent), guards))

    def _now(self, scalars: Sequence[Scalar]) -> list[Scalar]:
        """With what is known in its place."""
        return substitute(self._graph, scalars, self.known)

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
        found = closed_configuration(system.mechanics, given_of(quantity, system.mechanics))
        if found is None:
            return "its rows are no chains of two links, and hold more than one unknown"
        tested = tuple(guard for guard in found.guards if guard.denominator.constant is None)
        return Candidate(system, Quantity(quantity, (len(found.outputs),), found.outputs, tested))


CLOSED: Method = _Closed("its roots multiplied are the determinant of the rows and of what is given together")
