"""`symgen identify`: the estimates of a log, printed and written."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.identify import identified
from symgen.identification.estimates.notes import contradiction
from symgen.identification.estimates.page import identification_page
from symgen.identification.estimates.parameter_file import WrittenFile, with_values
from symgen.identification.estimates.record import identification_json
from symgen.identification.estimates.summary import reason_lines, summary, wrapped
from symgen.identification.not_identified import NotIdentifiedError
from symgen.output.write import write_files

Progress = Callable[[str], None]


def run_identify(path: Path, log: Path, out: Path, cutoff: float | None, quiet: bool, progress: Progress) -> int:
    """Writes identified.json, identified.html and <file>.identified.yaml into OUT/<model>/; 0, or 1 where it is wrong.

    Raises ModelError for mistakes in the model file or the log.
    """
    try:
        made = identified(path, log, cutoff, progress)
    except NotIdentifiedError as reason:
        progress("")
        print(*reason_lines(f"{reason.place or path}: not identified: {reason}"), sep="\n", file=sys.stderr)
        return 1
    progress("drawing")
    written = _model_file(path, made)
    files: dict[str, str | bytes] = {
        "identified.json": identification_json(made),
        "identified.html": identification_page(made, written),
    }
    if written.text is not None:
        files[f"{path.stem}.identified.yaml"] = written.text
    progress("")
    paths = write_files(out / made.model.name, files)
    if not quiet:
        print(summary(made))
        if written.text is None:
            print(*wrapped(f"no model file is written: {written.why}", "  "), sep="\n")
        if written.widened:
            print(*wrapped(f"ranges widened in the file: {', '.join(written.widened)}", "  "), sep="\n")
        print("written:", *(f"  {file}" for file in paths), "", sep="\n")
    if made.is_of_another_machine:
        print(*wrapped(f"{log}: {contradiction(made)}", ""), sep="\n", file=sys.stderr)
        return 1
    return 0


def _model_file(path: Path, made: Identification) -> WrittenFile:
    if made.is_of_another_machine:
        return WrittenFile(None, "the log contradicts the model")
    values = made.values
    return with_values(path, dict(zip(values.names, map(float, values.values), strict=True)))
