"""Differences that exist the other way round, b - a beside a - b, taken from one another with a sign."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import reached, topological

_Signed: TypeAlias = tuple[bool, Scalar]  # whether the scalar is to be taken negative

_ODD = frozenset({"mul", "div"})
_EVEN = frozenset({"abs"})


def with_one_difference(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with b - a as -(a - b), whichever comes first; signs go on into the sums that take them."""
    image: dict[Scalar, _Signed] = {}
    first: dict[tuple[Scalar, Scalar], Scalar] = {}
    order = topological(outputs)
    # angles stay as they are: what else takes their sines and cosines has to find them
    angles = reached(node for node in order if node.op in ("sin", "cos"))
    for node in order:
        if node in angles:
            image[node] = False, node
            continue
        args = [image[argument] for argument in node.args]
        known = first.get((node.args[1], node.args[0])) if node.op == "sub" else None
        if known is not None:
            negative, same = image[known]
            image[node] = not negative, same
            continue
        if node.op == "sub":
            first[node.args[0], node.args[1]] = node
        if node.op != "neg" and not any(negative for negative, _ in args):
            parts = tuple([scalar for _, scalar in args])
            image[node] = False, node if parts == node.args else graph.raw(node.op, parts, node.payload)
        else:
            image[node] = _signed(graph, node, args)
    return [graph.raw("neg", (scalar,)) if negative else scalar for negative, scalar in (image[x] for x in outputs)]


def _signed(graph: Graph, node: Scalar, args: Sequence[_Signed]) -> _Signed:
    """The node over arguments of which some are to be taken negative."""
    parts = tuple(scalar for _, scalar in args)
    if node.op == "neg":
        return not args[0][0], parts[0]
    if node.op in _ODD:
        return args[0][0] != args[1][0], graph.raw(node.op, parts)
    if node.op in _EVEN:
        return False, graph.raw(node.op, parts)
    if node.op in ("add", "sub"):
        (left, a), (right, b) = args[0], (args[1][0] != (node.op == "sub"), args[1][1])
        if left and right:
            return True, graph.raw("add", (a, b))
        return False, graph.raw("sub", (b, a) if left else (a, b)) if left != right else graph.raw("add", (a, b))
    whole = tuple(graph.raw("neg", (scalar,)) if negative else scalar for negative, scalar in args)
    return False, graph.raw(node.op, whole, node.payload)
