"""Redundant inputs that share the work as the model's `allocation` says: weights, preload, limits.

Of all inputs that produce a motion, those with the least weighted norm u^T W u are found by Cramer's rule over the
input subsets, each multiplied by the weights of the inputs left out (columns scaled by 1/sqrt(w), theory 3.5, without
a root), or by reflections of the scaled columns where the subsets are too many.  For m = delta + 1 the internal force
has one direction, the minors Delta_k = (-1)^(k-1) det[M without column k, B^T]; sum_k w_k Delta_k^2 is the denominator
of u already, so Delta over its root has the weighted norm 1, as the last direction of the reflections has.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.linear_algebra.exterior import ActuationForms
from symgen.linear_algebra.null_spaces import HouseholderSpace, NullSpace
from symgen.linear_algebra.reflected_inputs import ReflectedInputs
from symgen.mechanics.system import System
from symgen.model.model import Allocation
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.symbolic.scalar import Graph, Scalar

# Below this an input takes no part in the internal force; quotients by it are finite in float32, too.
NO_PART = Fraction(1, 10**30)


class InputAllocation:
    """The inputs of one allocation along one null space."""

    def __init__(self, mechanics: System, allocation: Allocation, space: NullSpace, degree: int) -> None:
        self._allocation = allocation
        self._mechanics = mechanics
        self._graph = graph = mechanics.graph
        self._space = space
        self._place = {item.name: k for k, item in enumerate(mechanics.model.inputs)}
        weights = [graph.one] * mechanics.m
        for name, parameter in allocation.weights:
            weights[self._place[name]] = graph.symbol(parameter)
        self.forms: ActuationForms | ReflectedInputs
        equations, self._restriction = space.actuation(mechanics.inputs, degree)
        if isinstance(equations, ReflectedInputs):
            self.forms = equations.weighted(weights)
        else:
            forms, self._restriction = space.listed_actuation(mechanics.inputs, degree)
            self.forms = ActuationForms(forms.rows, forms.inputs, forms.degree, weights)

    def solve(self, force: Vector) -> Vector:
        """u (m): the inputs for a generalized force (n)."""
        least = self._nearest(force)
        if not self._allocation.directed:
            return least
        direction = self.direction()
        share = self._share(least, direction)
        return tuple(u + share * z for u, z in zip(least, direction, strict=True))

    def _nearest(self, force: Vector) -> Vector:
        """The inputs for a force that are nearest to the preferred ones; of least norm where none is preferred."""
        graph = self._graph
        if not self._allocation.preferred:
            return self.forms.solve(self._restriction(force))
        preferred = [graph.zero] * self._mechanics.m
        for name, parameter in self._allocation.preferred:
            preferred[self._place[name]] = graph.symbol(parameter)
        rest = subtract_vectors(force, matvec(graph, self._mechanics.control_matrix, tuple(preferred)))
        solved = self.forms.solve(self._restriction(rest))
        return tuple(p + u for p, u in zip(preferred, solved, strict=True))

    def direction(self) -> Vector:
        """Internal force: (-1)^(k-1) det[M without column k, B^T], or a positive multiple of it."""
        forms, graph = self.forms, self._graph
        sign = orientation_of(self._space)
        if isinstance(forms, ReflectedInputs):
            return tuple(sign * share for share in forms.direction())
        whole = (1 << forms.rows.n) - 1
        (family,) = forms.products
        # the subset that comes last leaves out the first input
        minors = [sign * product.get(whole, graph.zero) for product in reversed(family)]
        return tuple(-minor if k & 1 else minor for k, minor in enumerate(minors))

    def _share(self, least: Vector, direction: Vector) -> Scalar:
        """What multiplies the direction: the preload's share, brought into the interval that the limits leave.

        The middle one of the preload and the interval's ends is the nearest point of the interval.  Where the limits
        contradict each other the ends have changed places, and between them no limit gains without another's loss.
        """
        graph, allocation = self._graph, self._allocation
        share = graph.zero
        if allocation.preload is not None:
            share = graph.symbol(allocation.preload)
            if isinstance(self.forms, ActuationForms):
                share = share / graph.function("sqrt", (self.forms.square(),))
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
        """The shares s with lower <= u + s z <= upper."""
        graph = self._graph
        size = _larger(graph, graph.function("abs", (z,)), graph.const(NO_PART))
        reciprocal = 1 / graph.function("copysign", (size, z))
        ends = [(graph.symbol(limit) - u) * reciprocal for limit in (lower, upper)]
        return _smaller(graph, *ends), _larger(graph, *ends)


def orientation_of(space: NullSpace) -> Scalar:
    """The sign between the minors in a space's own coordinates and det[M_J, B^T]."""
    graph = space.graph
    rows = len(space.rows)
    sign = graph.const(-1 if rows * space.delta & 1 else 1)
    if not isinstance(space, HouseholderSpace):
        return sign
    # det[M_J, B^T] = det Q det R det(F^T M_J) up to the sign above, and each reflection has determinant -1
    if len(space.reflections.reflectors) & 1:
        sign = -sign
    for k, column in enumerate(space.reflections.triangle):
        pivot = column[k]
        if pivot.constant is not None:
            sign = -sign if pivot.constant < 0 else sign
        else:
            sign = sign * graph.function("copysign", (graph.one, pivot))
    return sign


def _smaller(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    return graph.function("min", (a, b))


def _larger(graph: Graph, a: Scalar, b: Scalar) -> Scalar:
    return graph.function("max", (a, b))
