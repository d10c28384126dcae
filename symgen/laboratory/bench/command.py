"""`symgen bench` for one model: measure, show, write."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from symgen.laboratory.bench.build import BuildError
from symgen.laboratory.bench.mechanisms import mechanism_benchmark
from symgen.laboratory.bench.reporting.charts import time_against_error
from symgen.laboratory.bench.reporting.mechanism_pages import table_of
from symgen.laboratory.bench.reporting.tables import bench_tables
from symgen.laboratory.bench.run import Progress, benchmark
from symgen.model.quantities import MAIN
from symgen.output.write import write_files
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.sampling.states import VerificationError

SHORT = {"inverse_dynamics": "bench.svg"}


def run_bench(path: Path, out: Path, states: int, quiet: bool, progress: Progress) -> int:
    """Writes bench.json, bench.svg (inverse dynamics), and one each of accelerations and multipliers into OUT/<model>/.

    Returns 0, or 1 where no states are found or a candidate does not compile.  Raises ModelError for mistakes in the
    file and WrongUseError without gcc.
    """
    try:
        result = benchmark(path, states, progress, out)
    except (ReferenceValueError, VerificationError, BuildError) as fault:
        progress("")
        print(f"{path}: {fault}", file=sys.stderr)
        return 1
    progress("drawing")
    files = {"bench.json": json.dumps(result.to_json(), indent=1, ensure_ascii=False) + "\n"}
    for comparison in result.comparisons:
        quantity = comparison.task.quantity
        if quantity in MAIN:
            files[SHORT.get(quantity, f"bench.{quantity}.svg")] = time_against_error(comparison)
    progress("")
    written = write_files(out / result.model, files)
    if not quiet:
        print(bench_tables(result))
        print("written:", *(f"  {file}" for file in written), "", sep="\n")
    for note in result.notes:
        print(f"{path}: {note}", file=sys.stderr)
    return 0


def run_mechanism_bench(path: Path, out: Path, quiet: bool, progress: Progress) -> int:
    """Writes bench.bodies.json into OUT/<model>/; returns 0, or 1 where a candidate does not compile.

    Raises ModelError for mistakes in the file and WrongUseError without gcc or inputs.
    """
    try:
        result = mechanism_benchmark(path, progress, out).to_json()
    except BuildError as fault:
        progress("")
        print(f"{path}: {fault}", file=sys.stderr)
        return 1
    text = json.dumps(result, indent=1, ensure_ascii=False) + "\n"
    progress("")
    written = write_files(out / result["model"], {"bench.bodies.json": text})
    if not quiet:
        print(table_of(result), "written:", *(f"  {file}" for file in written), "", sep="\n")
    for note in result["notes"]:
        print(f"{path}: {note}", file=sys.stderr)
    return 0
