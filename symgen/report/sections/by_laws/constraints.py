"""B and its rate by the chain rule, where their entries are long."""

from __future__ import annotations

from symgen.closedform.laws.terms import ListedFactor
from symgen.report.context import Context
from symgen.report.document import Block, displayed
from symgen.report.mathematics.from_law import law_layout, matrix_layout
from symgen.report.mathematics.layout import Accent, Fenced, Fraction, Layout, Letter, Row, equation
from symgen.report.mathematics.matrices import matrix_blocks, packed
from symgen.report.prose import PARTIAL, B, B_dot, g, juxtaposed, listed, paragraph, plus, q, transposed

K, J = Letter("K", "bold"), Letter("J", "bold")


def jacobian_law(context: Context) -> list[Block]:
    """B as a product; nothing where it is written out or has no such law."""
    laws = context.laws("constraint_jacobian")
    if not laws:
        return []
    (law,) = laws
    places, outer = (factor for factor in law.factors if isinstance(factor, ListedFactor))
    s = matrix_layout(places.name)
    names = listed(tuple(context.layout.expression(name) for name in places.matrix))
    meanings = (equation(K, _derivative(g, s)), equation(J, _derivative(s, q)))
    return [
        displayed(tuple(packed((equation(B, law_layout(law.term)), *meanings))), "B"),
        paragraph("by the chain rule. {} has the derivatives of the names that the constraints are written in,", J),
        displayed((equation(transposed(s), Fenced(names)),)),
        *matrix_blocks(K, outer.matrix, context.layout, context.denominators, outer.name),
    ]


def rate_law(context: Context) -> list[Block]:
    """The rate of B where B is a product."""
    if not context.laws("constraint_jacobian"):
        return []
    rate = plus(juxtaposed(Accent(K, "dot"), J), juxtaposed(K, Accent(J, "dot")))
    return [displayed((equation(B_dot, rate),), "Bdot")]


def _derivative(of: Layout, by: Layout) -> Layout:
    return Fraction(Row((PARTIAL, of)), Row((PARTIAL, by)))
