"""A report as data: sections of paragraphs, formulas, tables and figures, the one source of HTML, LaTeX and PDF."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeAlias

from symgen.records import dataclass
from symgen.report.mathematics.breaking import break_lines
from symgen.report.mathematics.layout import Layout, Row
from symgen.report.mathematics.measure import page_width

ROOM = 40.0
"""Width of a displayed formula in em, beside its number."""


@dataclass(frozen=True, slots=True)
class InlineMath:
    """A formula inside a sentence."""

    node: Layout


@dataclass(frozen=True, slots=True)
class InlineCode:
    """A name from the model file or the command line inside a sentence."""

    text: str


@dataclass(frozen=True, slots=True)
class FormulaReference:
    """The number of a labelled formula."""

    label: str


@dataclass(frozen=True, slots=True)
class FigureReference:
    """The number of a figure, after the word."""

    label: str


@dataclass(frozen=True, slots=True)
class Emphasis:
    """A few words in italics."""

    text: str


Inline: TypeAlias = str | InlineMath | InlineCode | FormulaReference | FigureReference | Emphasis
Text: TypeAlias = tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Sentences."""

    text: Text


@dataclass(frozen=True, slots=True)
class Formula:
    """Displayed equations one below the other, each on its lines; numbered where they have a label."""

    equations: tuple[tuple[Row, ...], ...]
    label: str | None = None


@dataclass(frozen=True, slots=True)
class Items:
    """A list with bullets."""

    items: tuple[Text, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A table with one line of headings; `widths` are relative, 0 = as wide as its content."""

    headings: tuple[Text, ...]
    rows: tuple[tuple[Text, ...], ...]
    widths: tuple[int, ...]
    caption: Text = ()


@dataclass(frozen=True, slots=True)
class Figure:
    """A drawing as SVG text, with its caption, numbered; at its own size, or as wide as the page (`wide`)."""

    svg: str
    caption: Text
    label: str
    wide: bool = True


@dataclass(frozen=True, slots=True)
class CodeLine:
    """One line in fixed pitch on a line of its own."""

    text: str


def displayed(equations: Iterable[Layout], label: str | None = None) -> Formula:
    """A formula of these equations, long ones broken into lines of at most ROOM."""
    return Formula(tuple(break_lines(node, page_width, ROOM) for node in equations), label)


def layouts(blocks: Iterable[Block]) -> Iterator[Layout]:
    """All formulas in blocks, displayed ones line by line."""
    for block in blocks:
        match block:
            case Formula(equations=equations):
                yield from (line for rows in equations for line in rows)
            case Paragraph(text=text) | Figure(caption=text):
                yield from _inline((text,))
            case Items(items=items):
                yield from _inline(items)
            case Table(headings=headings, rows=rows, caption=caption):
                yield from _inline((*headings, *(cell for row in rows for cell in row), caption))
            case CodeLine():
                pass


def _inline(texts: Iterable[Text]) -> Iterator[Layout]:
    return (part.node for text in texts for part in text if isinstance(part, InlineMath))


Block: TypeAlias = Paragraph | Formula | Items | Table | Figure | CodeLine


@dataclass(frozen=True, slots=True)
class Section:
    """A numbered section; subsections are sections of level 2."""

    title: Text
    blocks: tuple[Block, ...]
    level: int = 1


@dataclass(frozen=True, slots=True)
class Document:
    """A whole report; `name` is that of its files and of its labels."""

    name: str
    title: str
    subtitle: str
    summary: Text
    sections: tuple[Section, ...]
    colophon: str

    def formulas(self) -> Iterator[Formula]:
        """All displayed formulas in order."""
        for section in self.sections:
            for block in section.blocks:
                if isinstance(block, Formula):
                    yield block

    def numbers(self) -> dict[str, str]:
        """The number of every labelled formula, counted from 1 in order of appearance."""
        labels = (formula.label for formula in self.formulas() if formula.label is not None)
        return {label: str(position) for position, label in enumerate(labels, start=1)}

    def figures(self) -> Iterator[Figure]:
        """All figures in order."""
        return (block for section in self.sections for block in section.blocks if isinstance(block, Figure))

    def figure_numbers(self) -> dict[str, str]:
        """The number of every figure, counted from 1 in order of appearance."""
        return {figure.label: str(position) for position, figure in enumerate(self.figures(), start=1)}

    def section_numbers(self) -> tuple[str, ...]:
        """The number of every section: 1, 2, 2.1, 2.2, 3."""
        chapter = part = 0
        numbers = []
        for section in self.sections:
            if section.level == 1:
                chapter, part = chapter + 1, 0
                numbers.append(str(chapter))
            else:
                part += 1
                numbers.append(f"{chapter}.{part}")
        return tuple(numbers)
