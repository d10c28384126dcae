"""Sentences with formulas in them, and the symbols of the paper."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TypeAlias

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.names import is_name
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.source import ScalarNode
from symgen.model.quantities import QUANTITIES
from symgen.report.document import (
    Emphasis,
    FigureReference,
    FormulaReference,
    Inline,
    InlineCode,
    InlineMath,
    Paragraph,
    Text,
)
from symgen.report.mathematics.breaking import break_lines
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import (
    Accent,
    Fenced,
    Fraction,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Row,
    Scripts,
    Sum,
)
from symgen.report.mathematics.measure import page_width
from symgen.report.mathematics.symbols import symbol_layout

Slot: TypeAlias = str | Layout | InlineCode | Emphasis | FormulaReference | FigureReference


_WORDS = (str, InlineCode, Emphasis, FormulaReference, FigureReference)


def say(pattern: str, *slots: Slot) -> Text:
    """The pattern with every {} replaced by the next slot; strings in slots are text as it is, never a pattern."""
    pieces = pattern.split("{}")
    if len(pieces) != len(slots) + 1:
        raise ValueError(f"{len(slots)} slots for {len(pieces) - 1} places: {pattern}")
    parts: list[Inline] = [pieces[0]]
    for slot, piece in zip(slots, pieces[1:], strict=True):
        parts.append(slot if isinstance(slot, _WORDS) else InlineMath(slot))
        parts.append(piece)
    return tuple(part for part in parts if part != "")


# Em of a formula in a sentence that stays whole.
INLINE_ROOM = 18.0
# What messages quote, and projected matrices, their pseudoinverses and the projector, which they write in ASCII.
_MARKED = re.compile(r"`([^`]+)`|\b([A-Z])~(\+?)|\bN_B\b")


def worded(text: str) -> Text:
    """A message in words, with what it quotes: formulas of the model language are set, all else is code."""
    parts: list[Inline] = []
    end = 0
    for match in _MARKED.finditer(text):
        quoted, letter, plus = match.groups()
        parts.append(text[end : match.start()])
        if quoted is not None:
            parts += _quoted(quoted)
        else:
            parts.append(_projected(letter, plus) if letter else InlineMath(SYMBOLS["nullspace_projector"]))
        end = match.end()
    return tuple(part for part in (*parts, text[end:]) if part != "")


def _projected(letter: str, plus: str) -> InlineMath:
    tilde = Accent(bold(letter), "tilde")
    return InlineMath(pseudoinverse(tilde) if plus else tilde)


def _quoted(text: str) -> Iterator[Inline]:
    """A formula in pieces that fit into a line of a table, or code."""
    tree = None if is_name(text) else parse_expression(ScalarNode(text, Span(1, 1, 1), text, quoted=False))
    if tree is None or isinstance(tree, Mistake):
        yield InlineCode(text)
        return
    for position, line in enumerate(break_lines(expression_layout(tree), page_width, INLINE_ROOM)):
        yield from ((" ",) if position else ())
        yield InlineMath(line)


def paragraph(pattern: str, *slots: Slot) -> Paragraph:
    """A paragraph written with `say`."""
    return Paragraph(say(pattern, *slots))


def bold(text: str) -> Letter:
    """A matrix or vector."""
    return Letter(text, "bold")


def transposed(node: Layout) -> Layout:
    """The transpose."""
    return _raised(node, Letter("T", "upright"))


def pseudoinverse(node: Layout) -> Layout:
    """The Moore-Penrose inverse."""
    return _raised(node, Letter("+", "upright"))


def inverse(node: Layout) -> Layout:
    """The inverse."""
    return _raised(node, Sum((("-", ONE),)))


def _raised(node: Layout, upper: Layout) -> Layout:
    if isinstance(node, Scripts) and node.upper is None:
        return Scripts(node.base, node.lower, upper)
    return Scripts(node, None, upper)


def juxtaposed(*factors: Layout) -> Product:
    """A matrix product."""
    return Product(factors)


def equals(*sides: Layout) -> Row:
    """sides[0] = sides[1] = …"""
    pieces: list[Layout] = [sides[0]]
    for side in sides[1:]:
        pieces += (Relation("="), side)
    return Row(tuple(pieces))


def listed(nodes: tuple[Layout, ...]) -> Row:
    """(a, b, c) without the parentheses."""
    pieces: list[Layout] = []
    for position, node in enumerate(nodes):
        if position:
            pieces.append(Punctuation(","))
        pieces.append(node)
    return Row(tuple(pieces))


def number(value: int) -> Numeral:
    """A natural number."""
    return Numeral(str(value))


def plus(*terms: Layout) -> Layout:
    """The sum of terms."""
    return terms[0] if len(terms) == 1 else Sum(tuple(("+", term) for term in terms))


def minus_sum(positive: tuple[Layout, ...], negative: tuple[Layout, ...]) -> Layout:
    """The sum of the first nodes minus the others."""
    return Sum((*(("+", term) for term in positive), *(("-", term) for term in negative)))


ZERO, ONE, TWO = Numeral("0"), Numeral("1"), Numeral("2")
HALF = Fraction(ONE, TWO)
q, u, lam, g, tau, nu = bold("q"), bold("u"), bold("λ"), bold("g"), bold("τ"), bold("ν")
qd, qdd = Accent(q, "dot"), Accent(q, "ddot")
G, C, Q, B, M, F, N, V, W, IDENTITY = (bold(letter) for letter in "GCQBMFNVWI")
Qa = Scripts(Q, Letter("a", "italic"))
NB = Scripts(N, B)
Mt = Accent(M, "tilde")
T, U = Letter("T"), Letter("U")
PARTIAL = Letter("∂", "upright")
delta, alpha = Letter("δ"), Letter("α")
delta_loc, delta_diff = Scripts(delta, Letter("loc", "upright")), Scripts(delta, Letter("diff", "upright"))
small_n, small_r, small_m, rho = Letter("n"), Letter("r"), Letter("m"), Letter("ρ")
NB_dot = Scripts(Accent(N, "dot"), B)
B_dot = Accent(B, "dot")

# What the report writes in the terms of its own sections, where the code's one line is of others.
REWRITTEN: dict[str, Layout] = {
    "inverse_dynamics_residual": minus_sum((juxtaposed(NB, tau),), (juxtaposed(Mt, u),)),
    "actuator_bias": juxtaposed(transposed(W), Fenced(minus_sum((tau,), (juxtaposed(G, W, Accent(nu, "dot")),)))),
}
SYMBOLS: dict[str, Layout] = {row.name: symbol_layout(row.symbol) for row in QUANTITIES} | REWRITTEN
"""How the quantities are written in formulas: the symbols of their rows, set."""
