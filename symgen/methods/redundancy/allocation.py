"""Redundant inputs that share the work as the model's `allocation` says: weights, preload, limits.

Of all inputs that produce a motion, those with the least weighted norm u^T W u are found by Cramer's rule over the
input subsets, each multiplied by the weights of the inputs left out (columns scaled by 1/sqrt(w), theory 3.5, without
a root), or by reflections of the scaled columns where the subsets are too many.  For m = delta + 1 the internal force
has one direction, the minors Delta_k = (-1)^(k-1) det[M without column k, B^T]; sum_k w_k Delta_k^2 is the denominator
of u already, so Delta over its root has the weighted norm 1, as the last direction of the reflections has.  Along more
directions limits are kept as `limits` says, in an orthonormal basis that the reflections leave: which basis it is makes
no difference.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import InputEquations, NullSpace
from symgen.linear_algebra.reflected_inputs import reflected_inputs
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.least_inputs import least_inputs
from symgen.methods.method import divisors
from symgen.methods.redundancy.limits import NO_PART, TAKES_PART, Slab, interval, larger, nearest_of, nearest_within
from symgen.methods.redundancy.utilisation import scaled
from symgen.model.model import Allocation
from symgen.symbolic.matrix import Vector, dot, flatten, matvec, subtract_vectors
from symgen.symbolic.scalar import Scalar


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
        if mechanics.model.keeps_limits:
            turned = reflected_rows(mechanics, generic)
            self._reflected, self._restriction = reflected_inputs(turned, mechanics.inputs, generic.alpha, weights)
            self.forms: InputEquations = self._reflected
        else:
            equations, self._restriction = space.actuation(mechanics.inputs, generic.alpha)
            self.forms = equations.weighted(weights)

    def solve(self, force: Vector) -> Vector:
        """u (m): the inputs for a generalized force (n), or for the share of it that limits allow."""
        if self._allocation.scale:
            force = scaled(self._mechanics, self._generic, self._allocation.limits, force)
        return self._for(force)

    def _for(self, force: Vector) -> Vector:
        if self._mechanics.model.keeps_limits:
            return self._within_limits(force)
        least = self._nearest(force)
        if not self._allocation.directed or self._generic.m == self._generic.alpha:
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
        """What multiplies the direction: the preload's share, brought into the interval that the limits leave."""
        graph, allocation = self._graph, self._allocation
        share = graph.zero
        if allocation.preload is not None:
            share = graph.symbol(allocation.preload) / graph.function("sqrt", (square,))
        slabs = self._slabs(least, [(z,) for z in direction], [graph.const(NO_PART)] * len(least))
        return nearest_of(graph, (interval(graph, slab) for slab in slabs if not slab.slopes[0].is_zero), share)

    def _slabs(self, inputs: Vector, slopes: Sequence[Vector], least: Sequence[Scalar]) -> list[Slab]:
        """The limits of inputs that change with shares of internal forces by these slopes, or not at all."""
        symbol, limits = self._graph.symbol, self._allocation.limits
        places = [(limit, self._place[limit.input]) for limit in limits]
        return [Slab(symbol(one.lower), symbol(one.upper), inputs[k], slopes[k], least[k]) for one, k in places]

    def _within_limits(self, force: Vector) -> Vector:
        """Of all inputs for a force those nearest to the preferred ones that keep the limits, if any do."""
        graph, least = self._graph, self._nearest(force)
        forces = self._reflected.internal_forces()
        slopes = [share * TAKES_PART for share in self._reflected.shares]
        shares = nearest_within(graph, self._slabs(least, forces, slopes), len(forces[0]))
        return tuple(u + dot(graph, row, shares) for u, row in zip(least, forces, strict=True))

    def harmless_divisors(self, force: Vector) -> tuple[Scalar, ...]:
        """What is divided by where one set of limits is taken of several: 0 for one that inputs cannot reach alone."""
        if self._mechanics.model.keeps_limits:
            judged = {*divisors(self._nearest(force)), *divisors(flatten(self._reflected.internal_forces()))}
        else:
            judged = {*divisors(self._for(force))}
        return tuple(one for one in divisors(self.solve(force)) if one not in judged)

    def guards(self, inputs: Vector) -> tuple[Guard, ...]:
        """That inputs for which limits are kept exactly do keep them: else none produce the motion within these.

        Rounding leaves as much of a limit as of the largest input, which may be far beyond it where that one has none.
        """
        if not self._mechanics.model.keeps_limits or self._allocation.scale:
            return ()
        graph, excess = self._graph, self._graph.zero
        sizes = [graph.function("abs", (x,)) for x in inputs]
        for slab in self._slabs(inputs, [()] * len(inputs), [graph.zero] * len(inputs)):
            beyond = larger(graph, slab.start - slab.upper, slab.lower - slab.start)
            excess = larger(graph, excess, beyond)
            sizes += [graph.function("abs", (x,)) for x in (slab.lower, slab.upper)]
        return (Guard(Status.LIMITS, excess, 1, scale=graph.sum(sizes), positive=True, small=True),)
