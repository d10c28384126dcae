"""Closed forms and sentences for `symgen explain`: plain Unicode text, wrapped to the terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

from symgen.diagnostics import SymgenBug
from symgen.model.model import Model
from symgen.report.context import name_order, row_names
from symgen.report.document import Block, Formula, Inline, InlineCode, InlineMath, Paragraph, Text
from symgen.report.mathematics.from_sympy import SympyLayout
from symgen.report.mathematics.layout import Gap, Layout, Row, equation
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.text import CONTINUATION, text_lines, text_math
from symgen.report.prose import SYMBOLS


def render_text_math(value: Any, model: Model | None = None, symbol: str | None = None, width: int = 100) -> str:
    """A SymPy expression or matrix as text of at most `width` columns.

    `symbol` is the name of a quantity (its usual symbol stands before the equals sign) or any other name;
    `model` gives the order of factors and terms.
    """
    layout = SympyLayout({} if model is None else name_order(model))
    right: Layout = layout.matrix(value) if hasattr(value, "shape") else layout.expression(value)
    if symbol is None:
        return "\n".join(text_lines(right, width))
    left = SYMBOLS.get(symbol) or name_layout(symbol)
    names = () if model is None else row_names(symbol, model)
    return "\n".join(text_lines(equation(left, right), width, names))


def sentence_text(text: Text) -> str:
    """Sentences with their formulas on one line; names are quoted."""
    return "".join(_words(part) for part in text)


def block_lines(blocks: Iterable[Block], width: int) -> Iterator[str]:
    """Paragraphs and displayed formulas in lines of at most `width` columns, as far as formulas can be broken."""
    for block in blocks:
        match block:
            case Paragraph(text=text):
                yield from textwrap.wrap(sentence_text(text), width)
            case Formula(equations=equations):
                for one in (one for rows in equations for one in _apart(rows)):
                    yield from (f"{CONTINUATION}{line}" for line in text_lines(one, width - len(CONTINUATION)))
            case _:
                raise SymgenBug(f"explain: no way to print a {type(block).__name__}")


def _apart(rows: tuple[Row, ...]) -> Iterator[Layout]:
    """The equations that share a line of a page, each by itself and unbroken."""
    pieces = [piece for row in rows for piece in row.pieces]
    if len(pieces) == 1 and isinstance(pieces[0], Row):
        pieces = [*pieces[0].pieces]
    while Gap() in pieces:
        end = pieces.index(Gap())
        yield Row(tuple(pieces[: end - 1]))  # without the comma before the gap
        pieces = pieces[end + 1 :]
    yield Row(tuple(pieces))


def _words(part: Inline) -> str:
    match part:
        case str():
            return part
        case InlineMath(node=node):
            return text_math(node)
        case InlineCode(text=text):
            return f"`{text}`"
        case _:
            raise SymgenBug(f"explain: no way to print a {type(part).__name__}")
