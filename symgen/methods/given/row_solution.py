"""One equation f(x) = 0 in one unknown, solved in closed form from a place nearby on the side where that place is.

An angle that enters as a cos x + b sin x + c does so in every chain of two links and in every leg that ends in a sphere
or a slide; with f, f' and f'' at the place, its half turn's tangent is t = -f / (f' + R), R^2 = f'^2 - f (f + 2 f'').
R is what f' is at the solution: of its two signs one belongs to the assembly mode of the place, and where R vanishes
the two modes meet.  Nothing cancels of a small f.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.records import dataclass
from symgen.symbolic.arcs import turn_of
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

Form: TypeAlias = Literal["linear", "quadratic", "angle"]


@dataclass(frozen=True, slots=True)
class SolvableRow:
    """A function of an unknown x in one of the forms that are solved, with its first two derivatives by x."""

    form: Form
    unknown: Scalar
    value: Scalar
    slope: Scalar
    bend: Scalar

    @property
    def scalars(self) -> tuple[Scalar, Scalar, Scalar]:
        """The function and both derivatives."""
        return self.value, self.slope, self.bend


@dataclass(frozen=True, slots=True)
class RowSolution:
    """By how much x changes, and where that is no solution, another one or one of a pair that meets."""

    change: Scalar
    guards: tuple[Guard, ...]


def solvable_row(graph: Graph, value: Scalar, unknown: Scalar) -> SolvableRow | None:
    """The row where its derivatives are those of one of the forms, identically."""
    derivatives = [value]
    for _ in range(3):
        derivatives += derivative_along(graph, derivatives[-1:], {unknown: graph.one})
    value, slope, bend, third = derivatives
    if slope.is_zero:
        return None
    if bend.is_zero:
        return SolvableRow("linear", unknown, value, slope, bend)
    if third.is_zero:
        return SolvableRow("quadratic", unknown, value, slope, bend)
    return SolvableRow("angle", unknown, value, slope, bend) if (third + slope).is_zero else None


def solved(
    graph: Graph,
    row: SolvableRow,
    here: tuple[Scalar, Scalar, Scalar],
    start: tuple[Scalar, Scalar, Scalar],
    status: Status,
) -> RowSolution:
    """The solution from the function and its derivatives `here`, where what is known is new and x as at the start, and
    at the `start`, where nothing is new; `status` is told where modes meet."""
    value, slope, bend = here
    _, first_slope, first_bend = start
    if row.form == "linear":
        guards = [Guard(status, slope, 1), *_same_side(graph, slope, first_slope)]
        return RowSolution(-(value / slope), tuple(guards))
    if row.form == "quadratic":
        square, size, first_size = slope * slope - 2 * (bend * value), None, None
    else:
        # squares of a^2 + b^2 for a cos x + b sin x
        size, first_size = slope * slope + bend * bend, first_slope * first_slope + first_bend * first_bend
        square = slope * slope - value * (value + 2 * bend)
    root = graph.function("copysign", (graph.function("sqrt", (square,)), slope))
    # below 0 there is no solution: the place is out of reach
    beyond = Guard(Status.NOT_CLOSED, -square, 2, scale=size, positive=True, small=True)
    guards = [
        Guard(status, first_slope * first_slope, 2, scale=first_size),
        Guard(status, square, 2, scale=size, first=(beyond,)),
        *_same_side(graph, slope, first_slope),
    ]
    if row.form == "quadratic":
        return RowSolution(-(2 * value / (slope + root)), tuple(guards))
    tangent = -(value / (slope + root))
    return RowSolution(turn_of(graph, tangent), (*guards, within_a_quarter(graph, tangent)))


def within_a_quarter(graph: Graph, tangent: Scalar) -> Guard:
    """That a turn with this tangent of its half is less than a quarter: further away it is no place nearby."""
    return Guard(Status.BRANCH, 1 - tangent * tangent, 1, scale=graph.one, positive=True)


def _same_side(graph: Graph, slope: Scalar, first: Scalar) -> tuple[Guard, ...]:
    """That no place where modes meet lies between."""
    if slope is first:
        return ()
    sides = graph.function("copysign", (graph.one, slope)) * graph.function("copysign", (graph.one, first))
    return () if sides.constant is not None else (Guard(Status.BRANCH, sides, 1, scale=graph.one, positive=True),)
