"""Estimated widths on a page, in em of the text size; calibrated a little wide against New Computer Modern Math."""

from __future__ import annotations

from itertools import pairwise

from symgen.report.mathematics.layout import (
    Accent,
    Application,
    Array,
    Delimiter,
    Fenced,
    Fraction,
    Gap,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Root,
    Row,
    Scripts,
    Sign,
    Sum,
    separator,
)

# How small a subscript or superscript is set.
SCRIPT = 0.72
# The width of a sign between two terms, with its space.
OPERATOR = 1.22
# The width of a relation, with its space.
RELATION = 1.4
# The width of a parenthesis or a bracket.
FENCE = 0.42
# The space between two columns of a matrix.
COLUMN_GAP = 1.1
# The space between two formulas on one line.
GAP = 2.0
SEPARATION = {"": 0.03, "thin": 0.2, "point": 0.7}
WIDE = frozenset("mwMWΘΩΦΨ")


def page_width(node: Layout) -> float:
    """The width of a formula in em."""
    match node:
        case Letter(text=text):
            return sum(0.9 if character in WIDE else 0.58 for character in text)
        case Scripts(base=base, lower=lower, upper=upper):
            scripts = max(page_width(script) if script else 0.0 for script in (lower, upper))
            return page_width(base) + SCRIPT * scripts + 0.06
        case Numeral(text=text):
            return 0.51 * len(text)
        case Product(factors=factors):
            gaps = sum(SEPARATION[separator(a, b)] for a, b in pairwise(factors))
            return sum(page_width(factor) for factor in factors) + gaps
        case Application(function=function, argument=argument):
            return page_width(function) + page_width(argument) + (0.05 if isinstance(argument, Fenced) else 0.2)
        case Fenced(body=body):
            return page_width(body) + 2 * FENCE
        case Sum(terms=terms):
            signs = OPERATOR * (len(terms) - 1) + (0.8 if terms[0][0] == "-" else 0.0)
            return sum(page_width(term) for _, term in terms) + signs
        case Accent(base=base):
            return page_width(base)
        case Row(pieces=pieces):
            return sum(page_width(piece) for piece in pieces)
        case Fraction(numerator=numerator, denominator=denominator):
            return max(page_width(numerator), page_width(denominator)) + 0.25
        case Sign(prefix=prefix):
            return 0.8 if prefix else OPERATOR
        case Relation(text=text):
            return RELATION + 0.3 * (len(text) - 1)
        case Punctuation(text=text):
            return 0.45 * len(text) + 0.2
        case Gap():
            return GAP
        case Delimiter(upper=upper):
            return FENCE + (SCRIPT * page_width(upper) if upper else 0.0)
        case Root(radicand=radicand):
            return page_width(radicand) + 0.9
        case Array(rows=rows):
            columns = zip(*rows, strict=True)
            return sum(max(page_width(entry) for entry in column) + COLUMN_GAP for column in columns) + 2 * FENCE
