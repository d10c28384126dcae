"""In which steps rows are solved for their unknowns in closed form, found by identities of their derivatives.

A row with one unknown is solved for it (`row_solution`).  Where an angle x turns two rows alike,
(f_1, f_2) = R(x) a + c as a link that turns about its joint does, x is the turn from a to -c once the rest is known,
and |a| = |c| is the row that is left of them: chains of two links, four-bars, the column of an arm (Merlet, Parallel
Robots, ch. 2; Craig, Introduction to Robotics, ch. 4).  A row of numbers, such as a gear or what keeps a hand level,
gives one unknown by the others.  What is replaced so is worked out last.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, permutations
from typing import TypeAlias

from symgen.linear_algebra.rows.sparser_rows import MOST_ROWS_COMBINED, SparserRows
from symgen.methods.given.row_solution import SolvableRow, solvable_row
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import dot
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, reached, substitute


@dataclass(frozen=True, slots=True)
class TurnedByAngle:
    """Two rows, an angle that turns both of them, and their turning parts; `backwards` if to the other side."""

    rows: tuple[Scalar, Scalar]
    angle: Scalar
    arm: tuple[Scalar, Scalar]
    backwards: bool


@dataclass(frozen=True, slots=True)
class Side:
    """A root whose sign is that of a function at the start: the symbol of the sign, the function, and the square with
    what it is left of."""

    sign: Scalar
    start: Scalar
    square: Scalar
    size: Scalar


@dataclass(frozen=True, slots=True)
class ReplacedUnknown:
    """An unknown as a function of others."""

    unknown: Scalar
    value: Scalar


Last: TypeAlias = TurnedByAngle | ReplacedUnknown


@dataclass(frozen=True, slots=True)
class ClosedSteps:
    """What is solved one after the other, and then what was replaced, in this order."""

    first: tuple[SolvableRow | TurnedByAngle, ...]
    last: tuple[Last, ...]
    sides: tuple[Side, ...]


def steps(graph: Graph, rows: Sequence[Scalar], unknown: Sequence[Scalar]) -> ClosedSteps | None:
    """The steps for as many rows as unknowns; None where they do not come to an end, or are too many."""
    if len(rows) != len(unknown) or len(rows) > MOST_ROWS_COMBINED:
        return None
    return _Reduction(graph, rows, unknown).steps()


class _Reduction:
    """Rows and unknowns that are left."""

    def __init__(self, graph: Graph, rows: Sequence[Scalar], unknown: Sequence[Scalar]) -> None:
        self._graph, self._rows, self._open = graph, list(rows), list(unknown)
        self._solved: list[SolvableRow | TurnedByAngle] = []
        self._last: list[Last] = []
        self._sides: list[Side] = []

    def steps(self) -> ClosedSteps | None:
        """Those that leave nothing."""
        while self._replace_by_numbers():
            pass
        self._combine()
        while self._open:
            if not (self._solve_one() or self._replace_by_numbers() or self._turn_two()):
                return None
        used = reached([one.value for one in self._solved if isinstance(one, SolvableRow)])
        sides = tuple(side for side in self._sides if side.sign in used)
        return ClosedSteps(tuple(self._solved), tuple(reversed(self._last)), sides)

    def _held(self, row: Scalar) -> list[Scalar]:
        """The unknowns in a row."""
        nodes = reached([row])
        return [x for x in self._open if x in nodes]

    def _combine(self) -> None:
        """Rows added to each other where fewer unknowns are left in them."""
        slopes = tuple(tuple(gradient(self._graph, row, self._open)) for row in self._rows)
        self._rows = SparserRows(slopes).of(self._rows)

    def _solve_one(self) -> bool:
        """A row with one unknown."""
        for row in self._rows:
            held = self._held(row)
            one = solvable_row(self._graph, row, held[0]) if len(held) == 1 else None
            if one is not None:
                self._solved.append(one)
                self._let_go([row], one.unknown)
                return True
        return False

    def _replace_by_numbers(self) -> bool:
        """A row of two unknowns or more whose slopes are numbers, by the unknown whose replacement leaves least."""
        for row in self._rows:
            held = self._held(row)
            slopes = gradient(self._graph, row, held)
            numbers = [slope.constant for slope in slopes]
            if len(held) < 2 or not all(numbers):
                continue
            others = [other for other in self._rows if other is not row]
            replacements = []
            for x, number in zip(held, numbers, strict=True):
                assert number is not None
                (rest,) = substitute(self._graph, [row], {x: self._graph.zero})
                one = ReplacedUnknown(x, rest * (-1 / number))
                replacements.append((one, substitute(self._graph, others, {x: one.value})))
            best, left = min(replacements, key=lambda pair: cost(pair[1]).weight if pair[1] else 0)
            self._last.append(best)
            self._let_go([row], best.unknown)
            self._rows = list(left)
            return True
        return False

    def _turn_two(self) -> bool:
        """An angle that turns two rows alike and stands in no others, and the row that is left of these."""
        for x in self._open:
            holding = [row for row in self._rows if x in self._held(row)]
            if len(holding) != 2:
                continue
            turned = _turned(self._graph, (holding[0], holding[1]), x)
            left = None if turned is None else self._left_of(turned)
            if turned is not None and left is not None:
                self._last.append(turned)
                self._let_go(holding, x)
                self._rows.append(left)
                return True
        return self._turn_at_once()

    def _turn_at_once(self) -> bool:
        """Two rows with two unknowns that stand in others, too: both are solved for before those are looked at."""
        for first, second in combinations(self._rows, 2):
            pair = [x for x in self._open if x in {*self._held(first), *self._held(second)}]
            for angle, other in permutations(pair) if len(pair) == 2 else ():
                turned = _turned(self._graph, (first, second), angle)
                left = None if turned is None else self._left_of(turned)
                one = None if left is None else solvable_row(self._graph, left, other)
                if turned is not None and one is not None:
                    self._solved += [one, turned]
                    self._let_go((first, second), angle)
                    self._open.remove(other)
                    return True
        return False

    def _left_of(self, turned: TurnedByAngle) -> Scalar | None:
        """The row without the angle; None where nothing is left to solve it for."""
        graph = self._graph
        # lengths are the same at every angle, and shortest at 0
        rests = [row - part for row, part in zip(turned.rows, turned.arm, strict=True)]
        x, y, *apart = substitute(graph, [*turned.arm, *rests], {turned.angle: graph.zero})
        size = dot(graph, apart, apart)
        along, across = (y, x) if not self._held(x) else (x, y)
        if self._held(across) or self._held(size):
            left = size - dot(graph, (x, y), (x, y))
            return left if self._held(left) else None
        if not self._held(along):
            return None
        # an arm that unknowns move along one line: its length there, with a sign
        square = size - across * across
        sign = graph.stand_in(f"side {len(self._sides)}")
        self._sides.append(Side(sign, along, square, size))
        return along - sign * graph.function("sqrt", (square,))

    def _let_go(self, rows: Iterable[Scalar], unknown: Scalar) -> None:
        gone = list(rows)
        self._rows = [row for row in self._rows if not any(row is one for one in gone)]
        self._open.remove(unknown)


def _turned(graph: Graph, rows: tuple[Scalar, Scalar], angle: Scalar) -> TurnedByAngle | None:
    """The rows where the angle turns both of them alike, to either side, identically."""
    along = {angle: graph.one}
    slopes = derivative_along(graph, rows, along)
    x, y = (-bend for bend in derivative_along(graph, slopes, along))
    if x.is_zero:
        return None
    turned = [(slopes[0] + y, slopes[1] - x), (slopes[0] - y, slopes[1] + x)]
    side = next((k for k, both in enumerate(turned) if all(one.is_zero for one in both)), None)
    return None if side is None else TurnedByAngle(rows, angle, (x, y), bool(side))
