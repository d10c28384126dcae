"""Layout as MathML Core: what browsers show without scripts or fonts from elsewhere."""

from __future__ import annotations

from html import escape
from itertools import pairwise

from symgen.report.mathematics.layout import (
    CLOSING,
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
    tall,
)

MARKS = {"dot": "\u02d9", "ddot": "\u00a8", "bar": "\u00af", "tilde": "~"}
SEPARATORS = {"": "<mo>\u2062</mo>", "thin": '<mspace width="0.17em"/>', "point": "<mo>·</mo>"}
SIGNS = {"+": "+", "-": "−", "·": "·"}


def mathml(node: Layout) -> str:
    """The node as presentation MathML, without the enclosing math element; one element."""
    match node:
        case Numeral(text=text):
            return f"<mn>{text}</mn>"
        case Letter(text=text, style="bold"):
            return f'<mi mathvariant="normal" class="bold">{escape(text)}</mi>'
        case Letter(text=text, style=style):
            upright = ' mathvariant="normal"' if style == "upright" and len(text) == 1 else ""
            return f"<mi{upright}>{escape(text)}</mi>"
        case Relation(text=text):
            return f"<mo>{escape(text)}</mo>"
        case Sign(text=text, prefix=prefix):
            return f'<mo form="{"prefix" if prefix else "infix"}">{SIGNS[text]}</mo>'
        case Punctuation(text=","):
            return '<mo separator="true">,</mo>'
        case Punctuation(text=text):
            return f"<mtext>{escape(text)}\u00a0</mtext>"
        case Gap():
            return '<mspace width="2em"/>'
        case Delimiter(text=text, upper=upper):
            mark = f'<mo stretchy="false" form="{"prefix" if text in "([" else "postfix"}">{escape(text)}</mo>'
            return mark if upper is None else f"<msup>{mark}{mathml(upper)}</msup>"
        case Scripts(base=base, lower=None, upper=None):
            return mathml(base)
        case Scripts(base=base, lower=lower, upper=None) if lower is not None:
            return f"<msub>{mathml(base)}{mathml(lower)}</msub>"
        case Scripts(base=base, lower=None, upper=upper) if upper is not None:
            return f"<msup>{mathml(base)}{mathml(upper)}</msup>"
        case Scripts(base=base, lower=lower, upper=upper) if lower is not None and upper is not None:
            return f"<msubsup>{mathml(base)}{mathml(lower)}{mathml(upper)}</msubsup>"
        case Accent(base=base, mark=mark):
            return f'<mover accent="true">{mathml(base)}<mo stretchy="false">{MARKS[mark]}</mo></mover>'
        case Fraction(numerator=numerator, denominator=denominator):
            return f"<mfrac>{mathml(numerator)}{mathml(denominator)}</mfrac>"
        case Root(radicand=radicand):
            return f"<msqrt>{mathml(radicand)}</msqrt>"
        case Fenced(body=body, fence=fence):
            fixed = "" if tall(body) else ' stretchy="false"'
            return (
                f'<mrow><mo form="prefix"{fixed}>{escape(fence)}</mo>{mathml(body)}'
                f'<mo form="postfix"{fixed}>{escape(CLOSING[fence])}</mo></mrow>'
            )
        case Application(function=function, argument=argument):
            air = "" if isinstance(argument, Fenced) else '<mspace width="0.17em"/>'
            return f"<mrow>{mathml(function)}<mo>\u2061</mo>{air}{mathml(argument)}</mrow>"
        case Product(factors=factors):
            parts = [mathml(factors[0])]
            for left, right in pairwise(factors):
                parts += (SEPARATORS[separator(left, right)], mathml(right))
            return f"<mrow>{''.join(parts)}</mrow>"
        case Sum(terms=terms):
            return f"<mrow>{''.join(_term(*term, first=k == 0) for k, term in enumerate(terms))}</mrow>"
        case Row(pieces=pieces):
            return f"<mrow>{''.join(mathml(piece) for piece in pieces)}</mrow>"
        case Array(rows=rows, fence=fence):
            cells = ("".join(f"<mtd>{mathml(entry)}</mtd>" for entry in row) for row in rows)
            table = "".join(f"<mtr>{row}</mtr>" for row in cells)
            opening = f'<mo form="prefix">{fence}</mo>'
            closing = f'<mo form="postfix">{CLOSING[fence]}</mo>'
            return f"<mrow>{opening}<mtable>{table}</mtable>{closing}</mrow>"
    raise AssertionError(node)


def _term(sign: str, term: Layout, first: bool) -> str:
    """A term of a sum with its sign; a leading plus is left out."""
    if first:
        return f'<mo form="prefix">−</mo>{mathml(term)}' if sign == "-" else mathml(term)
    return f"<mo>{SIGNS[sign]}</mo>{mathml(term)}"
