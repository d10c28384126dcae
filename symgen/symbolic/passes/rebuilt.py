"""An operation over other operands: what a pass makes of what it leaves as it is."""

from __future__ import annotations

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar


def rebuilt(graph: Graph, node: Scalar, args: tuple[Scalar, ...]) -> Scalar:
    """The operation of a scalar over other arguments, their signs taken out; the scalar itself over its own."""
    if args == node.args:
        return node
    if node.op == "mul" and any(a.op == "neg" for a in args):
        # as twins: x (-y) and -(x y) are found to be opposite
        negative = sum(a.op == "neg" for a in args) == 1
        product = graph.raw("mul", tuple(a.args[0] if a.op == "neg" else a for a in args))
        return graph.raw("neg", (product,)) if negative else product
    if node.op in ("add", "sub") and args[1].op == "neg":
        return graph.raw("sub" if node.op == "add" else "add", (args[0], args[1].args[0]))
    if node.op == "add" and args[0].op == "neg":
        return graph.raw("sub", (args[1], args[0].args[0]))
    if node.op == "sub" and args[0].op == "neg":
        return graph.raw("neg", (graph.raw("add", (args[0].args[0], args[1])),))
    return graph.raw(node.op, args, node.payload)
