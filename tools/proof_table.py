"""A table of what Frama-C Eva and Gappa show of the inverse dynamics in float32: FOLDER MODEL...

Eva's alarms are counted, with the status that it could not prove; Gappa's bounds are the largest absolute ones.  What
intervals cannot keep from 0 is taken from the page of the proof folder.  The exit status is 1 if a tool fails.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

SECONDS = 300


def main(folder: Path, models: list[str]) -> int:
    """Print the table; 1 if a tool failed."""
    rows = [(model, alarms(folder / model, model), bound(folder / model)) for model in models]
    print("| model | Eva: unproven in u | Gappa: error of u at most | denominators that remain |")
    print("|---|---|---|---|")
    for model, unproven, largest in rows:
        print(f"| {model} | {unproven} | {largest} | {remaining(folder / model)} |")
    return int(any("failed" in row for row in rows))


def alarms(folder: Path, model: str) -> str:
    """The number of alarms and of statuses that are not proved."""
    # Frama-C looks for files from where its caller stands
    here = folder.resolve()
    command = ["frama-c", "-eva", "-eva-precision", "1", "-warn-special-float", "non-finite"]
    command += [f"-cpp-extra-args=-I{here / 'c'}", "-main", "eva_inverse_dynamics"]
    command += [str(here / "proof" / f"{model}_f_eva.c"), str(here / "c" / f"{model}_f.c")]
    told = output(command, folder)
    found = re.search(r"(\d+) alarms? generated", told)
    status = re.search(r"Assertions +\d+ valid +(\d+) unknown +(\d+) invalid", told)
    if not found or not status:
        return told if told == "too long" else "failed"
    return str(int(found[1]) + int(status[1]) + int(status[2]))


def bound(folder: Path) -> str:
    """The largest certified bound, or that there is no script."""
    scripts = sorted((folder / "proof").glob("*.gappa"))
    if not scripts:
        return "no script"
    told = output(["gappa", str(scripts[0].relative_to(folder))], folder)
    bounds = [float(upper) for upper in re.findall(r"\{([0-9.e+-]+),", told)]
    return f"{max(bounds):.3g}" if bounds else told if told == "too long" else "failed"


def remaining(folder: Path) -> str:
    """The denominators of u that intervals do not keep from 0."""
    page = (folder / "proof" / "README.md").read_text()
    found = re.search(r"^\| inverse_dynamics\([^|]*\| (.*) \|$", page, re.MULTILINE)
    return found[1] if found else "none"


def output(command: list[str], folder: Path) -> str:
    """What a tool says, or that it takes too long."""
    try:
        made = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return "too long"
    return made.stdout + made.stderr


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
