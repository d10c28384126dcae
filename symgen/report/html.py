"""The report as one self-contained HTML page: MathML, a style sheet inside, no scripts, nothing from elsewhere."""

from __future__ import annotations

import re
from html import escape

from symgen.backends.render import render
from symgen.report.document import Document, Figure, Section, Table
from symgen.report.markup import Markup
from symgen.report.mathematics.layout import Layout, Row
from symgen.report.mathematics.mathml import mathml

CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")


def plain(text: str) -> str:
    """Any text as character data: markup escaped, characters XML does not have replaced."""
    return escape(CONTROL.sub("\ufffd", text))


def render_html(document: Document) -> str:
    """The whole page, well-formed as XML too."""
    return render("report/report.html.j2", _HtmlView(document))


class _HtmlView(Markup):
    """What the template prints: prepared markup."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        numbered = list(zip(document.section_numbers(), document.sections, strict=True))
        self.contents = [(number, self.text(section.title)) for number, section in numbered if section.level == 1]
        self.sections = [self._section(number, section) for number, section in numbered]

    def _section(self, number: str, section: Section) -> str:
        head = f"h{section.level + 1}"
        title = f'<{head} id="s{number}"><span class="section">{number}</span> {self.text(section.title)}</{head}>'
        return "\n".join([title, *(self.block(block) for block in section.blocks)])

    def plain(self, text: str) -> str:
        return plain(text)

    def math(self, node: Layout) -> str:
        return f"<math>{mathml(node)}</math>"

    def code(self, text: str) -> str:
        return f"<code>{plain(text)}</code>"

    def emphasis(self, text: str) -> str:
        return f"<em>{plain(text)}</em>"

    def reference(self, label: str) -> str:
        number = self.number(label)
        return f'<a href="#e{number}">({number})</a>'

    def figure_reference(self, label: str) -> str:
        number = self.figure_number(label)
        return f'<a href="#f{number}">Figure {number}</a>'

    def paragraph(self, body: str) -> str:
        return f"<p>{body}</p>"

    def formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        number = None if label is None else self.number(label)
        lines = []
        for rows in equations:
            for position, line in enumerate(rows):
                more = " more" if position else ""
                lines.append(
                    f'<div class="line{more}"><math display="inline" displaystyle="true">{mathml(line)}</math></div>'
                )
        shown = "" if number is None else f'<span class="number">({number})</span>'
        anchor = "" if number is None else f' id="e{number}"'
        return f'<div class="formula"{anchor}><div class="lines">\n' + "\n".join(lines) + f"\n</div>{shown}</div>"

    def items(self, items: list[str]) -> str:
        return "<ul>\n" + "\n".join(f"<li>{item}</li>" for item in items) + "\n</ul>"

    def code_line(self, text: str) -> str:
        return f"<pre><code>{plain(text)}</code></pre>"

    def figure(self, figure: Figure) -> str:
        number = self.figure_number(figure.label)
        caption = f"<figcaption>Figure {number}. {self.text(figure.caption)}</figcaption>"
        return f'<figure id="f{number}">\n{svg_element(figure.svg)}\n{caption}\n</figure>'

    def table(self, table: Table) -> str:
        head = "".join(f"<th>{self.text(heading)}</th>" for heading in table.headings)
        rows = ["<tr>" + "".join(f"<td>{self.text(cell)}</td>" for cell in row) + "</tr>" for row in table.rows]
        caption = f"<caption>{self.text(table.caption)}</caption>\n" if table.caption else ""
        body = "\n".join(rows)
        return f"<table>\n{caption}<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"


def svg_element(svg: str) -> str:
    """The svg element alone, without XML declaration and document type."""
    start = svg.find("<svg")
    return svg[start:].strip() if start >= 0 else ""
