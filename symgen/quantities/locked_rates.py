"""Entries that are 0 where locked coordinates are at rest, though kernels would leave rounding there.

Rates that rows lock are 0 on V.  Where nothing else moves a system, what is left are centrifugal forces that do no work
along any motion, and they cancel.  What is 0 without these rates and of second degree in them is its own derivative
along them, halfway, and that is a sum of multiples of them, off V too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.quantities import MAIN
from symgen.quantities.vanishing_entries import as_multiples
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute


def vanishing_with_locked_rates(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """The quantity with such entries of u, q_ddot and lambda as multiples of the rates of locked coordinates."""
    graph, locked = mechanics.graph, [mechanics.qd[j] for j in generic.locked]
    if not locked or derived.name not in MAIN or mechanics.change is not None:
        return derived

    def multiples(vanishing: Sequence[Scalar]) -> Sequence[Scalar]:
        halfway = substitute(graph, vanishing, {rate: rate * Fraction(1, 2) for rate in locked})
        return derivative_along(graph, halfway, {rate: 2 * rate for rate in locked})

    return replace(derived, outputs=as_multiples(graph, derived.outputs, locked, multiples))
