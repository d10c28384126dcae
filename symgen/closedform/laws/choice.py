"""Which quantities of a model are printed as laws: those that written out would be long, each by its shortest law."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.forms import ClosedForm, ClosedForms
from symgen.closedform.laws.bases import short_basis
from symgen.closedform.laws.chain_rule import JACOBIAN, law_by_chain_rule
from symgen.closedform.laws.driven import INPUTS, laws_of_driven_coordinates
from symgen.closedform.laws.known import KnownNames
from symgen.closedform.laws.projections import (
    INVERSE,
    OF_CONSTRAINTS,
    PROJECTOR,
    laws_by_basis,
    laws_by_minors,
    laws_by_squares,
    named_minors,
)
from symgen.closedform.laws.terms import MatrixLaw
from symgen.model.model import Model
from symgen.model.quantities import MULTIPLIERS

Laws: TypeAlias = Mapping[str, tuple[MatrixLaw, ...]]
Group: TypeAlias = tuple[MatrixLaw, ...]

LONGEST_PSEUDOINVERSE = 200
"""A pseudoinverse of B with more operations says less than B^T (B B^T)^-1."""


def derive_laws(forms: ClosedForms) -> Laws:
    """One law or several for each quantity whose closed form is long; nothing where there are no constraints."""
    model = forms.exact.model
    long = _long(model, forms.forms)
    if not model.constraints or not long:
        return {}
    laws: dict[str, Group] = {}
    for group in _groups(forms):
        for quantity in sorted(long & {law.quantity for law in group}):
            laws.setdefault(quantity, tuple(law for law in group if law.quantity == quantity))
    return laws


def _groups(forms: ClosedForms) -> list[Group]:
    """Groups of laws, of which the first that has a quantity gives all its laws."""
    exact, known = forms.exact, KnownNames(forms)
    b_is_long = forms.forms[JACOBIAN].matrix is None
    by_chain = _admitted(forms, lambda: law_by_chain_rule(exact)) if b_is_long else ()
    by_squares = laws_by_squares(exact)
    by_minors = _admitted(forms, lambda: _by_minors(forms, known))
    if by_minors:
        return [by_chain, by_minors, by_squares]
    by_basis = _admitted(forms, lambda: _by_basis(forms, known))
    projector = tuple(law for law in by_basis if law.quantity == PROJECTOR)
    driven = _admitted(forms, lambda: laws_of_driven_coordinates(exact, known))
    return [by_chain, (*by_squares, *projector), driven, by_basis]


def _by_minors(forms: ClosedForms, known: KnownNames) -> Group:
    minors = named_minors(forms.exact, known)
    return () if minors is None else laws_by_minors(forms.exact, known, minors)


def _by_basis(forms: ClosedForms, known: KnownNames) -> Group:
    basis = short_basis(forms.exact, known.speller, forms.null_space)
    return () if basis is None else laws_by_basis(forms.exact, basis)


def _admitted(forms: ClosedForms, build: Callable[[], Group]) -> Group:
    """What is built, or nothing where that is too much work."""
    try:
        with forms.exact.ring.work.limited("laws"):
            return build()
    except TooLargeError:
        return ()


def _long(model: Model, forms: Mapping[str, ClosedForm]) -> frozenset[str]:
    """The quantities that have no closed form, or one in named parts or of many operations; lambda goes with u."""
    long = {q for q in (JACOBIAN, PROJECTOR, INVERSE, INPUTS) if q in forms and not _written_out(forms[q])}
    if model.allocation is not None or model.rough or (INPUTS in long and _is_short_product(forms)):
        long -= {INPUTS}
    inverse = forms.get(OF_CONSTRAINTS)
    if inverse is not None and not (_written_out(inverse) and _operations(inverse) <= LONGEST_PSEUDOINVERSE):
        long |= {OF_CONSTRAINTS}
    return frozenset(long | {MULTIPLIERS} if INPUTS in long else long)


def _is_short_product(forms: Mapping[str, ClosedForm]) -> bool:
    """Whether u is that of a pseudoinverse which is written out, with names for the loads alone."""
    return forms[INPUTS].matrix is not None and _written_out(forms[INVERSE])


def _written_out(form: ClosedForm) -> bool:
    return form.matrix is not None and not form.intermediates


def _operations(form: ClosedForm) -> int:
    return 0 if form.matrix is None else sum(int(entry.count_ops()) for entry in form.matrix)
