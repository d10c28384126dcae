"""`symgen identify`: the estimates of a log, printed and written."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from symgen.generation.packages import to_install
from symgen.identification.arrays import Array
from symgen.identification.bodies.entries import BODY_DIGITS, body_entry
from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.identify import identified
from symgen.identification.estimates.parameter_file import WrittenBodies, WrittenFile, with_values
from symgen.identification.not_identified import NotIdentifiedError
from symgen.identification.reported.document import identification_document
from symgen.identification.reported.notes import contradiction
from symgen.identification.reported.record import identification_json
from symgen.identification.reported.summary import reason_lines, summary, wrapped
from symgen.model.mechanism import Mechanism
from symgen.output.write import write_files
from symgen.records import dataclass
from symgen.report.html import render_html
from symgen.report.pdf import render_pdf

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class IdentifyRequest:
    """The cut-off of the filter in Hz, or None for the usual one; whether whole bodies go into the model file."""

    cutoff: float | None = None
    whole_bodies: bool = False


def run_identify(path: Path, log: Path, out: Path, request: IdentifyRequest, quiet: bool, progress: Progress) -> int:
    """Writes identified.json, .html, .pdf and <file>.identified.yaml into OUT/<model>/; 0, or 1 where it is wrong.

    Raises ModelError for mistakes in the model file or the log.
    """
    try:
        made = identified(path, log, request.cutoff, progress)
    except NotIdentifiedError as reason:
        progress("")
        print(*reason_lines(f"{reason.place or path}: not identified: {reason}"), sep="\n", file=sys.stderr)
        return 1
    progress("drawing")
    made = made.with_whole_bodies() if request.whole_bodies else made
    written = _model_file(path, made)
    files = _files(path, made, written)
    progress("")
    paths = write_files(out / made.model.name, files)
    if not quiet:
        print(summary(made))
        if written.text is None:
            print(*wrapped(f"no model file is written: {written.why}", "  "), sep="\n")
        if written.widened:
            print(*wrapped(f"ranges widened in the file: {', '.join(written.widened)}", "  "), sep="\n")
        if "identified.pdf" not in files:
            print(*wrapped(f"the PDF is left out: {to_install(('typst',), 'it')}", "  "), sep="\n")
        print("written:", *(f"  {file}" for file in paths), "", sep="\n")
    if made.is_of_another_machine:
        print(*wrapped(f"{log}: {contradiction(made)}", ""), sep="\n", file=sys.stderr)
        return 1
    return 0


def _files(path: Path, made: Identification, written: WrittenFile) -> dict[str, str | bytes]:
    document = identification_document(made, written)
    files: dict[str, str | bytes] = {
        "identified.json": identification_json(made),
        "identified.html": render_html(document),
    }
    if find_spec("typst") is not None:
        files["identified.pdf"] = render_pdf(document)
    if written.text is not None:
        files[f"{path.stem}.identified.yaml"] = written.text
    return files


def _model_file(path: Path, made: Identification) -> WrittenFile:
    if made.is_of_another_machine:
        return WrittenFile(None, "the log contradicts the model")
    values = dict(zip(made.values.names, map(float, made.values.values), strict=True))
    bodies = made.whole if made.has_whole_bodies else None
    return with_values(path, values, None if bodies is None else _as_written(made.model.mechanism, bodies.values))


def _as_written(mechanism: Mechanism, values: Array) -> WrittenBodies:
    """All bodies with any mass or moment, and all rotors, as they stand in a file."""
    tens = {body.name: values[10 * k : 10 * k + 10] for k, body in enumerate(mechanism.bodies)}
    rotors = zip(mechanism.rotor_inertias, values[10 * len(mechanism.bodies) :], strict=True)
    return WrittenBodies(
        {name: body_entry(ten) for name, ten in tens.items() if np.any(ten)},
        {one.coordinate: f"{value:.{BODY_DIGITS}g}" for one, value in rotors},
    )
