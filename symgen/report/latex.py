"""The report as LaTeX source: a document by itself, and its sections where another one has it by \\input."""

from __future__ import annotations

from symgen.backends.render import render
from symgen.report.document import (
    Document,
    Emphasis,
    Figure,
    FormulaReference,
    InlineCode,
    InlineMath,
    Section,
    Table,
    Text,
)
from symgen.report.markup import Markup
from symgen.report.mathematics.latex import GREEK, RELATIONS, latex_math
from symgen.report.mathematics.layout import Layout, Row
from symgen.report.mathematics.measure import page_width

# The width of a line of text, in em.
LINE = 44.0
TABLE_GAP = 1.3
"""Widths in em of a line of text, and of the space between the columns of a table."""
# Of the width of a line, that of a drawing.
FIGURE_SHARE = 0.8
SPECIAL: dict[str, str] = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
    "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}", '"': r"\symbol{34}", "`": r"\textasciigrave{}", "–": "--", "—": "---", "’": "'",
    "‘": "`", "“": "``", "”": "''", "…": r"\ldots{}", "\u00a0": "~", "−": "$-$", "·": r"$\cdot$", "×": r"$\times$",
    "°": r"$^\circ$", "√": r"$\surd$", "→": r"$\to$", "\n": " ", "\r": " ", "\t": " ",
    "⁻": r"$^{-}$", "⁺": r"$^{+}$", "ᵀ": r"$^{\mathrm{T}}$",
    **{character: f"$^{digit}$" for digit, character in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")},
}  # fmt: skip


def drawing_file(name: str, figure: Figure) -> str:
    """The file beside the source that has the drawing of a figure."""
    return f"{name}_{figure.label}.pdf"


def latex_text(text: str) -> str:
    """Any text as LaTeX text; letters beyond Latin and Greek appear as their code points."""
    return "".join(_character(character) for character in text)


def _character(character: str) -> str:
    if character in SPECIAL:
        return SPECIAL[character]
    if character in GREEK:
        return f"${GREEK[character]}$"
    if character in RELATIONS:
        return f"${RELATIONS[character]}$" if not character.isascii() else character
    if " " <= character <= "~" or "À" <= character <= "ſ":
        return character
    return rf"\texttt{{U+{ord(character):04X}}}"


def render_latex(document: Document) -> str:
    """The whole source file."""
    return render("report/report.tex.j2", _LatexView(document))


def render_latex_sections(document: Document) -> str:
    """Its sections alone, for the source that has them by \\input."""
    return "\n\n".join(_LatexView(document).sections) + "\n"


class _LatexView(Markup):
    """What the template prints: prepared source."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self.name = document.name
        self.sections = [self._section(section) for section in document.sections]

    def _section(self, section: Section) -> str:
        command = "section" if section.level == 1 else "subsection"
        return "\n\n".join([rf"\{command}{{{self.text(section.title)}}}", *map(self.block, section.blocks)])

    def plain(self, text: str) -> str:
        return latex_text(text)

    def math(self, node: Layout) -> str:
        return f"${latex_math(node)}$"

    def code(self, text: str) -> str:
        return rf"\texttt{{{latex_text(text)}}}"

    def emphasis(self, text: str) -> str:
        return rf"\emph{{{latex_text(text)}}}"

    def reference(self, label: str) -> str:
        return rf"\eqref{{eq:{self.name}:{label}}}"

    def figure_reference(self, label: str) -> str:
        return rf"Figure~\ref{{fig:{self.name}:{label}}}"

    def formula(self, equations: tuple[tuple[Row, ...], ...], label: str | None) -> str:
        lines = []
        for rows in equations:
            for position, line in enumerate(rows):
                indent = r"\quad " if position else ""
                lines.append(f"& {indent}{latex_math(line).strip()}")
        if label is None:
            body = " \\\\\n".join(lines)
            return f"\\begin{{align*}}\n{body}\n\\end{{align*}}"
        lines = [rf"{lines[0]} \label{{eq:{self.name}:{label}}}", *(rf"{line} \notag" for line in lines[1:])]
        body = " \\\\\n".join(lines)
        return f"\\begin{{align}}\n{body}\n\\end{{align}}"

    def items(self, items: list[str]) -> str:
        body = "\n".join(rf"\item {item}" for item in items)
        return f"\\begin{{itemize}}\n{body}\n\\end{{itemize}}"

    def code_line(self, text: str) -> str:
        return rf"\noindent\texttt{{{latex_text(text)}}}"

    def figure(self, figure: Figure) -> str:
        file = drawing_file(self.name, figure)
        drawn = rf"\IfFileExists{{{file}}}{{\includegraphics[width={FIGURE_SHARE}\linewidth]{{{file}}}}}"
        return (
            f"\\begin{{figure}}[htbp]\n\\centering\n{drawn}{{\\emph{{(drawn in the HTML)}}}}\n"
            f"\\caption{{{self.text(figure.caption)}}}\n\\label{{fig:{self.name}:{figure.label}}}\n\\end{{figure}}"
        )

    def table(self, table: Table) -> str:
        columns = "".join(_columns(table))
        head = " & ".join(rf"\textbf{{{self.text(heading)}}}" for heading in table.headings)
        rows = "\n".join(" & ".join(self.text(cell) for cell in row) + r" \\" for row in table.rows)
        caption = f"\\noindent {self.text(table.caption)}\n\n" if table.caption else ""
        return (
            f"{caption}{{\\small\n\\begin{{longtable}}{{@{{}}{columns}@{{}}}}\n\\hline\n{head} "
            f"\\\\\n\\hline\n\\endhead\n"
            f"{rows}\n\\hline\n\\end{{longtable}}}}"
        )


def _columns(table: Table) -> list[str]:
    """Column types: narrow columns as wide as their content, the others share what is left of the line."""
    cells = zip(table.headings, *table.rows, strict=True)
    natural = [max(_text_width(cell) for cell in column) + TABLE_GAP for column in cells]
    taken = sum(width for width, share in zip(natural, table.widths, strict=True) if share == 0)
    shares = sum(table.widths)
    left = max(LINE - taken - TABLE_GAP * sum(share > 0 for share in table.widths), 12.0)
    return [
        rf">{{\raggedright\arraybackslash}}p{{{left * share / shares:.1f}em}}" if share else "l"
        for share in table.widths
    ]


def _text_width(text: Text) -> float:
    """The width of a cell in em, estimated a little wide."""
    width = 0.0
    for part in text:
        match part:
            case str():
                width += 0.5 * len(part)
            case InlineMath(node=node):
                width += page_width(node)
            case InlineCode(text=inside) | Emphasis(text=inside):
                width += 0.53 * len(inside)
            case FormulaReference():
                width += 1.8
    return width
