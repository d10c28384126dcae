"""The symbol of a quantity as it is set: the one line of text in its row becomes letters, marks and indices."""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from typing import Literal

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

# Letters of numbers and indices; all others are matrices and vectors.
NUMBERS = frozenset("TUaxyzσ")
MARKS: dict[str, Literal["dot", "ddot", "bar", "tilde"]] = {
    "\u0307": "dot",
    "\u0308": "ddot",
    "\u0304": "bar",
    "\u0303": "tilde",
}
RAISED = {"⁺": "+", "ᵀ": "T"}
SIGNS: dict[str, Literal["+", "-"]] = {"+": "+", "−": "-"}
ZERO = "₀"


@cache
def symbol_layout(text: str) -> Layout:
    """Text such as Wᵀ(GẆν + Cq̇), set: a letter is a factor, `_` and braces make an index, spaces say nothing.

    Raises ValueError where the text is none of that.
    """
    return _Reader(unicodedata.normalize("NFD", re.sub(r"\s", "", text))).whole()


class _Reader:
    """Goes through the characters once."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def whole(self) -> Layout:
        layout = self._list()
        if self._at < len(self._text):
            raise ValueError(f"{self._text[self._at :]!r} in the symbol {self._text!r}")
        return layout

    def _next(self) -> str:
        return self._text[self._at : self._at + 1]  # empty at the end

    def _taken(self, wanted: str) -> bool:
        matches = self._next() == wanted
        self._at += matches
        return matches

    def _list(self) -> Layout:
        """One sum, or several with commas between them."""
        pieces = [self._sum()]
        while self._taken(","):
            pieces += (Punctuation(","), self._sum())
        return pieces[0] if len(pieces) == 1 else Row(tuple(pieces))

    def _sum(self) -> Layout:
        terms: list[tuple[Literal["+", "-"], Layout]] = [("+", self._product())]
        while sign := SIGNS.get(self._next()):
            self._at += 1
            terms.append((sign, self._product()))
        return terms[0][1] if len(terms) == 1 else Sum(tuple(terms))

    def _product(self) -> Layout:
        factors = [self._factor()]
        while self._next().isalpha() or self._next() == "(":
            factors.append(self._factor())
        return factors[0] if len(factors) == 1 else Product(tuple(factors))

    def _factor(self) -> Layout:
        base = self._base()
        lower = self._index()
        if upper := RAISED.get(self._next()):
            self._at += 1
            return Scripts(base, lower, Letter(upper, "upright"))
        return base if lower is None else Scripts(base, lower)

    def _base(self) -> Layout:
        if self._taken("("):
            inside = self._list()
            if not self._taken(")"):
                raise ValueError(f"a parenthesis stays open in the symbol {self._text!r}")
            return Fenced(inside)
        letter = self._letter()
        if mark := MARKS.get(self._next()):
            self._at += 1
            return Accent(letter, mark)
        return letter

    def _letter(self) -> Layout:
        text = self._next()
        if not text.isalpha():
            raise ValueError(f"{text!r} stands where a letter should in the symbol {self._text!r}")
        self._at += 1
        return Letter(text) if text in NUMBERS else Letter(text, "bold")

    def _index(self) -> Layout | None:
        if self._taken(ZERO):
            return Numeral("0")
        if not self._taken("_"):
            return None
        if not self._taken("{"):
            return self._letter()
        layout = self._list()
        if not self._taken("}"):
            raise ValueError(f"a brace stays open in the symbol {self._text!r}")
        return layout
