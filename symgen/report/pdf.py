"""The report as PDF, typeset by Typst."""

from __future__ import annotations

from symgen.backends.render import render
from symgen.report.document import Document, Figure, Formula, InlineMath, Items, Paragraph, Section, Table, Text
from symgen.report.html import svg_element
from symgen.report.markup import Markup
from symgen.report.mathematics.layout import Layout, Row, tall
from symgen.report.mathematics.typst import quoted, typst_math


def render_pdf(document: Document) -> bytes:
    """The whole report as PDF; the same bytes for the same document and Typst version."""
    import typst

    return bytes(typst.compile(render_typst(document).encode(), format="pdf", ignore_system_fonts=True))


def render_drawing(figure: Figure) -> bytes:
    """The drawing of a figure alone as PDF, for LaTeX; as wide as it is."""
    import typst

    source = f"#set page(width: auto, height: auto, margin: 0pt)\n#image(bytes({quoted(svg_element(figure.svg))}))"
    return bytes(typst.compile(source.encode(), format="pdf", ignore_system_fonts=True))


def render_typst(document: Document) -> str:
    """The source given to Typst."""
    return render("report/report.typ.j2", _TypstView(document))


class _TypstView(Markup):
    """What the template prints: prepared source."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self.sections = [self._section(section) for section in document.sections]

    def _section(self, section: Section) -> str:
        parts = [f"{'=' * section.level} {self.text(section.title)}"]
        for block, follower in zip(section.blocks, (*section.blocks[1:], None), strict=True):
            source = self.block(block)
            opens = isinstance(block, Paragraph) and isinstance(follower, (Formula, Items, Table))
            parts.append(f"#block(sticky: true)[{source}]" if opens else source)
        return "\n\n".join(parts)

    def plain(self, text: str) -> str:
        return quoted(text)

    def words(self, text: str) -> str:
        return f"#{quoted(text)};"

    def math(self, node: Layout) -> str:
        return f"${typst_math(node)}$"

    def code(self, text: str) -> str:
        return f"#raw({quoted(text)});"

    def emphasis(self, text: str) -> str:
        return f"#emph({quoted(text)});"

    def reference(self, label: str) -> str:
        number = self.number(label)
        return f"#link(label({quoted('e' + number)}), {quoted(f'({number})')});"

    def figure_reference(self, label: str) -> str:
        number = self.figure_number(label)
        return f"#link(label({quoted('f' + number)}), {quoted(f'Figure {number}')});"

    def formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        number = None if label is None else self.number(label)
        lines = []
        for rows in equations:
            for position, line in enumerate(rows):
                body = f"$ {typst_math(line)} $"
                lines.append(f"pad(left: 2em, {body})" if position else body)
        return f"#formula({'none' if number is None else quoted(number)}, {', '.join(lines)})"

    def items(self, items: list[str]) -> str:
        return "#list(" + ", ".join(f"[{item}]" for item in items) + ")"

    def code_line(self, text: str) -> str:
        return f"#block(raw({quoted(text)}))"

    def figure(self, figure: Figure) -> str:
        width = "92%" if figure.wide else "auto"
        number, source = quoted(self.figure_number(figure.label)), quoted(svg_element(figure.svg))
        return f"#chart({number}, bytes({source}), [{self.text(figure.caption)}], width: {width})"

    def _cell(self, cell: Text) -> str:
        """A cell of a table, with more room where it holds a fraction."""
        high = any(isinstance(part, InlineMath) and tall(part.node) for part in cell)
        return f"table.cell(inset: (x: 0pt, y: 6pt))[{self.text(cell)}]" if high else f"[{self.text(cell)}]"

    def table(self, table: Table) -> str:
        columns = ", ".join(f"{width}fr" if width else "auto" for width in table.widths)
        head = ", ".join(f"[{self.text(heading)}]" for heading in table.headings)
        rows = ",\n  ".join(", ".join(self._cell(cell) for cell in row) for row in table.rows)
        caption = f"{self.text(table.caption)}\n" if table.caption else ""
        return f"{caption}#listing(({columns},), ({head},),\n  {rows})"
