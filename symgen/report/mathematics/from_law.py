"""Laws of matrices as layout."""

from __future__ import annotations

from symgen.closedform.laws.terms import (
    LawDifference,
    LawInverse,
    LawMatrix,
    LawOpposite,
    LawProduct,
    LawQuotient,
    LawTerm,
    LawTransposed,
    LawUnit,
)
from symgen.naming import GREEK
from symgen.report.mathematics.layout import Fenced, Fraction, Layout, Letter, Numeral, Product, Scripts, Sum, minus
from symgen.report.mathematics.names import name_layout

TRANSPOSED = Letter("T", "upright")
INVERTED = Sum((("-", Numeral("1")),))


def matrix_layout(name: str) -> Layout:
    """B, tau_a, Phi in bold, with their index."""
    head, _, index = name.partition("_")
    letter = Letter(GREEK.get(head, head), "bold")
    return Scripts(letter, Letter(index)) if index else letter


def law_layout(term: LawTerm) -> Layout:
    """The right side of a law."""
    match term:
        case LawMatrix(name=name):
            return matrix_layout(name)
        case LawUnit():
            return Letter("I", "bold")
        case LawTransposed(inside=inside):
            return _raised(inside, TRANSPOSED)
        case LawInverse(inside=inside):
            return _raised(inside, INVERTED)
        case LawProduct(factors=factors):
            return Product(tuple(_factor(factor) for factor in factors))
        case LawDifference(first=first, second=second):
            return Sum((("+", law_layout(first)), ("-", law_layout(second))))
        case LawOpposite(inside=inside):
            return minus(law_layout(inside))
        case LawQuotient(inside=inside, divisor=divisor):
            over_one = Fraction(Numeral("1"), name_layout(divisor.name))
            above = inside.factors if isinstance(inside, LawProduct) else (inside,)
            return Product((over_one, *(_factor(factor) for factor in above)))


def _factor(term: LawTerm) -> Layout:
    return Fenced(law_layout(term)) if isinstance(term, (LawDifference, LawOpposite)) else law_layout(term)


def _raised(inside: LawTerm, upper: Layout) -> Layout:
    """A power: at the letter itself, at parentheses round anything longer."""
    base = law_layout(inside)
    if isinstance(inside, LawMatrix):
        return Scripts(base.base, base.lower, upper) if isinstance(base, Scripts) else Scripts(base, None, upper)
    return Scripts(Fenced(base), None, upper)
