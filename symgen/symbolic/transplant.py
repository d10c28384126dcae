"""Scalars brought to another graph, operation by operation.

The constructors' rules have been applied where the scalars were made; applying them again beside other nodes would
replace what one method makes by an equal function that was derived before.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import rebuild, topological


def transplanted(
    graph: Graph,
    outputs: Iterable[Scalar],
    symbols: Mapping[str, Scalar] = MappingProxyType({}),
    image: dict[Scalar, Scalar] | None = None,
) -> list[Scalar]:
    """The same scalars as nodes of `graph`; symbols keep their names, or take the place that `symbols` gives them.

    `image` holds what was brought there before, and what is now.
    """
    outputs = list(outputs)
    image = {} if image is None else image
    for node in topological(outputs, image):
        args = tuple(map(image.__getitem__, node.args))
        if node.op == "symbol" and (name := str(node.payload)) in symbols:
            image[node] = symbols[name]
        elif (leaf := _leaf(graph, node)) is not None:
            image[node] = leaf
        elif node.op in ("sin", "cos"):
            # keyed by the angle, as the addition theorem expects them
            image[node] = graph.trig(node.op, args[0])
        else:
            image[node] = graph.raw(node.op, args, node.payload)
    return [image[output] for output in outputs]


def rebuilt(graph: Graph, outputs: Iterable[Scalar], replaced: Mapping[Scalar, Scalar]) -> list[Scalar]:
    """The same scalars on a graph through the rules of its constructors, with nodes replaced by some of that graph."""
    outputs = list(outputs)
    image = dict(replaced)
    for node in topological(outputs, image):
        leaf = _leaf(graph, node)
        image[node] = rebuild(graph, node, tuple(map(image.__getitem__, node.args))) if leaf is None else leaf
    return [image[output] for output in outputs]


def _leaf(graph: Graph, node: Scalar) -> Scalar | None:
    """A symbol or number on another graph; None for what is made of others."""
    if node.op == "symbol":
        name = str(node.payload)
        return graph.stand_in(name) if node.stands else graph.symbol(name)
    return None if node.constant is None else graph.const(node.constant)
