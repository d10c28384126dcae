"""What `symgen explain` prints: the structure of a system, and its closed forms as plain text."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Sequence

from symgen.methods.selection import MethodChoice
from symgen.methods.table import label
from symgen.report.content import ReportInput
from symgen.report.context import Context
from symgen.report.prose import worded
from symgen.report.sections.singular import ORDER, dependent_rows_lose_rank, measured_by, sets_by_determinants
from symgen.report.terminal import block_lines, render_text_math, sentence_text

# Characters of a line at most, in however wide a terminal, and where there is none.
WIDEST_TEXT = 120
# Characters of a line of a formula where there is no terminal.
FORMULA_TEXT = 100


def overview(report: ReportInput) -> str:
    """Sizes, freedom, actuation, what is skipped, singular sets, integrability, published formulas, closed forms."""
    model, structure = report.model, report.structure
    lines = [
        *wrapped(f"{model.name}: {model.description}".rstrip(": ")),
        "",
        *wrapped(
            f"n = {model.n} coordinates, r = {model.r} constraints of rank {structure.constraint_rank}, "
            f"m = {model.m} inputs"
        ),
        *wrapped(
            f"δ_loc = {structure.local_freedom}, δ_diff = {structure.differential_freedom}, "
            f"degree of actuation {structure.degree_of_actuation}: {structure.actuation}"
        ),
    ]
    lines += _section("not needed", [f"{what}: {_set(why)}" for what, why in report.skipped])
    integrable = [f"{row.row}: {row.verdict}; {_set(row.explanation)}" for row in report.integrability]
    lines += _section("integrability", integrable)
    lines += _singular(report)
    lines += _section(
        "published equations",
        [f"{model.published[v.position].equation}: {v.verdict}. {_set(v.explanation)}" for v in report.verdicts],
    )
    printed = [name for name, form in report.forms.items() if form.matrix is not None]
    lines += _section("closed forms (name one to see it)", [", ".join(printed)])
    return "\n".join(lines)


def quantity_text(report: ReportInput, quantity: str) -> str:
    """One quantity: its closed form with intermediates, or why there is none, and what its kernel costs."""
    lines: list[str] = []
    form = report.forms.get(quantity)
    width = _width(FORMULA_TEXT)
    if form is None or form.matrix is None:
        note = form.note if form is not None else "the closed form of this quantity is not printed"
        lines += wrapped(f"{quantity}: {note}")
    else:
        lines.append(render_text_math(form.matrix, report.model, quantity, width))
        if form.intermediates:
            lines += ["", "with"]
            lines += [render_text_math(value, report.model, str(name), width) for name, value in form.intermediates]
        if form.note:
            lines += ["", *textwrap.wrap(form.note, width)]
    if (counts := report.operation_counts.get(quantity)) is not None:
        parts = ", ".join(f"{number} {kind}" for kind, number in counts.items() if number)
        lines += ["", f"kernel: {parts or 'no operations'}"]
    return "\n".join(lines)


def methods_text(quantity: str, choice: MethodChoice) -> str:
    """The methods of a quantity: which is taken, what each costs by count, and why it is valid or where it is not."""
    entries = [
        f"{', '.join((f'{name} ({weight})', *_marks(quantity, name, choice)))}: {remark}"
        for name, weight, remark in choice.others
    ]
    option = "--method" if quantity == "inverse_dynamics" else f"--method {quantity}=NAME"
    return "\n".join(_section(f"methods of {quantity} (counted cost; choose one with {option})", entries))


def _marks(quantity: str, name: str, choice: MethodChoice) -> list[str]:
    """Whether a method is taken, and what it is for where symgen does not choose it."""
    return [mark for mark in ("taken" * (name == choice.name), label(quantity, name)) if mark]


def _set(message: str) -> str:
    """A message with the formulas that it quotes."""
    return sentence_text(worded(message))


def wrapped(text: str) -> list[str]:
    """The text in lines that the terminal has room for."""
    return textwrap.wrap(text, _width(WIDEST_TEXT), break_long_words=False, break_on_hyphens=False)


def _width(elsewhere: int) -> int:
    """Characters of a line: those of the terminal, or so many where there is none."""
    return min(WIDEST_TEXT, shutil.get_terminal_size((elsewhere, 24)).columns)


def _singular(report: ReportInput) -> list[str]:
    """Sets as expressions where these are short, else as the determinants of the report."""
    context = Context(report)
    definitions, determinants = sets_by_determinants(context)
    room = _width(WIDEST_TEXT) - 4
    lines = [f"  {line}" for line in block_lines(definitions, room)]
    expressions = {one.kind: one for one in report.singular_sets}
    for kind in ORDER:
        if blocks := determinants.get(kind) or dependent_rows_lose_rank(context, kind):
            lines += [f"  {kind} singularity:", *(f"    {line}" for line in block_lines(blocks, room))]
            continue
        if kind not in expressions:
            continue
        singular = expressions[kind]
        name = f"{kind} singularity of {singular.quantity}"
        zeros = [render_text_math(zero, report.model, width=room - 2) for zero in singular.vanishing]
        if len(zeros) > 1:
            lines += _entry(f"{name}: {singular.explanation}")
            lines += [textwrap.indent(zero, " " * 6) for zero in zeros]
        elif zeros or singular.decided:
            lines += _entry(f"{name}: {f'{zeros[0]} = 0' if zeros else 'nowhere'} ({singular.explanation})")
        else:
            lines += _entry(f"{name}: {singular.explanation}.{measured_by(singular)}")
    return ["", "singular sets:", *lines] if lines else []


def _section(title: str, entries: Sequence[str]) -> list[str]:
    return ["", f"{title}:", *(line for entry in entries for line in _entry(entry))] if entries else []


def _entry(text: str) -> list[str]:
    """One entry of a section, indented, its further lines more so."""
    room = _width(WIDEST_TEXT) - 4
    return [f"  {line}" for line in textwrap.wrap(text, room, subsequent_indent="    ", break_on_hyphens=False)]
