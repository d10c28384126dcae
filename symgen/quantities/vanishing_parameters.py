"""Entries that are 0 for parameters whose values are 0, though kernels would leave rounding there.

Where a spring or a potential is switched off by a stiffness of 0, what holds a massless link carries nothing: forces
cancel in its multiplier.  What is linear in these parameters, and 0 without them, is its own derivative along them
(Euler), and that is a sum of multiples of them.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.configurations.mechanics import default_values
from symgen.quantities.vanishing_entries import as_multiples
from symgen.symbolic.calculus import derivative_along


def vanishing_with_parameters(mechanics: System, derived: Quantity) -> Quantity:
    """The quantity with such entries as multiples of the parameters whose values are 0."""
    graph, values = mechanics.graph, default_values(mechanics.model.parameters).values()
    zeros = [node for value, node in zip(values, mechanics.parameters, strict=True) if not value]
    if not zeros:
        return derived
    along = {node: node for node in zeros}
    outputs = as_multiples(graph, derived.outputs, zeros, lambda one: derivative_along(graph, one, along))
    return replace(derived, outputs=outputs)
