"""What all written forms of a report share: the walk over blocks and sentences; each language says how a kind looks."""

from __future__ import annotations

from abc import ABC, abstractmethod

from symgen.report.document import (
    Block,
    CodeLine,
    Document,
    Emphasis,
    Figure,
    FigureReference,
    Formula,
    FormulaReference,
    Inline,
    InlineCode,
    InlineMath,
    Items,
    Paragraph,
    Table,
    Text,
)
from symgen.report.mathematics.layout import Layout, Row


class Markup(ABC):
    """A document in one markup language; templates print its prepared attributes."""

    def __init__(self, document: Document) -> None:
        self._numbers = document.numbers()
        self._figures = document.figure_numbers()
        self.title = self.plain(document.title)
        self.subtitle = self.plain(document.subtitle)
        self.summary = self.text(document.summary)
        self.colophon = self.plain(document.colophon)

    def text(self, text: Text) -> str:
        """Sentences inside a block."""
        return "".join(self._inline(part) for part in text)

    def block(self, block: Block) -> str:
        """A block with its content."""
        match block:
            case Paragraph(text=text):
                return self.paragraph(self.text(text))
            case Formula(equations=equations, label=label):
                return self.formula(equations, label)
            case Items(items=items):
                return self.items([self.text(item) for item in items])
            case CodeLine(text=line):
                return self.code_line(line)
            case Figure():
                return self.figure(block)
            case Table():
                return self.table(block)

    def _inline(self, part: Inline) -> str:
        match part:
            case str():
                return self.words(part)
            case InlineMath(node=node):
                return self.math(node)
            case InlineCode(text=text):
                return self.code(text)
            case Emphasis(text=text):
                return self.emphasis(text)
            case FormulaReference(label=label):
                return self.reference(label)
            case FigureReference(label=label):
                return self.figure_reference(label)

    def number(self, label: str) -> str:
        """The number of a labelled formula."""
        return self._numbers[label]

    def figure_number(self, label: str) -> str:
        """The number of a figure."""
        return self._figures[label]

    @abstractmethod
    def plain(self, text: str) -> str:
        """Any text, for the places of the template that take no markup."""

    def words(self, text: str) -> str:
        """Any text inside a sentence."""
        return self.plain(text)

    @abstractmethod
    def math(self, node: Layout) -> str:
        """A formula inside a sentence."""

    @abstractmethod
    def code(self, text: str) -> str:
        """A name inside a sentence."""

    @abstractmethod
    def emphasis(self, text: str) -> str:
        """Words in italics."""

    @abstractmethod
    def reference(self, label: str) -> str:
        """The number of a formula, in parentheses, linked to it where the language can."""

    @abstractmethod
    def figure_reference(self, label: str) -> str:
        """`Figure` and its number, linked to it where the language can."""

    def paragraph(self, body: str) -> str:
        """Sentences that are markup already."""
        return body

    @abstractmethod
    def formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        """Displayed equations, each on its lines, numbered where they have a label."""

    @abstractmethod
    def items(self, items: list[str]) -> str:
        """A list of items that are markup already."""

    @abstractmethod
    def code_line(self, text: str) -> str:
        """One line in fixed pitch."""

    @abstractmethod
    def figure(self, figure: Figure) -> str:
        """A drawing over its number and caption."""

    @abstractmethod
    def table(self, table: Table) -> str:
        """A table with its headings."""
