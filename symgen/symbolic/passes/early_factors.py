"""Parameter factors taken from where they are multiplied in late, if products with them exist: p (a sin x + b cos x)
as a (p sin x) + b (p cos x) where p sin x and p cos x are needed elsewhere.

What stands without them is shorter by a product, and the sines themselves need not wait for another use.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import topological

# Operations up to which graphs are gone through again for each parameter.
MOST_OPERATIONS = 2000


def with_early_factor(
    graph: Graph, factoring: Factoring, outputs: Sequence[Scalar], factor: Scalar
) -> list[Scalar]:
    """The outputs with `factor` left out of products whose other part can be had multiplied by it for nothing."""
    return _Early(graph, factoring, outputs, factor).outputs()


def early_factors(factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The parameters that stand in two products with states or more, in the order in which they are met."""
    order = topological(outputs)
    if len(order) > MOST_OPERATIONS:
        return []
    return [factor for factor, count in factoring.factors(order).items() if count > 1 and factor.op == "symbol"]


class _Early:
    """The outputs on the way to other ones: `_image` of nodes that change, `_without` and `_times` the factor."""

    def __init__(self, graph: Graph, factoring: Factoring, outputs: Sequence[Scalar], factor: Scalar) -> None:
        self._graph, self._factoring, self._outputs, self._factor = graph, factoring, outputs, factor
        self._image: dict[Scalar, Scalar] = {}
        # divided by the factor where that saves an operation, and multiplied by it where that costs none
        self._without: dict[Scalar, Scalar] = {factor: graph.one}
        self._times: dict[Scalar, Scalar] = {}
        # the nodes of these three; what uses none of them stays as it is
        self._touched = {factor}

    def outputs(self) -> list[Scalar]:
        """The outputs rebuilt."""
        order = topological(self._outputs)
        for node in order:
            if node.op == "mul" and self._factor in node.args and not self._factoring.fixed(node):
                other = node.args[node.args[0] is self._factor]
                # of angles and symbols: sums would only be multiplied out
                if not other.args or other.op in ("sin", "cos"):
                    self._times[other] = node
        self._touched.update(self._times)
        for node in order:
            if not self._touched.isdisjoint(node.args):
                image = self._rebuilt(node)
                if image is not node:
                    self._image[node] = image
                if image is not node or node in self._without or node in self._times:
                    self._touched.add(node)
        return [self._image_of(output) for output in self._outputs]

    def _rebuilt(self, node: Scalar) -> Scalar:
        graph = self._graph
        args = tuple([self._image_of(argument) for argument in node.args])
        if node.op == "mul" and (product := self._early(node)) is not None:
            return product
        if node.op == "div" and node.args[0] in self._without:
            self._without[node] = graph.raw("div", (self._without[node.args[0]], args[1]))
        elif node.op in ("add", "sub", "neg") and all(argument in self._times for argument in node.args):
            self._times[node] = graph.raw(node.op, tuple(self._multiplied(argument) for argument in node.args))
        return node if args == node.args else graph.raw(node.op, args, node.payload)

    def _early(self, node: Scalar) -> Scalar | None:
        """A product in which the factor meets what can be had multiplied by it; else it is carried on."""
        for one, other in (node.args, node.args[::-1]):
            if one in self._without and other in self._times and self._times[other] is not node:
                return self._product(self._without[one], self._multiplied(other))
        for one, other in (node.args, node.args[::-1]):
            if one in self._without:
                self._without[node] = self._product(self._without[one], self._image_of(other))
            elif one in self._times and other not in self._without:
                self._times[node] = self._graph.raw("mul", (self._multiplied(one), self._image_of(other)))
        return None

    def _multiplied(self, node: Scalar) -> Scalar:
        return self._image_of(self._times[node])

    def _image_of(self, node: Scalar) -> Scalar:
        return self._image.get(node, node)

    def _product(self, a: Scalar, b: Scalar) -> Scalar:
        return b if a.is_one else a if b.is_one else self._graph.raw("mul", (a, b))
