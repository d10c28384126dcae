"""Denominators a result depends on, and how small is too small.

A kernel decides on its own denominators: the status is not OK where |D| <= threshold * D_max, with D_max the sum of
the absolute terms of D when every sine and cosine is 1 (interface, section 4).
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import topological
from symgen.ir.kernel import Status
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Guard:
    """Return `status` where `denominator` is negligible.

    `degree` is 2 for a sum of squares (the threshold is squared), else 1.  `first` holds guards that are looked at
    only on failure, to name the cause.  `scale` takes the place of D_max where another factor of the denominator
    has a guard of its own.
    """

    status: Status
    denominator: Scalar
    degree: int
    first: tuple[Guard, ...] = ()
    scale: Scalar | None = None


def magnitude(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """Upper bounds of |output| for every angle: sums of absolute terms with sines and cosines set to 1."""
    bound: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        args = [bound[argument] for argument in node.args]
        match node.op:
            case "sin" | "cos":
                bound[node] = graph.one
            case "add" | "sub":
                bound[node] = args[0] + args[1]
            case "mul":
                bound[node] = args[0] * args[1]
            case "neg" | "abs" | "copysign":
                bound[node] = args[0]
            case "div":
                bound[node] = args[0] / graph.function("abs", (node.args[1],))
            case "sqrt":
                bound[node] = graph.function("sqrt", (args[0],))
            case _:
                bound[node] = graph.function("abs", (node,))
    return [bound[output] for output in outputs]
