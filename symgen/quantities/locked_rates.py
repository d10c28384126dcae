"""Entries that are 0 where locked coordinates are at rest, though kernels would leave rounding there.

Rates that rows lock are 0 on V.  Where nothing else moves a system, what is left are centrifugal forces that do no work
along any motion: they cancel, exactly for the mathematics and up to rounding for a kernel, which is all there is of a
0.  What is 0 without these rates and of second degree in them is its own derivative along them, halfway, and that is a
sum of multiples of them, off V too.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.quantities import MAIN
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.traverse import substitute


def vanishing_with_locked_rates(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """The quantity with such entries of u, q_ddot and lambda as multiples of the rates of locked coordinates."""
    graph, outputs = mechanics.graph, derived.outputs
    locked = [mechanics.qd[j] for j in generic.locked]
    if not locked or derived.name not in MAIN or mechanics.change is not None:
        return derived
    without = without_hidden_zeros(substitute(graph, outputs, dict.fromkeys(locked, graph.zero)))
    places = [k for k, (y, rest) in enumerate(zip(outputs, without, strict=True)) if rest.is_zero and not y.is_zero]
    vanishing = [outputs[place] for place in places]
    halfway = substitute(graph, vanishing, {rate: rate * Fraction(1, 2) for rate in locked})
    multiples = derivative_along(graph, halfway, {rate: 2 * rate for rate in locked})
    made = list(outputs)
    before, after = (ExactValues(1)(one) for one in (vanishing, multiples))
    for place, multiple, y, z in zip(places, multiples, before, after, strict=True):
        if y is not None and y == z:
            made[place] = multiple
    return replace(derived, outputs=tuple(made))
