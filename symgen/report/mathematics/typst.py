"""Layout as Typst mathematics, in function calls and symbol names: nothing depends on juxtaposition."""

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

DELIMITERS = {"(": "paren.l", ")": "paren.r", "[": "bracket.l", "]": "bracket.r", "|": "bar.v", "": ""}
CLOSING = {"(": "paren.r", "[": "bracket.r", "|": "bar.v", "": ""}
MARKS = {"dot": "dot", "ddot": "dot.double", "bar": "macron", "tilde": "tilde"}
SEPARATORS = {"": " ", "thin": " thin ", "point": " dot.op "}
SIGNS = {"+": "plus", "-": "minus", "·": "dot.op"}


def quoted(text: str) -> str:
    """A Typst string literal: any text whatsoever, shown as it is."""
    escaped = (
        text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t")
    )
    return f'"{escaped}"'


def typst_math(node: Layout) -> str:
    """The node inside Typst's dollar signs."""
    match node:
        case Numeral(text=text):
            return text
        case Letter(text=text, style="italic"):
            return text if len(text) == 1 and text.isalpha() else f"upright({quoted(text)})"
        case Letter(text=text, style=style):
            upright = f"upright({text if len(text) == 1 and text.isalpha() else quoted(text)})"
            return f"bold({upright})" if style == "bold" else upright
        case Relation(text=text):
            return f" {text} "
        case Sign(text=text, prefix=prefix):
            return f'class("unary", {SIGNS[text]})' if prefix else f'class("binary", {SIGNS[text]})'
        case Punctuation(text=","):
            return "comma"
        case Punctuation(text=text):
            return f"{quoted(text)} med"
        case Gap():
            return "wide"
        case Delimiter(text=text, upper=upper):
            return DELIMITERS[text] if upper is None else f"attach({DELIMITERS[text]}, t: {typst_math(upper)})"
        case Scripts(base=base, lower=lower, upper=upper):
            below = "" if lower is None else f", b: {typst_math(lower)}"
            above = "" if upper is None else f", t: {typst_math(upper)}"
            return f"attach({typst_math(base)}{below}{above})"
        case Accent(base=base, mark=mark):
            return f"accent({typst_math(base)}, {MARKS[mark]})"
        case Fraction(numerator=numerator, denominator=denominator):
            return f"frac({typst_math(numerator)}, {typst_math(denominator)})"
        case Root(radicand=radicand):
            return f"sqrt({typst_math(radicand)})"
        case Fenced(body=body, fence=fence):
            return f"lr({DELIMITERS[fence]} {typst_math(body)} {CLOSING[fence]})"
        case Application(function=function, argument=argument):
            if isinstance(argument, Fenced):
                return f"{typst_math(function)}{typst_math(argument)}"
            return f"{typst_math(function)} thin {typst_math(argument)}"
        case Product(factors=factors):
            parts = [typst_math(factors[0])]
            for left, right in pairwise(factors):
                parts += (SEPARATORS[separator(left, right)], typst_math(right))
            return "".join(parts)
        case Sum(terms=terms):
            return " ".join(_term(*term, first=k == 0) for k, term in enumerate(terms))
        case Row(pieces=pieces):
            return " ".join(typst_math(piece) for piece in pieces)
        case Array(rows=rows, fence=fence):
            lines = "; ".join(", ".join(typst_math(entry) for entry in row) for row in rows)
            return f"mat({lines})" if fence == "(" else f"mat(delim: {quoted(fence)}, {lines})"


def _term(sign: str, term: Layout, first: bool) -> str:
    """A term of a sum with its sign; a leading plus is left out."""
    body = typst_math(term)
    if first:
        return f'class("unary", minus) {body}' if sign == "-" else body
    return f"{SIGNS[sign]} {body}"
