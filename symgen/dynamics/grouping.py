"""Parameter groups: numbers are multiplied into factors that depend on parameters only.

The constructors move numbers outwards so that terms are recognised; 1/2 (h s) and 1/2 (h c) are then two products more
than (h/2) s and (h/2) c.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.dynamics.factoring import Factoring
from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import cost, topological


def grouped(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with numbers moved into parameter groups, or as they are where that saves nothing."""
    image: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        args = tuple(image[argument] for argument in node.args)
        number = args[0].constant if node.op == "mul" else None
        if number is not None and not factoring.fixed(node):
            moved = _into_parameters(graph, factoring, args[0], args[1])
            image[node] = graph.raw("mul", args) if moved is None else moved
        else:
            image[node] = node if args == node.args else graph.raw(node.op, args, node.payload)
    moved_outputs = [image[output] for output in outputs]
    return moved_outputs if cost(moved_outputs).weight < cost(outputs).weight else list(outputs)


def _into_parameters(graph: Graph, factoring: Factoring, number: Scalar, product: Scalar) -> Scalar | None:
    """number * product with the number multiplied into the product's first parameter group, or None without one."""
    if factoring.fixed(product):
        return graph.raw("mul", (number, product))
    if product.op == "neg":
        moved = _into_parameters(graph, factoring, number, product.args[0])
        return None if moved is None else graph.raw("neg", (moved,))
    if product.op == "mul":
        for place in (0, 1):
            moved = _into_parameters(graph, factoring, number, product.args[place])
            if moved is not None:
                rest = product.args[1 - place]
                return graph.raw("mul", (moved, rest) if place == 0 else (rest, moved))
    if product.op == "div":
        moved = _into_parameters(graph, factoring, number, product.args[0])
        return None if moved is None else graph.raw("div", (moved, product.args[1]))
    return None
