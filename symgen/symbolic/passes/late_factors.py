"""Parameter factors of several values, multiplied in where the values meet another parameter: forces over one length
that act on another become forces over both lengths' ratio.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import cost, topological

# Factors tried, those of most values first: each takes going through all operations again.
MOST_FACTORS = 8
# Of graphs with more operations fewer are tried, none of still longer ones.
LONG, FEW_FACTORS = 600, 3
MOST_OPERATIONS = 3000

Step: TypeAlias = Callable[[Graph, Sequence[Scalar]], list[Scalar]]


def _as_it_is(_: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    return list(outputs)


def with_late_factors(
    graph: Graph, factoring: Factoring, outputs: Sequence[Scalar], finish: Step = _as_it_is
) -> list[Scalar]:
    """The outputs with factors multiplied in late, where that saves operations, counted after `finish`.

    A factor that comes last in several products meets there what else they have in common.
    """
    best = list(outputs)
    order = topological(best)
    if len(order) > MOST_OPERATIONS:
        return best
    found = factoring.factors(order)
    several = sorted((factor for factor in found if found[factor] > 1), key=lambda factor: -found[factor])
    finished = finish(graph, best)
    weight = cost(finished).weight if several else 0
    for factor in several[: MOST_FACTORS if len(order) <= LONG else FEW_FACTORS]:
        changed = _later(graph, factoring, best, factor)
        ended = finish(graph, changed)
        if (lighter := cost(ended).weight) < weight:
            best, finished, weight = changed, ended, lighter
    return finished


def _later(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar], factor: Scalar) -> list[Scalar]:
    """The outputs with `factor` taken out of its products and of all that is proportional to them."""
    fixed: Callable[[Scalar], bool] = factoring.fixed
    image: dict[Scalar, Scalar] = {}
    without: dict[Scalar, Scalar] = {}

    def whole(node: Scalar) -> Scalar:
        if node not in image:
            image[node] = graph.raw("mul", (image[factor], without[node]))
        return image[node]

    for node in topological(outputs):
        scaled = [argument for argument in node.args if argument in without]
        if node.op == "mul" and factor in node.args and not fixed(node) and not scaled:
            without[node] = image[node.args[node.args[0] is factor]]
        elif node.op == "mul" and len(scaled) == 1 and node.args[0] is not node.args[1]:
            other = node.args[node.args[0] is scaled[0]]
            if fixed(other):
                image[node] = graph.raw("mul", (graph.raw("mul", (image[factor], image[other])), without[scaled[0]]))
            else:
                without[node] = graph.raw("mul", (whole(other), without[scaled[0]]))
        elif node.op in ("add", "sub", "neg") and len(scaled) == len(node.args):
            without[node] = graph.raw(node.op, tuple(without[argument] for argument in node.args))
        elif node.op == "div" and scaled == [node.args[0]]:
            without[node] = graph.raw("div", (without[scaled[0]], whole(node.args[1])))
        else:
            args = tuple(whole(argument) for argument in node.args)
            image[node] = node if args == node.args else graph.raw(node.op, args, node.payload)
    return [whole(output) for output in outputs]
