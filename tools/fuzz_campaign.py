"""Every kernel of every model under libFuzzer and the sanitizers: FOLDER SECONDS MODEL... [--counted MODEL...].

FOLDER is from `symgen --out`.  Of models that are `counted` float32 need not stay within the tolerance of float64 at
every state however odd: mechanisms with loops lose more digits beside their singularities (docs/decisions/0021).
Two models at a time, SECONDS each; proof/<model>_fuzz.c tells what must hold.  A model that fails does not stop the
others; the exit status is 1 if one did.
"""

from __future__ import annotations

import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

WORKERS = 2
COMPILE = ["clang", "-gline-tables-only", "-O1", "-std=c99", "-ffp-contract=off", "-fno-sanitize-recover=all", "-Ic",
           "-fsanitize=fuzzer,address,undefined,float-cast-overflow"]
LENGTH = 1024  # bytes of one input


def main(folder: Path, seconds: int, names: list[str]) -> int:
    """Print one line for each model and what went wrong; 1 if something did."""
    held = names[: names.index("--counted")] if "--counted" in names else names
    models = [name for name in names if name != "--counted"]
    failed = []
    with ThreadPoolExecutor(WORKERS) as pool:
        found = pool.map(lambda model: campaign(folder / model, model, seconds, model in held), models)
        for model, (runs, told) in zip(models, found, strict=True):
            print(f"{model}: {runs} inputs" if runs else f"{model}: failed\n{told}", flush=True)
            failed += [] if runs else [model]
    if failed:
        print(f"failed: {' '.join(failed)}", file=sys.stderr)
    return int(bool(failed))


def campaign(folder: Path, model: str, seconds: int, held: bool) -> tuple[int, str]:
    """How many inputs were tried, 0 if one failed; and the end of what the tools say."""
    sources = [f"proof/{model}_fuzz.c"]
    sources += sorted(f"c/{path.name}" for path in (folder / "c").glob("*.c") if "_batch" not in path.name)
    made = run([*COMPILE, *([] if held else ["-DCOUNTED"]), *sources, "-lm", "-o", "fuzz"], folder)
    if made.returncode:
        return 0, made.stderr[-4000:]
    told = run(["./fuzz", f"-max_total_time={seconds}", f"-max_len={LENGTH}", "-print_final_stats=1"], folder)
    runs = re.search(r"number_of_executed_units: (\d+)", told.stderr)
    return (int(runs[1]) if runs and not told.returncode else 0), told.stderr[-4000:]


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """A tool in a folder of generated files."""
    return subprocess.run(command, capture_output=True, text=True, errors="replace", check=False, cwd=folder)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]))
