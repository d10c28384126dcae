"""Symbols of quantities: one line of text in the row, letters with marks and indices in the report."""

from __future__ import annotations

import unicodedata

import pytest

from symgen.model.quantities import QUANTITIES
from symgen.report.mathematics.layout import (
    Accent,
    Fenced,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Row,
    Scripts,
    Sum,
)
from symgen.report.mathematics.symbols import symbol_layout
from symgen.report.mathematics.text import text_lines
from symgen.report.prose import REWRITTEN, SYMBOLS

K, S, v = (Letter(text, "bold") for text in "KSv")


@pytest.mark.parametrize(
    ("text", "layout"),
    [
        ("K", K),
        ("K S", Product((K, S))),
        ("v̈₀", Scripts(Accent(v, "ddot"), Numeral("0"))),
        ("K̄_{S,v}⁺", Scripts(Accent(K, "bar"), Row((S, Punctuation(","), v)), Letter("+", "upright"))),
        ("SᵀK_a", Product((Scripts(S, None, Letter("T", "upright")), Scripts(K, Letter("a"))))),
        ("(x, z)", Fenced(Row((Letter("x"), Punctuation(","), Letter("z"))))),
        ("v − K⁺(S + K̃v)", Sum((
            ("+", v),
            ("-", Product((
                Scripts(K, None, Letter("+", "upright")),
                Fenced(Sum((("+", S), ("+", Product((Accent(K, "tilde"), v)))))),
            ))),
        ))),
    ],
)  # fmt: skip
def test_a_line_of_text_is_set(text: str, layout: Layout) -> None:
    assert symbol_layout(text) == layout


@pytest.mark.parametrize("text", ["", "K +", "K_", "K_{S", "(K", "K)", "⁺K", "K*S"])
def test_what_is_no_symbol_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="symbol"):
        symbol_layout(text)


def test_every_quantity_is_set_and_reads_as_its_row_says() -> None:
    assert SYMBOLS.keys() == {row.name for row in QUANTITIES}
    for row in QUANTITIES:
        if row.name in REWRITTEN or "_" in row.symbol:
            continue  # said in other terms; indices are spelled in the text in their own way
        (line,) = text_lines(SYMBOLS[row.name], 100)
        assert plain(line) == plain(row.symbol)


def plain(text: str) -> str:
    """Without what only sets letters apart."""
    return "".join(unicodedata.normalize("NFD", text).split())
