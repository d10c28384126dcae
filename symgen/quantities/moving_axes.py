"""What depends on a heading only in that everything turns with it, in axes that turn, too.

A robot on level ground does the same whichever way it heads: in axes of its own its equations hold neither its place
nor its heading.  So a result at a heading is that at heading 0 with rates and accelerations turned back by it, turned
itself where it is an acceleration.  Written so it has no terms that cancel by cos^2 + sin^2 = 1, which leave a rounding
of what is cancelled (the symmetry of Chaplygin systems: Bloch, Nonholonomic Mechanics and Control, 2003, ch. 5).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, islice, permutations

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.absolute_angles import absolute_angles
from symgen.mechanics.system import System
from symgen.methods.graphs import moved
from symgen.methods.method import counted_weight
from symgen.methods.quantity import Quantity, scalars
from symgen.model.quantities import ROWS
from symgen.records import dataclass
from symgen.symbolic.evaluate import Evaluator, inner_point
from symgen.symbolic.graph import Graph
from symgen.symbolic.hidden_zeros import ROUNDING_OF_ZEROS
from symgen.symbolic.identity import same_values
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import rebuilt, transplanted
from symgen.symbolic.traverse import ANGLE_WEIGHT, reached, substitute

# Scalars that are made in trying the headings of one quantity, each of which makes it anew.
MOST_TURNED = 50_000


@dataclass(frozen=True, slots=True)
class _Heading:
    """The place of an angle by which something heads, and of two coordinates that carry it along axes of the world.

    What holds neither these coordinates nor their rates has no `carried`.  Where several legs stand on the ground each
    has such an angle: `others` turn with the first.
    """

    angle: int
    carried: tuple[int, ...]
    others: tuple[int, ...] = ()


def in_moving_axes(mechanics: System, derived: Quantity) -> Quantity:
    """A quantity in axes that turn with a heading on which nothing else depends, where that takes fewer operations."""
    held = reached(scalars(derived))
    best, least = derived, counted_weight(derived)
    numbers = _TurnedNumbers(mechanics, derived.outputs)
    headings = _headings(mechanics, held)
    if ROWS[derived.name].is_derivative:
        # u and q_ddot are made of differences of these angles; what holds lambda is not
        headings = chain(headings, _common_headings(mechanics, held))
    for heading in islice(headings, MOST_TURNED // (1 + len(held))):
        # what evaluates as many sines as before is no shorter but by chance
        worth = ANGLE_WEIGHT if heading.others else 1
        # beside what it is made of, some parts find others to share, and some the longer functions they are to replace
        for graph in (mechanics.graph, Graph()) if numbers.may_turn(heading) else ():
            turned = _turned(mechanics, derived, heading, graph)
            if turned is None:
                break  # it is another one on any graph
            if (weight := counted_weight(turned)) <= least - worth:
                best, least = turned, weight
    return best


class _TurnedNumbers:
    """The outputs of a quantity at a point in double precision, which rule most headings out in a tenth of the time."""

    def __init__(self, mechanics: System, outputs: Vector) -> None:
        self._mechanics, self._count, self._evaluate = mechanics, len(outputs), Evaluator(outputs)
        self.size, self._point = len(reached(outputs)), inner_point(outputs)
        self._here = self._evaluate(self._point)

    def may_turn(self, heading: _Heading) -> bool:
        """Whether the outputs may do no more than turn with it; rounding leaves more apart of none that does."""
        mechanics = self._mechanics
        turning = mechanics.q[heading.angle]
        others = [mechanics.q[k] for k in heading.others]
        vectors = [[vector[k] for k in heading.carried] for vector in (mechanics.qd, mechanics.qdd)]
        if any(node.op != "symbol" for node in (turning, *others, *vectors[0], *vectors[1])):
            return True
        name = str(turning.payload)
        angle = self._point.get(name, 0.0)
        cosine, sine = math.cos(angle), math.sin(angle)
        turned = {str(node.payload): self._point.get(str(node.payload), 0.0) - angle for node in others}
        point = {**self._point, **turned, name: 0.0}
        for carried in vectors if heading.carried else ():
            along, across = (str(node.payload) for node in carried)
            x, y = (self._point.get(one, 0.0) for one in (along, across))
            point |= {along: cosine * x + sine * y, across: cosine * y - sine * x}
        there = list(self._evaluate(point))
        if self._same(there):
            return True
        if not heading.carried or self._count != self._mechanics.n:
            return False
        first, second = heading.carried
        x, y = there[first], there[second]
        there[first], there[second] = cosine * x - sine * y, sine * x + cosine * y
        return self._same(there)

    def _same(self, there: Sequence[float]) -> bool:
        size = max(map(abs, self._here), default=0.0)
        return not any(abs(a - b) > ROUNDING_OF_ZEROS * size for a, b in zip(self._here, there, strict=True))


def _headings(mechanics: System, held: Collection[Scalar]) -> Iterator[_Heading]:
    """Those that a quantity may turn with: it holds the angle, and rates of the two places but not these."""
    coordinates = mechanics.model.coordinates
    moved = [
        k
        for k, c in enumerate(coordinates)
        if not c.is_angle and mechanics.q[k] not in held and (mechanics.qd[k] in held or mechanics.qdd[k] in held)
    ]
    for angle in (k for k, c in enumerate(coordinates) if c.is_angle and mechanics.q[k] in held):
        yield _Heading(angle, ())
        headings = (_Heading(angle, carried) for carried in permutations(moved, 2))
        yield from (heading for heading in headings if _turns_rows(mechanics, heading))


def _common_headings(mechanics: System, held: Collection[Scalar]) -> Iterator[_Heading]:
    """By the angles of all legs, each of which may be the one that is taken to 0."""
    parents = absolute_angles(mechanics.q, mechanics.constraint_jacobian).parents
    legs = [
        k
        for k, (c, parent) in enumerate(zip(mechanics.model.coordinates, parents, strict=True))
        if c.is_angle and parent is None and mechanics.q[k] in held
    ]
    for angle in legs if len(legs) > 1 else ():
        yield _Heading(angle, (), tuple(k for k in legs if k != angle))


def _turns_rows(mechanics: System, heading: _Heading) -> bool:
    """Whether the rows of B only turn with it, which is soon told; most pairs have nothing to do with it."""
    graph, angle = mechanics.graph, mechanics.q[heading.angle]
    for row in mechanics.constraint_jacobian:
        turned = _forward(mechanics, heading, substitute(graph, row, {angle: graph.zero}))
        if not _same(row, turned):
            return False
    return True


def _forward(mechanics: System, heading: _Heading, entries: Sequence[Scalar]) -> list[Scalar]:
    """A vector with an entry for each coordinate, turned by the heading."""
    graph, angle = mechanics.graph, mechanics.q[heading.angle]
    cosine, sine = graph.trig("cos", angle), graph.trig("sin", angle)
    turned, (along, across) = list(entries), heading.carried
    x, y = entries[along], entries[across]
    turned[along], turned[across] = cosine * x - sine * y, sine * x + cosine * y
    return turned


def _turned(mechanics: System, derived: Quantity, heading: _Heading, graph: Graph) -> Quantity | None:
    """The quantity at heading 0 with what comes in turned back, made on a graph; None where that is another one."""
    angle, others = mechanics.q[heading.angle], [mechanics.q[k] for k in heading.others]
    own, *beside = transplanted(graph, [angle, *others])
    cosine, sine = graph.trig("cos", own), graph.trig("sin", own)
    back = {angle: graph.zero} | {other: one - own for other, one in zip(others, beside, strict=True)}
    for vector in (mechanics.qd, mechanics.qdd) if heading.carried else ():
        along, across = (vector[k] for k in heading.carried)
        x, y = transplanted(graph, [along, across])
        back |= {along: cosine * x + sine * y, across: cosine * y - sine * x}
    outputs = rebuilt(graph, derived.outputs, back)
    if not _same(derived.outputs, outputs):
        if not heading.carried or len(outputs) != mechanics.n:
            return None
        first, second = heading.carried
        x, y = outputs[first], outputs[second]
        outputs[first], outputs[second] = cosine * x - sine * y, sine * x + cosine * y
        if not _same(derived.outputs, outputs):
            return None
    guards = [_turned_guard(guard, graph, back) for guard in derived.guards]
    turned_guards = tuple(guard for guard in guards if guard is not None)
    if len(turned_guards) < len(guards):
        return None
    same_values("turning axes", derived.outputs, outputs)
    return moved(mechanics.graph, replace(derived, outputs=tuple(outputs), guards=turned_guards))


def _turned_guard(guard: Guard, graph: Graph, back: Mapping[Scalar, Scalar]) -> Guard | None:
    """A guard that does not change with the heading, on a graph; None where it does."""
    given = (guard.denominator,) if guard.scale is None else (guard.denominator, guard.scale)
    turned = rebuilt(graph, given, back)
    first = [_turned_guard(one, graph, back) for one in guard.first]
    kept = tuple(one for one in first if one is not None)
    if not _same(given, turned) or len(kept) < len(first):
        return None
    same_values("turning axes", given, turned)
    return replace(guard, denominator=turned[0], scale=None if guard.scale is None else turned[1], first=kept)


def _same(before: Sequence[Scalar], after: Sequence[Scalar]) -> bool:
    return all(one.value == other.value for one, other in zip(before, after, strict=True))
