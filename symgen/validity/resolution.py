"""Whether a method's denominators are distinguishable from the rounding of their own terms at ordinary states.

A kernel compares a denominator with the sum of its absolute terms (guards.py).  Where many turns in space follow each
other the terms cancel so far that the sum says nothing: single precision would refuse every state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from symgen.ir.kernel import UNIT_ROUNDOFF
from symgen.linear_algebra.guards import Guard, magnitude
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.transplant import transplanted

# Times the threshold that a denominator exceeds at ordinary states.
THRESHOLD_MARGIN = 10


def distinguishable(guards: Sequence[Guard], n: int, points: Sequence[Mapping[str, float]]) -> bool:
    """Whether each denominator passes its test in float32 at one of the configurations, by a factor of ten.

    What is to be small, such as what inputs lack to their limits, is none.
    """
    guards = [guard for guard in guards if not guard.small]
    if not guards or not points:
        return True
    # on a graph of their own, so that the sums of terms are no nodes that others meet
    graph = Graph()
    denominators = transplanted(graph, [guard.denominator for guard in guards])
    sizes = [
        magnitude(graph, [own])[0] if guard.scale is None else transplanted(graph, [guard.scale])[0]
        for guard, own in zip(guards, denominators, strict=True)
    ]
    evaluate = Evaluator([*denominators, *sizes])
    largest = [0.0] * len(guards)
    for point in points:
        values = evaluate(point)
        pairs = zip(values[: len(guards)], values[len(guards) :], strict=True)
        largest = [max(most, abs(d) / size if size else 1.0) for most, (d, size) in zip(largest, pairs, strict=True)]
    least = [float(THRESHOLD_MARGIN**guard.degree * guard.threshold(n, UNIT_ROUNDOFF["float32"])) for guard in guards]
    return all(most > low for most, low in zip(largest, least, strict=True))
