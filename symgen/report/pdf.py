"""The report as PDF, typeset by Typst."""

from __future__ import annotations

from symgen.emit.render import render
from symgen.report.document import (
    Block,
    CodeLine,
    Document,
    Emphasis,
    Figure,
    Formula,
    InlineCode,
    InlineMath,
    Items,
    Paragraph,
    Reference,
    Section,
    Table,
    Text,
)
from symgen.report.html import svg_element
from symgen.report.layout import Row, tall
from symgen.report.typst_math import quoted, typst_math


def render_pdf(document: Document) -> bytes:
    """The whole report as PDF; the same bytes for the same document and Typst version."""
    import typst

    return bytes(typst.compile(render_typst(document).encode(), format="pdf", ignore_system_fonts=True))


def render_typst(document: Document) -> str:
    """The source given to Typst."""
    return render("report/report.typ.j2", _TypstView(document))


class _TypstView:
    """What the template prints: prepared source."""

    def __init__(self, document: Document) -> None:
        self._numbers = document.numbers()
        self.title = quoted(document.title)
        self.subtitle = quoted(document.subtitle)
        self.summary = self._text(document.summary)
        self.colophon = quoted(document.colophon)
        self.sections = [self._section(section) for section in document.sections]

    def _section(self, section: Section) -> str:
        parts = [f"{'=' * section.level} {self._text(section.title)}"]
        for block, follower in zip(section.blocks, (*section.blocks[1:], None), strict=True):
            source = self._block(block)
            opens = isinstance(block, Paragraph) and isinstance(follower, (Formula, Items, Table))
            parts.append(f"#block(sticky: true)[{source}]" if opens else source)
        return "\n\n".join(parts)

    def _text(self, text: Text) -> str:
        return "".join(self._inline(part) for part in text)

    def _inline(self, part: object) -> str:
        match part:
            case str():
                return f"#{quoted(part)};"
            case InlineMath(node=node):
                return f"${typst_math(node)}$"
            case InlineCode(text=text):
                return f"#raw({quoted(text)});"
            case Emphasis(text=text):
                return f"#emph({quoted(text)});"
            case Reference(label=label):
                number = self._numbers[label]
                return f"#link(label({quoted('e' + number)}), {quoted(f'({number})')});"
        raise AssertionError(part)

    def _block(self, block: Block) -> str:
        match block:
            case Paragraph(text=text):
                return self._text(text)
            case Formula(equations=equations, label=label):
                return self._formula(equations, label)
            case Items(items=items):
                return "#list(" + ", ".join(f"[{self._text(item)}]" for item in items) + ")"
            case CodeLine(text=text):
                return f"#block(raw({quoted(text)}))"
            case Figure(svg=svg, caption=caption):
                return f"#chart(bytes({quoted(svg_element(svg))}), [{self._text(caption)}])"
            case Table():
                return self._table(block)

    def _formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        lines = []
        for rows in equations:
            for position, line in enumerate(rows):
                body = f"$ {typst_math(line)} $"
                lines.append(f"pad(left: 2em, {body})" if position else body)
        if label is None:
            return f"#formula(none, {', '.join(lines)})"
        return f"#formula({quoted(self._numbers[label])}, {', '.join(lines)})"

    def _cell(self, cell: Text) -> str:
        """A cell of a table, with more room where it holds a fraction."""
        high = any(isinstance(part, InlineMath) and tall(part.node) for part in cell)
        return f"table.cell(inset: (x: 0pt, y: 6pt))[{self._text(cell)}]" if high else f"[{self._text(cell)}]"

    def _table(self, table: Table) -> str:
        columns = ", ".join(f"{width}fr" if width else "auto" for width in table.widths)
        head = ", ".join(f"[{self._text(heading)}]" for heading in table.headings)
        rows = ",\n  ".join(", ".join(self._cell(cell) for cell in row) for row in table.rows)
        caption = f"{self._text(table.caption)}\n" if table.caption else ""
        return f"{caption}#listing(({columns},), ({head},),\n  {rows})"
