"""Entries that are 0 without some symbols, though kernels would leave rounding there.

They are 0 exactly for the mathematics and up to rounding for a kernel, which is all there is of a 0.  As a sum of
multiples of these symbols an entry is 0 where they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from symgen.symbolic.exact import ExactValues
from symgen.symbolic.graph import Graph
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute


def as_multiples(
    graph: Graph,
    outputs: Sequence[Scalar],
    symbols: Sequence[Scalar],
    multiples: Callable[[Sequence[Scalar]], Sequence[Scalar]],
) -> tuple[Scalar, ...]:
    """The outputs, those that are 0 without the symbols as `multiples` of them where that is the same function."""
    without = without_hidden_zeros(substitute(graph, outputs, dict.fromkeys(symbols, graph.zero)))
    places = [k for k, (y, rest) in enumerate(zip(outputs, without, strict=True)) if rest.is_zero and not y.is_zero]
    vanishing = [outputs[place] for place in places]
    others = multiples(vanishing)
    made = list(outputs)
    before, after = (ExactValues(1)(one) for one in (vanishing, others))
    for place, other, y, z in zip(places, others, before, after, strict=True):
        if y is not None and y == z:
            made[place] = other
    return tuple(made)
