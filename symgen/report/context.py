"""What all sections share: the input, the order of names, and the ways to print a quantity."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import islice
from typing import Any

from symgen.closedform.forms import ClosedForm
from symgen.closedform.laws.terms import MatrixLaw
from symgen.model.model import Model
from symgen.report.content import ReportInput
from symgen.report.document import Block, FormulaReference, Paragraph, Text, displayed
from symgen.report.mathematics.from_sympy import (
    ACCELERATION,
    COORDINATE,
    PARAMETER,
    RATE,
    SympyLayout,
)
from symgen.report.mathematics.layout import Layout, equation, size
from symgen.report.mathematics.matrices import Denominators, matrix_blocks, packed
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import SYMBOLS, paragraph, say

SHORT = 120
"""Nodes up to which a matrix is printed in a short report."""


def name_order(model: Model) -> Mapping[str, tuple[int, int]]:
    """Kind and place of every name of the model: factors and terms are set in this order."""
    order: dict[str, tuple[int, int]] = {}
    for place, name in enumerate([p.name for p in model.parameters] + [i.name for i in model.inputs]):
        order[name] = (PARAMETER, place)
    for place, definition in enumerate(model.definitions):
        order[definition.name] = (COORDINATE, len(model.coordinates) + place)
    for place, coordinate in enumerate(model.coordinates):
        order[coordinate.name] = (COORDINATE, place)
        order[coordinate.rate] = (RATE, place)
        order[coordinate.acceleration] = (ACCELERATION, place)
    return order


def row_names(quantity: str, model: Model) -> tuple[Layout, ...]:
    """What the entries of a column are called in the model: those of u by their inputs."""
    return tuple(name_layout(one.name) for one in model.inputs) if quantity == "inverse_dynamics" else ()


class Context:
    """One report being composed."""

    def __init__(self, report_input: ReportInput) -> None:
        self.input = report_input
        self.model = report_input.model
        self.structure = report_input.structure
        self.full = report_input.model.report == "full"
        order = name_order(report_input.model)
        self.layout = SympyLayout(order)
        self.denominators = Denominators(frozenset(order), _intermediate_names(report_input.forms))
        self._defined: dict[str, str] = {}
        self._listed: set[str] = set()

    def form(self, quantity: str) -> ClosedForm | None:
        """The closed form of a quantity, where the model has one."""
        return self.input.forms.get(quantity)

    def laws(self, quantity: str) -> tuple[MatrixLaw, ...]:
        """The laws of a quantity whose closed form is long; in a short report those that need no list of names."""
        return tuple(law for law in self.input.laws.get(quantity, ()) if self.full or not law.intermediates)

    def matrix(self, quantity: str) -> Any:
        """The SymPy matrix of a quantity, or None."""
        form = self.form(quantity)
        return None if form is None else form.matrix

    def vanishes(self, quantity: str) -> bool:
        """Whether a quantity is known to be zero identically."""
        matrix = self.matrix(quantity)
        return matrix is not None and all(entry == 0 for entry in matrix)

    def quantity(self, quantity: str, label: str | None = None, symbol: Layout | None = None) -> tuple[Block, ...]:
        """The closed form of a quantity with its intermediates and note; nothing where the model has none."""
        form = self.form(quantity)
        if form is None:
            return ()
        shown = SYMBOLS[quantity] if symbol is None else symbol
        if not self.full and form.matrix is not None and not self._short(form):
            return (paragraph("{} is long and left out of this short report.", shown),)
        blocks: list[Block] = []
        if form.intermediates:
            blocks += self.intermediates(form.intermediates, f"with_{quantity}")
        if form.matrix is not None:
            names = row_names(quantity, self.model)
            blocks += matrix_blocks(shown, form.matrix, self.layout, self.denominators, label, names)
        if form.note:
            blocks.append(_remark(shown, form.note, form.matrix is not None))
        return tuple(blocks)

    def _short(self, form: ClosedForm) -> bool:
        """Whether a form is printed in a short report."""
        return not form.intermediates and size(self.layout.matrix(form.matrix)) <= SHORT

    def free_names(self, stem: str, count: int) -> list[str]:
        """D_1, D_2 and the like that nothing else in the report is called."""
        taken = frozenset(name_order(self.model)) | _intermediate_names(self.input.forms)
        numbered = (f"{stem}_{k}" for k in range(1, count + len(taken) + 1))
        return list(islice((name for name in numbered if name not in taken), count))

    def first(self, factor: str) -> bool:
        """Whether a factor of a law is to be listed now; it stands above when it is asked for again."""
        known = factor in self._listed
        self._listed.add(factor)
        return not known

    def intermediates(self, named: tuple[tuple[Any, Any], ...], label: str) -> list[Block]:
        """The definitions of the names (symbols of SymPy) that a form uses, those of earlier forms by reference."""
        new = [(symbol, value) for symbol, value in named if symbol.name not in self._defined]
        earlier = sorted({self._defined[symbol.name] for symbol, _ in named if symbol.name in self._defined})
        self._defined |= {symbol.name: label for symbol, _ in new}
        known = say(" and".join([" {}"] * len(earlier)), *map(FormulaReference, earlier))
        if not new:
            return [Paragraph((*say("With the intermediate expressions of"), *known))]
        opening = "With the intermediate expressions" if not earlier else "With the intermediate expressions of"
        text: Text = (opening, *known, " and") if earlier else (opening,)
        equations = (equation(name_layout(s.name), self.layout.expression(value)) for s, value in new)
        return [Paragraph(text), displayed(tuple(packed(equations)), label)]


def _remark(symbol: Layout, note: str, printed: bool) -> Block:
    """Why a form is given in named parts or not at all; the formula after the semicolon stands in the text already."""
    reason = note.split(";")[0].strip()
    if printed:
        return paragraph(
            "Written out without names it would be too long ({}).", reason.removeprefix("not written out: ")
        )
    if reason.startswith("not written out"):
        why = reason.removeprefix("not written out").lstrip(":, ")
        return paragraph(f"{{}} is not written out{f' ({why})' if why and 'N_B' not in why else ''}.", symbol)
    return paragraph("{}", sentence(note))


def sentence(text: str) -> str:
    """The text with a capital and a full stop; a symbol that it begins with, such as δ or m_1, stays as it is."""
    stripped = text.strip()
    if not stripped:
        return ""
    ended = stripped if stripped[-1] in ".!?:" else stripped + "."
    first = re.split(r"[\s,;:.]", ended, maxsplit=1)[0]
    is_word = first.isascii() and (len(first) > 1 or first == "a") and "_" not in first
    return ended[0].upper() + ended[1:] if is_word else ended


def _intermediate_names(forms: Mapping[str, ClosedForm]) -> frozenset[str]:
    """Names the closed forms introduced."""
    return frozenset(str(symbol) for form in forms.values() for symbol, _ in form.intermediates)


def text_of(description: str) -> str:
    """A description as running text on one line."""
    return " ".join(description.split())
