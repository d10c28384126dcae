"""One scalar for each operation: steps past the constructors, and scalars of other graphs, leave twins."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.rebuilt import rebuilt
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological


def without_twins(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with the first of equal operations in the place of the others."""
    order = topological(outputs)
    if len({(node.op, node.args, node.payload) for node in order}) == len(order):
        return list(outputs)
    image: dict[Scalar, Scalar] = {}
    first: dict[tuple[str, tuple[Scalar, ...], object], Scalar] = {}
    for node in order:
        same = rebuilt(graph, node, tuple(map(image.__getitem__, node.args)))
        image[node] = first.setdefault((same.op, same.args, same.payload), same)
    return [image[output] for output in outputs]
