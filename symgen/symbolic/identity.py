"""Whatever rewrites scalars is held to be an identity while it works: wrong algebra ends generation, it is not emitted.

Every scalar carries its value in a prime field (fingerprint), so that two scalars are compared by comparing two
numbers.  Only where these differ is more to be done: fingerprints know neither that a root's square is what it is the
root of, nor what turns by fixed angles do, and then exact evaluation decides.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from contextlib import contextmanager

from symgen.diagnostics import SymgenBug
from symgen.symbolic.exact import ExactValues, Value, holding_roots
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

# Points at which signs are right, half of them by chance.
POINTS_OF_SIGNS = 12
# Of scalars whose values stay known at each of these points: more are worked out again, as all of them fill the memory.
MOST_KNOWN = 20_000


class _Thoroughly:
    """Whether exact evaluation looks at every identity, that of equal fingerprints too."""

    on = False


@contextmanager
def every_identity_evaluated() -> Iterator[None]:
    """While this lasts nothing is taken on the word of fingerprints, whose angles are read by the graph's own rules."""
    before, _Thoroughly.on = _Thoroughly.on, True
    try:
        yield
    finally:
        _Thoroughly.on = before


def evaluates_all() -> bool:
    """Whether that is so now."""
    return _Thoroughly.on


def same_values(
    rule: str, before: Sequence[Scalar], after: Sequence[Scalar], squares_roots: bool = False
) -> None:
    """Raises SymgenBug, naming the rule, where a scalar is not the same function after it as before.

    A rule that squares roots is not judged at points where the field does not have them.  Equal at one point are
    sqrt(x^2) and x, by chance: there roots are left to fingerprints, to which each is a function of its own, or to more
    points.
    """
    if len(before) != len(after):
        raise SymgenBug(f"{rule}: {len(after)} scalars in place of {len(before)}")
    differ = [
        (one, other)
        for one, other in zip(before, after, strict=True)
        if (one.value != other.value or _Thoroughly.on) and one is not other
    ]
    rooted = holding_roots([scalar for pair in differ for scalar in pair])
    differ = [pair for pair in differ if not _equal(*pair, rooted)]
    if not differ:
        return
    values = _Values([scalar for pair in differ for scalar in pair])
    for seed in range(1, 1 + POINTS_OF_SIGNS):
        values.work_out(seed)
        changed = [(one, other) for one, other in differ if _changed(one, other, seed)]
        if squares_roots:
            changed = [(one, other) for one, other in changed if not _point(other, seed).any_root_in([other])]
        if wrong := len(changed):
            raise SymgenBug(f"{rule}: changes the value of {wrong} of {len(before)} scalars")
        values.forget_many(seed)


class _Values:
    """Scalars whose values are worked out at one point after another, in one order."""

    def __init__(self, scalars: Sequence[Scalar]) -> None:
        graphs = {id(scalar.graph): scalar.graph for scalar in scalars}
        self._by_graph = [(graph, [s for s in scalars if s.graph is graph]) for graph in graphs.values()]
        # what is known at one of these points is known at all of them
        self._orders = [_point_of(graph, 1).waiting(members) for graph, members in self._by_graph]

    def work_out(self, seed: int) -> None:
        """At the point of a seed, 1 or more."""
        for (graph, members), order in zip(self._by_graph, self._orders, strict=True):
            _point_of(graph, seed)(members, order)

    def forget_many(self, seed: int) -> None:
        """The values at the point of a seed, where they are many."""
        for graph, _ in self._by_graph:
            if graph.points[seed].known_count > MOST_KNOWN:
                del graph.points[seed]


def _equal(one: Scalar, other: Scalar, rooted: Container[Scalar]) -> bool:
    """Whether one point is enough to tell that two scalars are the same function; `rooted` ones hold roots."""
    if one.value != other.value and (one in rooted or other in rooted):
        return False
    value = _value(one, 0)
    return value is not None and value == _value(other, 0)


def _changed(one: Scalar, other: Scalar, seed: int) -> bool:
    """Whether two scalars are known to differ at a point; where the first is not defined the second may be anything."""
    before, after = _value(one, seed), _value(other, seed)
    return before is not None and before != after and other not in _point(other, seed).unknown


def _value(scalar: Scalar, seed: int) -> Value:
    return _point(scalar, seed)([scalar])[0]


def _point(scalar: Scalar, seed: int) -> ExactValues:
    return _point_of(scalar.graph, seed)


def _point_of(graph: Graph, seed: int) -> ExactValues:
    """The point of a seed; the values that are known there stay with the graph, as most scalars are met again."""
    points = graph.points
    if seed not in points:
        points[seed] = ExactValues(seed, signs=seed > 0, beside=next(iter(points.values()), None))
    return points[seed]
