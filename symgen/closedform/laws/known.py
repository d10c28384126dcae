"""The names that closed forms have given to minors and loads already, so that nothing is spelled twice."""

from __future__ import annotations

from functools import cached_property

from sympy import Expr, Symbol
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.quotient import Quotient
from symgen.closedform.forms import ClosedForms, dynamic_names
from symgen.closedform.spelling import Speller
from symgen.closedform.structured import Naming


class KnownNames:
    """What the names of the closed forms stand for; others are spelled."""

    def __init__(self, forms: ClosedForms) -> None:
        self.exact = forms.exact
        self.taken = frozenset(forms.exact.ring.variables)
        self._meanings = dict(pair for form in forms.forms.values() for pair in form.intermediates)

    @cached_property
    def speller(self) -> Speller:
        """What prints elements of the ring."""
        return Speller(self.exact.ring, dynamic_names(self.exact.model))

    def naming(self) -> Naming:
        """Names as the closed forms have them."""
        return Naming(self.speller, self.taken)

    def polynomial(self, symbol: Symbol, value: PolyElement) -> Expr:
        """What a name stands for, a ring element."""
        known = self._meanings.get(symbol)
        return self.speller.polynomial(value) if known is None else known

    def quotient(self, symbol: Symbol, value: Quotient) -> Expr:
        """What a name stands for, a fraction."""
        known = self._meanings.get(symbol)
        return self.speller.quotient(value) if known is None else known
