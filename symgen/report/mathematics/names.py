"""How a name of the model file looks on the page: theta_1 as θ with index 1, x_dot as x with a dot."""

from __future__ import annotations

import re
from functools import cache
from typing import Literal

from symgen.model.mechanism import WORLD, Component, component, is_component
from symgen.naming import GREEK
from symgen.report.mathematics.layout import (
    Accent,
    Layout,
    Letter,
    Numeral,
    Punctuation,
    Row,
    Scripts,
)

MULTIPLIER = "multiplier_"
RATE_MARKS: tuple[tuple[str, Literal["ddot", "dot"]], ...] = (("_ddot", "ddot"), ("_dot", "dot"))


def _word(text: str) -> Layout:
    """One part of a name: a Greek letter, an italic letter, digits, or an upright word."""
    if text in GREEK:
        return Letter(GREEK[text])
    if text.isdigit():
        return Numeral(text)
    return Letter(text, "italic" if len(text) == 1 else "upright")


def _component_layout(one: Component) -> Layout:
    """tip.x as x with index tip, tip.vx as v with index tip, x; other axes than the world's are named at the end."""
    owner = Letter(one.owner.replace("_", " "), "upright")
    places: list[Layout] = [owner]
    symbol: Layout = Letter(one.what[-1] if len(one.what) == 1 else "ω" if one.what[0] == "w" else one.what[0])
    if len(one.what) > 1:
        places += [Punctuation(","), Letter(one.what[1:])]
    if one.axes != WORLD:
        places += [Punctuation(","), Letter(one.axes.replace("_", " "), "upright")]
    return Scripts(symbol, places[0] if len(places) == 1 else Row(tuple(places)))


def _entry_layout(matrix: str, row: str, column: str) -> Layout:
    """B[1,4] as the entry 1, 4 of B."""
    return Scripts(Letter(matrix, "bold"), Row((Numeral(row), Punctuation(","), Numeral(column))))


@cache
def name_layout(name: str) -> Layout:
    """A name as it is set: dots for rates and accelerations, parts after underscores as indices; entries of B."""
    if is_component(name):
        return _component_layout(component(name))
    if entry := re.fullmatch(r"([A-Z])\[(\d+),(\d+)\]", name):
        return _entry_layout(*entry.groups())
    for suffix, mark in RATE_MARKS:
        if name.endswith(suffix) and len(name) > len(suffix):
            inner = name_layout(name[: -len(suffix)])
            if isinstance(inner, Scripts):
                return Scripts(Accent(inner.base, mark), inner.lower, inner.upper)
            return Accent(inner, mark)
    if name.startswith(MULTIPLIER) and len(name) > len(MULTIPLIER):
        return Scripts(Letter("λ"), Letter(name[len(MULTIPLIER) :].replace("_", " "), "upright"))
    head, *indices = [part for part in name.split("_") if part] or [name]
    digits = re.fullmatch(r"([A-Za-z]+)(\d+)", head)
    if digits and (len(digits[1]) == 1 or digits[1] in GREEK):
        head, indices = digits[1], [digits[2], *indices]
    base = _word(head)
    if not indices:
        return base
    pieces: list[Layout] = []
    for position, index in enumerate(indices):
        if position:
            pieces.append(Punctuation(","))
        pieces.append(_word(index))
    return Scripts(base, pieces[0] if len(pieces) == 1 else Row(tuple(pieces)))
