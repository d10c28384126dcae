"""Jacobians node by node: what lies between inputs and outputs is taken out one after the other, the cheapest first.

Every edge of a graph has a derivative.  A node that is taken out leaves, for each of its operands and each of what is
made of it, the product of two: forward and reverse sweeps are the orders from one end to the other.  Taking the node
next that costs least (Markowitz; Griewank and Walther, Evaluating Derivatives, ch. 9 and 10) saves where several
outputs hang on few nodes in the middle, and fills graphs of long chains up.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

from symgen.symbolic.calculus import jacobian, partials
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.matrix import Matrix, flatten
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological


def shortest_jacobian(graph: Graph, outputs: Sequence[Scalar], symbols: Sequence[Scalar]) -> Matrix:
    """The derivatives of the outputs by the symbols, a row for each output, in the order that counts least."""
    swept = jacobian(graph, outputs, symbols)
    if len(outputs) == 1:  # its sweep is the order that counts least
        return swept
    most = cost(flatten(swept)).weight
    made = accumulated_jacobian(graph, outputs, symbols, most)
    if made is None or cost(flatten(made)).weight >= most:
        return swept
    same_values("accumulating a Jacobian", flatten(swept), flatten(made))
    return made


def accumulated_jacobian(
    graph: Graph, outputs: Sequence[Scalar], symbols: Sequence[Scalar], most: int
) -> Matrix | None:
    """The same with the cheapest node taken out next; None once that takes more than `most` operations."""
    edges = _Edges(graph, outputs, symbols)
    queue = [(edges.price(node), place, node) for node, place in edges.places.items()]
    heapq.heapify(queue)
    prices = {node: price for price, _, node in queue}
    spent = 0
    while queue:
        price, _, node = heapq.heappop(queue)
        if prices.get(node) != price:
            continue
        del prices[node]
        spent += price
        if spent > most:
            return None
        for other in edges.take_out(node):
            again = edges.price(other)
            if again != prices[other]:
                prices[other] = again
                heapq.heappush(queue, (again, edges.places[other], other))
    return edges.left()


class _Edges:
    """Derivatives of nodes by their operands; the nodes between symbols and outputs have `places` in their order."""

    def __init__(self, graph: Graph, outputs: Sequence[Scalar], symbols: Sequence[Scalar]) -> None:
        self._graph, self._symbols = graph, symbols
        # by what a node is made of, and what is made of a node; outputs by their numbers, which are taken out last
        self._below: dict[Scalar | int, dict[Scalar, Scalar]] = {}
        self._above: dict[Scalar, dict[Scalar | int, None]] = {symbol: {} for symbol in symbols}
        self.places: dict[Scalar, int] = {}
        for node in topological(outputs):
            if node in self._above or all(argument not in self._above for argument in node.args):
                continue
            self.places[node] = len(self.places)
            self._above[node] = {}
            self._below[node] = {}
            for slope, argument in zip(partials(graph, node), node.args, strict=True):
                if argument in self._above and not slope.is_zero:
                    self._add(node, argument, slope)
        for k, output in enumerate(outputs):
            self._below[k] = {}
            if output in self._above:
                self._add(k, output, graph.one)

    def price(self, node: Scalar) -> int:
        """Products and sums that taking a node out costs."""
        below = self._below[node]
        products = sum(not _is_sign(slope) for slope in below.values())
        price = 0
        for user in self._above[node]:
            others = self._below[user]
            price += sum(argument in others for argument in below)
            price += 0 if _is_sign(others[node]) else products
        return price

    def take_out(self, node: Scalar) -> list[Scalar]:
        """Leads edges past a node; what may have another price then."""
        below, above = self._below.pop(node), self._above.pop(node)
        for user in above:
            slope = self._below[user].pop(node)
            for argument, inner in below.items():
                self._add(user, argument, slope * inner)
        for argument in below:
            del self._above[argument][node]
        around: list[Scalar] = [user for user in above if not isinstance(user, int)]
        return [*around, *(argument for argument in below if argument in self._below)]

    def left(self) -> Matrix:
        """The Jacobian, once nothing is in between."""
        zero, outputs = self._graph.zero, [k for k in self._below if isinstance(k, int)]
        return tuple(tuple(self._below[k].get(symbol, zero) for symbol in self._symbols) for k in outputs)

    def _add(self, node: Scalar | int, argument: Scalar, slope: Scalar) -> None:
        slopes = self._below[node]
        slopes[argument] = slopes[argument] + slope if argument in slopes else slope
        self._above[argument][node] = None


def _is_sign(slope: Scalar) -> bool:
    return slope.constant in (1, -1)
