"""Quantities from one graph to another, carried over as they stand.

Beside the nodes they were derived from, equal functions would take their place.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.system import System
from symgen.methods.method import Candidate
from symgen.methods.quantity import Quantity, is_fixed
from symgen.symbolic.graph import START, Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import transplanted


def derived_on(graph: Graph, candidate: Candidate) -> Quantity:
    """The quantity on the graph of the other quantities."""
    derived = candidate.derived
    if is_fixed(derived.outputs):
        derived = replace(derived, guards=())  # a status is decided on what the result depends on: here on nothing
    return moved(graph, derived)


def moved(graph: Graph, derived: Quantity) -> Quantity:
    """A quantity on another graph."""
    there = GraphCopy(graph)
    return replace(derived, outputs=there.scalars(derived.outputs), guards=there.guards(derived.guards))


class GraphCopy:
    """Guards and scalars on another graph, where `symbols` by name have other values; equal guards stay equal."""

    def __init__(self, graph: Graph, symbols: Mapping[str, Scalar] = MappingProxyType({})) -> None:
        self._graph = graph
        self._symbols = symbols
        self._image: dict[Scalar, Scalar] = {}

    def scalars(self, given: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """The scalars on the other graph."""
        return tuple(transplanted(self._graph, given, self._symbols, self._image))

    def guards(self, given: tuple[Guard, ...]) -> tuple[Guard, ...]:
        """The guards with all their scalars on the other graph."""
        return tuple(map(self._guard, given))

    def _guard(self, guard: Guard) -> Guard:
        (denominator,) = self.scalars((guard.denominator,))
        scale = None if guard.scale is None else self.scalars((guard.scale,))[0]
        return replace(guard, denominator=denominator, scale=scale, first=self.guards(guard.first))


def forget_others(mechanics: System, quantities: Iterable[Quantity]) -> None:
    """Lets the graph of quantities go of all that they do not hold: no others are derived there."""
    held = [*mechanics.q, *mechanics.qd, *mechanics.qdd, *mechanics.parameters, *mechanics.u]
    guards: list[Guard] = []
    for derived in quantities:
        held += derived.outputs
        guards += derived.guards
    while guards:
        guard = guards.pop()
        held += [guard.denominator] if guard.scale is None else [guard.denominator, guard.scale]
        guards += guard.first
    mechanics.factoring.forget(START, held)
