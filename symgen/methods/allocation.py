"""Redundant inputs that share the work as the model's `allocation` says: weights, preload, limits.

Of all inputs that produce a motion, those with the least weighted norm u^T W u are found by Cramer's rule over the
input subsets, each multiplied by the weights of the inputs left out (columns scaled by 1/sqrt(w), theory 3.5, without
a root), or by reflections of the scaled columns where the subsets are too many.  For m = delta + 1 the internal force
has one direction, the minors Delta_k = (-1)^(k-1) det[M without column k, B^T]; sum_k w_k Delta_k^2 is the denominator
of u already, so Delta over its root has the weighted norm 1, as the last direction of the reflections has.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.linear_algebra.null_spaces import NullSpace
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.least_inputs import least_inputs
from symgen.model.model import Allocation
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.symbolic.scalar import Graph, Scalar

# Below this an input takes no part in the internal force; quotients by it are finite in float32, too.
NO_PART = Fraction(1, 10**30)
# A share of the internal force that no limits reach; float32 takes it apart into two halves, too.
NO_LIMIT = Fraction(10**30)


class InputAllocation:
    """The inputs of one allocation along one null space."""

    def __init__(self, mechanics: System, generic: Genericity, allocation: Allocation, space: NullSpace) -> None:
        self._allocation = allocation
        self._mechanics = mechanics
        self._generic = generic
        self._graph = graph = mechanics.graph
        self._place = {item.name: k for k, item in enumerate(mechanics.model.inputs)}
        weights = [graph.one] * mechanics.m
        for name, parameter in allocation.weights:
            weights[self._place[name]] = graph.symbol(parameter)
        equations, self._restriction = space.actuation(mechanics.inputs, generic.alpha)
        self.forms = equations.weighted(weights)

    def solve(self, force: Vector) -> Vector:
        """u (m): the inputs for a generalized force (n)."""
        least = self._nearest(force)
        if not self._allocation.directed:
            return least
        direction, square = self.internal_force()
        share = self._share(least, direction, square)
        return tuple(u + share * z for u, z in zip(least, direction, strict=True))

    def _nearest(self, force: Vector) -> Vector:
        """The inputs for a force that are nearest to the preferred ones; of least norm where none is preferred."""
        graph = self._graph
        if not self._allocation.preferred:
            return self._least(force)
        preferred = [graph.zero] * self._mechanics.m
        for name, parameter in self._allocation.preferred:
            preferred[self._place[name]] = graph.symbol(parameter)
        rest = subtract_vectors(force, matvec(graph, self._mechanics.control_matrix, tuple(preferred)))
        return tuple(p + u for p, u in zip(preferred, self._least(rest), strict=True))

    def _least(self, force: Vector) -> Vector:
        return least_inputs(self._mechanics, self._generic, self.forms, self._restriction, force)

    def internal_force(self) -> tuple[Vector, Scalar]:
        """(-1)^(k-1) det[M without column k, B^T], or a positive multiple of it, and its squared weighted norm."""
        direction, square = self.forms.internal_force()
        sign = self._restriction.orientation(self._graph)
        return tuple(sign * entry for entry in direction), square

    def _share(self, least: Vector, direction: Vector, square: Scalar) -> Scalar:
        """What multiplies the direction: the preload's share, brought into the interval that the limits leave.

        The middle one of the preload and the interval's ends is the nearest point of the interval.  Where the limits
        contradict each other the ends have changed places, and between them no limit gains without another's loss.
        """
        graph, allocation = self._graph, self._allocation
        share = graph.zero
        if allocation.preload is not None:
            share = graph.symbol(allocation.preload) / graph.function("sqrt", (square,))
        lowest: list[Scalar] = []
        highest: list[Scalar] = []
        for limit in allocation.limits:
            k = self._place[limit.input]
            if not direction[k].is_zero:
                low, high = self._interval(limit.lower, limit.upper, least[k], direction[k])
                lowest.append(low)
                highest.append(high)
        if not lowest:
            return share
        bottom, top = lowest[0], highest[0]
        for low, high in zip(lowest[1:], highest[1:], strict=True):
            bottom, top = _larger(graph, bottom, low), _smaller(graph, top, high)
        above, below = _larger(graph, bottom, top), _smaller(graph, bottom, top)
        return _larger(graph, below, _smaller(graph, above, share))

    def _interval(self, lower: str, upper: str, u: Scalar, z: Scalar) -> tuple[Scalar, Scalar]:
        """The shares s with lower <= u + s z <= upper: all of them for an input that takes no part."""
        graph = self._graph
        size = graph.function("abs", (z,))
        lacking = _larger(graph, graph.const(NO_PART) - size, graph.zero)
        apart = graph.function("ratio_or_zero", (lacking, lacking))
        reciprocal = (1 - apart) / graph.function("copysign", (_larger(graph, size, graph.const(NO_PART)), z))
        ends = [(graph.symbol(limit) - u) * reciprocal for limit in (lower, upper)]
        beyond = apart * NO_LIMIT
        return _smaller(graph, *ends) - beyond, _larger(graph, *ends) + beyond


def _smaller(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    return graph.function("min", (a, b))


def _larger(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    return graph.function("max", (a, b))
