"""`symgen target` for one model: measure, show, write."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from symgen.laboratory.target.cores import Core
from symgen.laboratory.target.run import measure
from symgen.laboratory.target.tables import target_tables
from symgen.laboratory.target.tools import require
from symgen.model.load import load_model
from symgen.output.write import write_files
from symgen.runtime.processes import ToolError
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.sampling.states import VerificationError

SHOWN = 20


def run_target(
    path: Path, out: Path, cores: Sequence[Core], quiet: bool, progress: Callable[[str], None]
) -> int:
    """Writes OUT/<model>/target.json; 0, or 1 where a build disagrees or a tool refuses generated code.

    Raises ModelError for mistakes in the file and WrongUseError where tools are missing.
    """
    require(cores)
    model = load_model(path)
    try:
        report = measure(model, cores, progress, out)
    except (ToolError, ReferenceValueError, VerificationError) as fault:
        progress("")
        print(f"{path}: {fault}", file=sys.stderr)
        return 1
    text = json.dumps(report.to_json(), indent=1, ensure_ascii=False) + "\n"
    progress("")
    written = write_files(out / model.name, {"target.json": text})
    if not quiet:
        print(target_tables(report))
        print("written:", *(f"  {file}" for file in written), "", sep="\n")
    for failure in report.failures[:SHOWN]:
        print(f"{path}: {failure}", file=sys.stderr)
    if len(report.failures) > SHOWN:
        print(f"{path}: {len(report.failures) - SHOWN} more in target.json", file=sys.stderr)
    return 1 if report.failures else 0
