"""The report as one self-contained HTML page: MathML, a style sheet inside, no scripts, nothing from elsewhere."""

from __future__ import annotations

import re
from html import escape

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
from symgen.report.layout import Row
from symgen.report.mathml import mathml

CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")


def plain(text: str) -> str:
    """Any text as character data: markup escaped, characters XML does not have replaced."""
    return escape(CONTROL.sub("\ufffd", text))


def render_html(document: Document) -> str:
    """The whole page, well-formed as XML too."""
    return render("report/report.html.j2", _HtmlView(document))


class _HtmlView:
    """What the template prints: prepared markup."""

    def __init__(self, document: Document) -> None:
        self._numbers = document.numbers()
        self.title = plain(document.title)
        self.subtitle = plain(document.subtitle)
        self.summary = self._text(document.summary)
        self.colophon = plain(document.colophon)
        numbered = list(zip(document.section_numbers(), document.sections, strict=True))
        self.contents = [(number, self._text(section.title)) for number, section in numbered if section.level == 1]
        self.sections = [self._section(number, section) for number, section in numbered]

    def _section(self, number: str, section: Section) -> str:
        head = f"h{section.level + 1}"
        title = f'<{head} id="s{number}"><span class="section">{number}</span> {self._text(section.title)}</{head}>'
        return "\n".join([title, *(self._block(block) for block in section.blocks)])

    def _text(self, text: Text) -> str:
        return "".join(self._inline(part) for part in text)

    def _inline(self, part: object) -> str:
        match part:
            case str():
                return plain(part)
            case InlineMath(node=node):
                return f"<math>{mathml(node)}</math>"
            case InlineCode(text=text):
                return f"<code>{plain(text)}</code>"
            case Emphasis(text=text):
                return f"<em>{plain(text)}</em>"
            case Reference(label=label):
                number = self._numbers[label]
                return f'<a href="#e{number}">({number})</a>'
        raise AssertionError(part)

    def _block(self, block: Block) -> str:
        match block:
            case Paragraph(text=text):
                return f"<p>{self._text(text)}</p>"
            case Formula(equations=equations, label=label):
                return self._formula(equations, label)
            case Items(items=items):
                return "<ul>\n" + "\n".join(f"<li>{self._text(item)}</li>" for item in items) + "\n</ul>"
            case CodeLine(text=text):
                return f"<pre><code>{plain(text)}</code></pre>"
            case Figure(svg=svg, caption=caption):
                return f"<figure>\n{svg_element(svg)}\n<figcaption>{self._text(caption)}</figcaption>\n</figure>"
            case Table():
                return self._table(block)

    def _formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        lines = []
        for rows in equations:
            for position, line in enumerate(rows):
                more = " more" if position else ""
                lines.append(
                    f'<div class="line{more}"><math display="inline" displaystyle="true">{mathml(line)}</math></div>'
                )
        number = "" if label is None else f'<span class="number">({self._numbers[label]})</span>'
        anchor = "" if label is None else f' id="e{self._numbers[label]}"'
        return f'<div class="formula"{anchor}><div class="lines">\n' + "\n".join(lines) + f"\n</div>{number}</div>"

    def _table(self, table: Table) -> str:
        head = "".join(f"<th>{self._text(heading)}</th>" for heading in table.headings)
        rows = ["<tr>" + "".join(f"<td>{self._text(cell)}</td>" for cell in row) + "</tr>" for row in table.rows]
        caption = f"<caption>{self._text(table.caption)}</caption>\n" if table.caption else ""
        body = "\n".join(rows)
        return f"<table>\n{caption}<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"


def svg_element(svg: str) -> str:
    """The svg element alone, without XML declaration and document type."""
    start = svg.find("<svg")
    return svg[start:].strip() if start >= 0 else ""
