"""Composes the report of a model: sections in the order of a derivation, from the model to the published formulas."""

from __future__ import annotations

from symgen.model.model import Model
from symgen.report.content import ReportInput
from symgen.report.context import Context, sentence, text_of
from symgen.report.document import Document, Section, Text, layouts
from symgen.report.mathematics.layout import rounded
from symgen.report.mathematics.numerals import MOST_DIGITS, ROUNDED_DIGITS
from symgen.report.prose import say
from symgen.report.sections.bookkeeping import omissions, operations
from symgen.report.sections.equations import equations_of_motion
from symgen.report.sections.freedom import freedom
from symgen.report.sections.inverse import inverse_dynamics
from symgen.report.sections.projection import projection
from symgen.report.sections.proof import proof
from symgen.report.sections.published import published
from symgen.report.sections.singular import singular
from symgen.report.sections.system import system
from symgen.report.sections.targets import targets
from symgen.report.sections.verification import charts, verification

MEASURED_ELSEWHERE = (
    " What verification measures, and charts along paths, are in the PDF and, where a run has verified, in {0}.html "
    "and {0}.tex beside this file: other machines measure other numbers."
)
"""What HTML and LaTeX, whose bytes are the same everywhere, leave to files of their own."""


def compose(report_input: ReportInput) -> Document:
    """The document of a model, ready for any of the renderers."""
    context = Context(report_input)
    sections: list[Section] = [
        system(context),
        equations_of_motion(context),
        freedom(context),
        projection(context),
        inverse_dynamics(context),
        singular(context),
        omissions(context),
    ]
    if report_input.operation_counts:
        sections.append(operations(context))
    sections += [*published(context), *_measured(context)]
    model = report_input.model
    return Document(
        name=model.c_name,
        title=text_of(model.description) or model.name,
        subtitle=f"Inverse dynamics of the model {model.name}",
        summary=(*_summary(context), *_on_digits(sections)),
        sections=tuple(sections),
        colophon=f"Derived by symgen {report_input.version}. Numbers with the word paper refer to A. Müller, "
        "Motion equations in redundant "
        "coordinates with application to inverse dynamics of constrained mechanical systems."
        + ("" if report_input.verification else MEASURED_ELSEWHERE.format(measured_name(model))),
    )


def compose_measured(report_input: ReportInput) -> Document:
    """What a run measured alone, for HTML and LaTeX: the last sections of the PDF."""
    context, model = Context(report_input), report_input.model
    return Document(
        name=model.c_name,
        title=text_of(model.description) or model.name,
        subtitle=f"What a run measured of the model {model.name}",
        summary=say("The derivation is in {}.html; other machines measure other numbers.", model.c_name),
        sections=_measured(context),
        colophon=f"Measured by symgen {report_input.version}.",
    )


def measured_name(model: Model) -> str:
    """The stem of the files that have what was measured."""
    return f"{model.c_name}.measured"


def _measured(context: Context) -> tuple[Section, ...]:
    return (*verification(context), *targets(context), *proof(context), *charts(context))


def _summary(context: Context) -> Text:
    model = context.model
    source = f" Source: {sentence(text_of(model.source))}" if model.source else ""
    return say(
        "The motion equations of this system are derived in redundant coordinates, without Lagrange multipliers and "
        "without a choice of "
        "independent coordinates, {}: {}, {}, {}, {}.{}",
        "and solved for the inputs" if model.m else "in closed form where that is short",
        _counted(model.n, "coordinate"),
        _counted(model.r, "constraint"),
        _counted(context.structure.differential_freedom, "independent velocity"),
        _counted(model.m, "input"),
        source,
    )


def _on_digits(sections: list[Section]) -> Text:
    """That numbers are shown in fewer digits than they have, where some are."""
    if not any(rounded(node) for section in sections for node in layouts(section.blocks)):
        return ()
    return say(f" Numbers of more than {MOST_DIGITS} digits are shown with {ROUNDED_DIGITS}; the code has all of them.")


def _counted(count: int, noun: str) -> str:
    """1 input, 2 inputs, no inputs."""
    plural = noun.removesuffix("y") + "ies" if noun.endswith("y") else noun + "s"
    return f"{count or 'no'} {noun if count == 1 else plural}"
