"""What all sections share: the input, the order of names, and the ways to print a quantity."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from symgen.model.expression import Expression
from symgen.model.model import Model
from symgen.report.content import ClosedForm, ReportInput
from symgen.report.document import Block, Formula
from symgen.report.from_expression import expression_layout
from symgen.report.from_sympy import ACCELERATION, COORDINATE, PARAMETER, RATE, SympyLayout
from symgen.report.layout import Array, Layout, Letter, Numeral, equation
from symgen.report.matrices import array_blocks, matrix_blocks
from symgen.report.names import name_layout
from symgen.report.prose import SYMBOLS, paragraph


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


class Context:
    """One report being composed."""

    def __init__(self, report_input: ReportInput) -> None:
        self.input = report_input
        self.model = report_input.model
        self.structure = report_input.structure
        self.full = report_input.model.report == "full"
        order = name_order(report_input.model)
        self.layout = SympyLayout(order)
        self.taken = frozenset(order) | _intermediate_names(report_input.closed_forms)

    def form(self, quantity: str) -> ClosedForm | None:
        """The closed form of a quantity, where the model has one."""
        return self.input.closed_forms.get(quantity)

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
        blocks: list[Block] = []
        if form.intermediates:
            blocks += [paragraph("With the intermediate expressions"), self._intermediates(form)]
        if form.matrix is not None:
            blocks += matrix_blocks(shown, form.matrix, self.layout, self.taken, label)
        if form.note:
            blocks.append(paragraph("{}", sentence(form.note)))
        return tuple(blocks)

    def expressions(self, symbol: Layout, rows: tuple[tuple[Expression, ...], ...]) -> tuple[Block, ...]:
        """A matrix of expressions of the model file, as the user wrote them."""
        array = Array(tuple(tuple(expression_layout(entry) for entry in row) for row in rows))
        return array_blocks(symbol, array, None)

    def column(self, names: tuple[str, ...]) -> Layout:
        """Names as a column vector in a line: (a, b, c) transposed is left to the reader."""
        return Array((tuple(name_layout(name) for name in names),)) if names else Numeral("0")

    def _intermediates(self, form: ClosedForm) -> Formula:
        equations = []
        for symbol, value in form.intermediates:
            name = symbol if isinstance(symbol, str) else symbol.name
            is_matrix = hasattr(value, "shape")
            right = self.layout.matrix(value) if is_matrix else self.layout.expression(value)
            equations.append(equation(name_layout(name), right))
        return Formula(tuple(equations))


def sentence(text: str) -> str:
    """The text with a capital and a full stop."""
    stripped = text.strip()
    if not stripped:
        return ""
    ended = stripped if stripped[-1] in ".!?:" else stripped + "."
    return ended[0].upper() + ended[1:]


def _intermediate_names(forms: Mapping[str, ClosedForm]) -> frozenset[str]:
    """Names the closed forms introduced."""
    return frozenset(str(symbol) for form in forms.values() for symbol, _ in form.intermediates)


def text_of(description: str) -> str:
    """A description as running text on one line."""
    return " ".join(description.split())


def word(text: str) -> Letter:
    """An upright word inside a formula."""
    return Letter(text, "upright")
