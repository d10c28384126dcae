"""A reciprocal that serves one product becomes its quotient: (1 / b) a is a / b."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.rebuilt import rebuilt
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological, uses_of


def with_quotients(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with a / b for (1 / b) a where nothing else needs 1 / b."""
    order = topological(outputs)
    inverses = {node for node in order if node.op == "div" and node.args[0].is_one}
    if not inverses:
        return list(outputs)
    uses = uses_of(order, outputs)
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        image[node] = rebuilt(graph, node, args)
        if node.op == "mul":
            for a, inverse in (node.args, node.args[::-1]):
                if inverse in inverses and uses[inverse] == 1:
                    image[node] = graph.raw("div", (image[a], image[inverse.args[1]]))
    return [image[output] for output in outputs]
