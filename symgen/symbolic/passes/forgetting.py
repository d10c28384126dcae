"""Scalars that a rewriting pass leaves behind are let go.

Passes that look for shorter ways make several times as many scalars as their results hold, and a graph keeps all of
them: they are what most of the memory of a derivation goes to.
"""

from __future__ import annotations

from collections.abc import Iterable, Set

from symgen.symbolic.graph import Graph, Mark
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import forget_orders

# Scalars that are forgotten together at least: fewer are met again, and looking for those that are needed takes time,
# too.
FEWEST_FORGOTTEN = 10_000


def forgetting(graph: Graph, mark: Mark, needed: Iterable[Scalar]) -> Set[Scalar] | None:
    """Lets the graph go of what was made since the mark (`Graph.mark`), but for what `needed` scalars hold.

    Tells which scalars went, to those who remember scalars themselves; None where too little was made to look.  What is
    forgotten is made again where it is met again, with another serial number.
    """
    first = mark.scalars
    if graph.mark().scalars - first < FEWEST_FORGOTTEN:
        return None
    live = set(needed)
    stack = list(live)
    while stack:
        for argument in stack.pop().args:
            if argument.serial >= first and argument not in live:
                live.add(argument)
                stack.append(argument)

    gone = graph.forget(mark, lambda node: node in live or node.constant is not None)
    forget_orders()
    return gone
