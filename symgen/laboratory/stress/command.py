"""`symgen stress` for one model: run, show, write."""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.laboratory.stress.reporting.charts import stress_charts
from symgen.laboratory.stress.reporting.tables import stress_tables
from symgen.laboratory.stress.run import Progress, json_text, stress
from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_model
from symgen.output.write import write_files
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.sampling.states import VerificationError


def run_stress(path: Path, out: Path, steps: int, quiet: bool, progress: Progress) -> int:
    """Writes stress.json and the charts into OUT/<model>/; 0, or 1 where a kernel is wrong.

    Raises ModelError for mistakes in the file.
    """
    model = without_allocation(load_model(path))
    try:
        result = stress(model, steps, progress, out)
    except (ReferenceValueError, VerificationError) as fault:
        progress("")
        print(f"{path}: {fault}", file=sys.stderr)
        return 1
    progress("drawing")
    files = {"stress.json": json_text(result.to_json()), **stress_charts(result)}
    progress("")
    written = write_files(out / model.name, files)
    if not quiet:
        print(stress_tables(result))
        print("written:", *(f"  {file}" for file in written), "", sep="\n")
    for failure in result.failures:
        print(f"{path}: {failure}", file=sys.stderr)
    return 1 if result.failures else 0
