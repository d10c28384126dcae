"""What `symgen explain` prints: the structure of a system, and its closed forms as plain text."""

from __future__ import annotations

import shutil
import textwrap

from symgen.methods.selection import MethodChoice
from symgen.methods.table import label
from symgen.report.content import ReportInput
from symgen.report.terminal import render_text_math

# Characters of a line at most, in however wide a terminal.
WIDEST_TEXT = 120


def overview(report: ReportInput) -> str:
    """Sizes, freedom, actuation, what is skipped, singular sets, integrability, published formulas, closed forms."""
    model, structure = report.model, report.structure
    lines = [
        f"{model.name}: {model.description}".rstrip(": "),
        "",
        f"n = {model.n} coordinates, r = {model.r} constraints of rank {structure.constraint_rank}, "
        f"m = {model.m} inputs",
        f"δ_loc = {structure.local_freedom}, δ_diff = {structure.differential_freedom}, "
        f"degree of actuation {structure.degree_of_actuation}: {structure.actuation}",
    ]
    lines += _section("not needed", [f"{what}: {why}" for what, why in report.skipped])
    lines += _section("integrability", [f"{row.row}: {row.verdict}; {row.explanation}" for row in report.integrability])
    lines += _section("singular sets", _singular(report))
    lines += _section(
        "published equations",
        [f"{model.published[v.position].equation}: {v.verdict}. {v.explanation}" for v in report.verdicts],
    )
    printed = [name for name, form in report.forms.items() if form.matrix is not None]
    lines += _section("closed forms (name one to see it)", [", ".join(printed)])
    return "\n".join(lines)


def quantity_text(report: ReportInput, quantity: str) -> str:
    """One quantity: its closed form with intermediates, or why there is none, and what its kernel costs."""
    lines: list[str] = []
    form = report.forms.get(quantity)
    width = min(WIDEST_TEXT, shutil.get_terminal_size((100, 24)).columns)
    if form is None or form.matrix is None:
        note = form.note if form is not None else "the closed form of this quantity is not printed"
        lines.append(f"{quantity}: {note}")
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


def _singular(report: ReportInput) -> list[str]:
    lines = []
    for singular in report.singular_sets:
        where = ", ".join(render_text_math(zero, report.model) for zero in singular.vanishing)
        place = f"{where} = 0" if where else "nowhere" if singular.decided else "not worked out"
        lines.append(f"{singular.kind} singularity of {singular.quantity}: {place} ({singular.explanation})")
    return lines


def _section(title: str, entries: list[str]) -> list[str]:
    if not entries:
        return []
    wrapped = [line for entry in entries for line in textwrap.wrap(entry, WIDEST_TEXT - 4, subsequent_indent="    ")]
    return ["", f"{title}:", *(f"  {line}" for line in wrapped)]
