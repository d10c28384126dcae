"""Writes docs/bench/generation.md: CPU time and memory of cold starts of `symgen`, with the goals beside them."""

from __future__ import annotations

import compileall
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
REPEATS = 3
U = ("--outputs", "inverse_dynamics")
C = ("--only", "c", "--no-verify")
# The goals were set on a machine that took this many seconds of CPU time to import SymPy.
EARLY_IMPORT = 0.44


@dataclass(frozen=True)
class Row:
    """A command and what it may take: seconds of CPU time and megabytes."""

    model: str
    options: tuple[str, ...]
    seconds: float | None
    megabytes: int


SMALL = tuple(Row(name, (*C, *U), 0.6, 100) for name in ("delta", "arm7", "chain4", "chain8", "chain16"))
ROWS = (
    *SMALL,
    *(Row(name, (*C, *U), 1.0, 100) for name in ("chain32", "gough_stewart")),
    Row("delta", ("--no-verify",), 2.0, 250),
    Row("gough_stewart", ("--no-verify",), 3.0, 250),
    Row("chain8", ("--no-verify",), 3.0, 250),
    Row("arm7", ("--no-verify", *U), 3.0, 250),
    Row("arm7", ("--no-verify", "--outputs", "all"), 10.0, 250),
    Row("chain32", ("--no-verify", *U), 10.0, 250),
    Row("gough_loops", (*C, *U), None, 100),
    Row("gough_loops", ("--no-verify",), None, 250),
    Row("chain32", ("--no-verify",), None, 250),
    Row("chain16", (), None, 250),
    Row("chain32", (), None, 250),
)


def measured(row: Row, folder: Path) -> tuple[float, float]:
    """CPU seconds of the command and all its processes, the least of three, and megabytes of the largest process."""
    model = ROOT / "models" / f"{row.model}.yaml"
    program = str(Path(sys.executable).with_name("symgen"))
    command = [program, str(model), *row.options, "--quiet", "--out", str(folder)]
    return spent(command, REPEATS if row.seconds else 1)


def spent(command: list[str], repeats: int) -> tuple[float, float]:
    """CPU seconds of a command and its processes, the least of several runs, and megabytes of the largest process."""
    seconds, megabytes = [], 0.0
    for _ in range(repeats):
        _, status, usage = os.wait4(os.posix_spawn(command[0], command, os.environ), 0)
        if status:
            raise SystemExit(f"{' '.join(command)} failed")
        seconds.append(usage.ru_utime + usage.ru_stime)
        megabytes = max(megabytes, usage.ru_maxrss / 1024)
    return min(seconds), megabytes


def lines(results: Sequence[tuple[Row, float, float]], importing: float) -> Iterator[str]:
    """The page."""
    yield "# Generation time and memory"
    yield ""
    yield "CPU time of the whole command from a cold start, in all processes it starts, the least of three (once where"
    yield "there is no goal); memory is that of the largest process.  Made by `make generation`."
    yield ""
    yield f"`import sympy` took {importing:.2f} s of CPU time beside these commands, {EARLY_IMPORT} s on the machine"
    yield "that the goals come from; the second column of times is for a machine of that speed."
    yield ""
    yield "| model | options | CPU s | scaled | goal | MB | goal |"
    yield "|---|---|---|---|---|---|---|"
    for row, seconds, megabytes in results:
        goal = "–" if row.seconds is None else f"{row.seconds:g}"
        options = f"`{' '.join(row.options)}`" if row.options else "all of it, verified"
        scaled = seconds * EARLY_IMPORT / importing
        yield f"| {row.model} | {options} | {seconds:.2f} | {scaled:.2f} | {goal} | {megabytes:.0f} | {row.megabytes} |"
    times = {row.model: seconds for row, seconds, _ in results if row.options == (*C, *U)}
    growth = log(times["chain32"] / times["chain8"]) / log(4)
    yield ""
    yield f"From 8 to 32 links the time of u grows with the power {growth:.2f} of the number of links (goal 1.3)."


def main() -> None:
    """Measures and writes."""
    # an installation has its bytecode; a checkout that forbids to write it would be compiled at every start
    compileall.compile_dir(ROOT / "symgen", quiet=1)
    with tempfile.TemporaryDirectory() as folder:
        results, imports = [], []
        for row in ROWS:
            imports.append(spent([sys.executable, "-c", "import sympy"], 1)[0])
            seconds, megabytes = measured(row, Path(folder))
            print(f"{row.model} {' '.join(row.options)}: {seconds:.2f} s, {megabytes:.0f} MB", flush=True)
            results.append((row, seconds, megabytes))
    page = "\n".join([*lines(results, median(imports)), ""])
    (ROOT / "docs" / "bench" / "generation.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
