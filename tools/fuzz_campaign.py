"""Every kernel of every model under libFuzzer and the sanitizers: FOLDER SECONDS MODEL... [--sums MODEL...].

FOLDER is from `symgen --out`.  Models after `--sums` are held to the tolerance of float32 inside their ranges, and with
what one rounding of a sum of angles does (docs/decisions/0021).  As many models at a time as there are processors,
SECONDS each, always from the same seed; proof/<model>_fuzz.c tells what must hold.  A model that fails does not stop
the others; the exit status is 1 if one did.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from symgen.backends.c.endings import BATCH

COMPILE = ["clang", "-gline-tables-only", "-O1", "-std=c99", "-ffp-contract=off", "-fno-sanitize-recover=all", "-Ic",
           "-fsanitize=fuzzer,address,undefined,float-cast-overflow"]
LENGTH = 1024  # bytes of one input


def main(folder: Path, seconds: int, names: list[str]) -> int:
    """Print one line for each model and what went wrong; 1 if something did."""
    sums = names[names.index("--sums") + 1 :] if "--sums" in names else []
    models = [name for name in names if name != "--sums"]
    failed = []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda model: campaign(folder / model, model, seconds, model in sums), models)
        for model, (runs, message) in zip(models, results, strict=True):
            print(f"{model}: {runs} inputs" if runs else f"{model}: failed\n{message}", flush=True)
            failed += [] if runs else [model]
    if failed:
        print(f"failed: {' '.join(failed)}", file=sys.stderr)
    return int(bool(failed))


def campaign(folder: Path, model: str, seconds: int, sums: bool) -> tuple[int, str]:
    """How many inputs were tried, 0 if one failed; and the end of what the tools say."""
    sources = [f"proof/{model}_fuzz.c"]
    sources += sorted(f"c/{path.name}" for path in (folder / "c").glob("*.c") if BATCH not in path.name)
    made = run([*COMPILE, *(["-DSUMS"] if sums else []), *sources, "-lm", "-o", "fuzz"], folder)
    if made.returncode:
        return 0, made.stderr[-4000:]
    limits = [f"-max_total_time={seconds}", f"-max_len={LENGTH}", "-seed=1"]
    process = run(["./fuzz", *limits, "-print_final_stats=1"], folder)
    runs = re.search(r"number_of_executed_units: (\d+)", process.stderr)
    message = process.stderr.partition("== ERROR: libFuzzer")[0]  # the rule and the state, without the stack
    return (int(runs[1]) if runs and not process.returncode else 0), message[-4000:]


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """A tool in a folder of generated files."""
    return subprocess.run(command, capture_output=True, text=True, errors="replace", check=False, cwd=folder)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]))
