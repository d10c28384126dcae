"""Entries that are 0 for parameters whose values are 0, though kernels would leave rounding there.

Where a spring or a potential is switched off by a stiffness of 0, what holds a massless link carries nothing: forces
cancel in its multiplier, exactly for the mathematics and up to rounding for a kernel, which is all there is of a 0.
What is linear in these parameters, and 0 without them, is its own derivative along them (Euler), and that is a sum of
multiples of them.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.configurations.mechanics import default_values
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.traverse import substitute


def vanishing_with_parameters(mechanics: System, derived: Quantity) -> Quantity:
    """The quantity with such entries as multiples of the parameters whose values are 0."""
    graph, outputs = mechanics.graph, derived.outputs
    values = default_values(mechanics.model.parameters).values()
    zeros = {node: graph.zero for value, node in zip(values, mechanics.parameters, strict=True) if not value}
    if not zeros:
        return derived
    without = without_hidden_zeros(substitute(graph, outputs, zeros))
    places = [k for k, (y, rest) in enumerate(zip(outputs, without, strict=True)) if rest.is_zero and not y.is_zero]
    multiples = derivative_along(graph, [outputs[place] for place in places], {node: node for node in zeros})
    made = list(outputs)
    before, after = (ExactValues(1)(one) for one in ([outputs[place] for place in places], multiples))
    for place, multiple, y, z in zip(places, multiples, before, after, strict=True):
        if y is not None and y == z:
            made[place] = multiple
    return replace(derived, outputs=tuple(made))
