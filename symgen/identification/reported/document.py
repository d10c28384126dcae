"""An identification as a document, of which the page and the PDF are made."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.parameter_file import WrittenFile, numbers_in_bodies
from symgen.identification.reported.cells import numbers, table, unit_words
from symgen.identification.reported.charts import drive_chart
from symgen.identification.reported.notes import notes
from symgen.identification.reported.summary import settings_words
from symgen.identification.reported.whole_document import whole_blocks
from symgen.report.document import Block, Document, Figure, Items, Paragraph, Section, Table

_NAMES = (
    "First moments (m x) and inertias (I) are about the origin and in the axes of the frame of a body; Ir is the "
    "inertia of a rotor. Units are those of the model. Errors are standard errors, relative ones shares of the value. "
    "A t-ratio below 2 leaves open whether the value is 0."
)
_INPUTS = (
    "Behind the low-pass. Noise is what passes of it if it is white; inner forces are what drives do against each "
    "other, such as a preload: these were taken out first."
)
_FILE = (
    "Base parameters are combinations, so that many values say the same: these are the nearest to those of the file, "
    "each held by a standard deviation as large as its value."
)


def identification_document(made: Identification, written: WrittenFile) -> Document:
    """Estimates, how inputs are predicted, parameters of the file, and whole bodies."""
    model = made.model
    remarks = tuple((note,) for note in notes(made))
    summary = Section(("In short",), (Items(remarks),)) if remarks else None
    sections = [
        summary,
        Section(("What the motion shows",), (_estimates(made), Paragraph((_NAMES,)))),
        Section(("How inputs are predicted",), (_predictions(made), Paragraph((_INPUTS,)), *_charts(made))),
        Section(("Parameters of the file",), tuple(_of_the_file(made, written))),
        Section(("Whole bodies",), tuple(whole_blocks(model, made.whole))) if made.whole is not None else None,
    ]
    return Document(
        name=model.c_name,
        title=f"{model.name}, identified",
        subtitle="Parameters of the model from a log of the machine",
        summary=(settings_words(made) + ".",),
        sections=tuple(section for section in sections if section is not None),
        colophon="Made by symgen identify. All digits, settings and covariances are in identified.json.",
    )


def _estimates(made: Identification) -> Table:
    headings = ("base parameter", "value", "error", "relative", "t-ratio", "in the file", "")
    rows = []
    for one in made.parameters:
        relative = "–" if one.value != one.value or not one.value else f"{100 * one.error / abs(one.value):.2g} %"
        value, error, ratio, before = numbers(one.value, one.error, one.ratio, one.before)
        rows.append((one.name, value, error, relative, ratio, before, one.verdict))
    return table(headings, rows)


def _predictions(made: Identification) -> Table:
    headings = ("input", "rms", "left where fitted", "left where set aside", "noise", "inner forces", "")
    rows = (
        (one.name, *numbers(one.inputs, one.fitted, one.predicted, one.noise, one.inner), unit_words(one.unit))
        for one in made.drives
    )
    return table(headings, rows)


def _charts(made: Identification) -> Iterator[Figure]:
    for drive, one in enumerate(made.model.inputs):
        caption = f"{one.name}: measured and predicted, what is left over, and the spectra of both."
        yield Figure(drive_chart(made, drive), (caption,), f"drive_{drive}")


def _of_the_file(made: Identification, written: WrittenFile) -> Iterator[Block]:
    values = made.values
    if values.names:
        units = {p.name: p.unit or "" for p in made.model.parameters}
        rows = zip(values.names, values.before, values.values, values.errors, strict=True)
        cells = ((name, *numbers(*given), unit_words(units[name])) for name, *given in rows)
        headings = ("parameter", "before", "now", "standard error", "")
        yield table(headings, cells)
        off = f"Base parameters made of these values are {values.misfit:.2g} standard errors from the estimates (rms)."
        yield Paragraph((f"{_FILE} {off}",))
    for words in _written_words(made, written):
        yield Paragraph((words,))


def _written_words(made: Identification, written: WrittenFile) -> Iterator[str]:
    if written.text is None:
        yield f"No model file is written: {written.why}."
    if written.widened:
        yield f"Ranges that the estimates are beyond were widened: {', '.join(written.widened)}."
    if not made.has_whole_bodies and (given := numbers_in_bodies(made.model)):
        yield f"Numbers in the file, which stay as they are: {', '.join(given)}."
    for name, why in made.names.kept:
        yield f"{name} stays as it is: {why}."

