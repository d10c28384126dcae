"""Closed forms for `symgen explain`: plain Unicode text, wrapped to the terminal."""

from __future__ import annotations

from typing import Any

from symgen.model.model import Model
from symgen.report.context import name_order
from symgen.report.mathematics.from_sympy import SympyLayout
from symgen.report.mathematics.layout import Layout, equation
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.text import text_lines
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
    return "\n".join(text_lines(equation(left, right), width))
