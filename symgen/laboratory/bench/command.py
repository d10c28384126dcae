"""`symgen bench` for one model: measure, show, write."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from symgen.laboratory.bench.build import BuildError
from symgen.laboratory.bench.derivatives import DerivativeBenchmark, derivative_benchmark
from symgen.laboratory.bench.mechanisms import MechanismBenchmark, mechanism_benchmark
from symgen.laboratory.bench.reporting.charts import time_against_error
from symgen.laboratory.bench.reporting.derivative_pages import table_of as derivatives_table
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
    return _run_kernels(path, out, quiet, progress, "bodies", mechanism_benchmark, table_of)


def run_derivative_bench(path: Path, out: Path, quiet: bool, progress: Progress) -> int:
    """Writes bench.derivatives.json into OUT/<model>/; returns 0, or 1 where a candidate does not compile.

    Raises ModelError for mistakes in the file and WrongUseError without gcc, or where u has no derivatives.
    """
    return _run_kernels(path, out, quiet, progress, "derivatives", derivative_benchmark, derivatives_table)


def _run_kernels(
    path: Path,
    out: Path,
    quiet: bool,
    progress: Progress,
    what: str,
    measure: Callable[[Path, Progress, Path], MechanismBenchmark | DerivativeBenchmark],
    table: Callable[[Mapping[str, Any]], str],
) -> int:
    try:
        result = measure(path, progress, out).to_json()
    except BuildError as fault:
        progress("")
        print(f"{path}: {fault}", file=sys.stderr)
        return 1
    text = json.dumps(result, indent=1, ensure_ascii=False) + "\n"
    progress("")
    written = write_files(out / result["model"], {f"bench.{what}.json": text})
    if not quiet:
        print(table(result), "written:", *(f"  {file}" for file in written), "", sep="\n")
    for note in result["notes"]:
        print(f"{path}: {note}", file=sys.stderr)
    return 0
