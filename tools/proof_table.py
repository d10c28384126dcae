"""A table of what Frama-C Eva and Gappa show of the inverse dynamics in float32: FOLDER OUT MODEL...

Eva's alarms are counted, with the status that it could not prove.  Gappa's bounds of the rounding error stand beside
the errors measured at random states of the same box.  What intervals cannot keep from 0 is taken from the page of the
proof folder; where there are alarms without such a denominator, they are told by kind with the statement of the first,
and with the functions and angles of which intervals know too little.  Where u works with twice the digits Eva is not
run, and that is told: its intervals know nothing of pairs.  OUT/<model>/proof.json gets the same, for the report.  The
exit status is 1 if a tool fails.
"""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

# Operations of u; of more it is said, without trying, that they take too long.  That fails nothing.
MOST_FOR_EVA, MOST_FOR_GAPPA = 1000, 500
SECONDS = 300
WORKERS = 2
TOO_LONG, FAILED = "too long", "failed"
IN_PAIRS = "not run: twice the digits"
DENOMINATORS, ANGLES = "Denominators that intervals cannot keep from 0", "Angles that make intervals overflow"
ALARM = re.compile(r"^\[eva:alarm\] (\S+?):(\d+): Warning:\s+([\w ,-]+)\.", re.MULTILINE)
WITHOUT_BOUNDS = re.compile(r"Neither code nor specification for function (\w+)")


@dataclass(frozen=True, slots=True)
class Row:
    """What is shown of one model; `bounds` and `measured` are by entry of u, empty where there is no script."""

    model: str
    sources: dict[str, str]
    unproven: str
    bounds: dict[int, float]
    measured: dict[int, float]
    without: str
    denominators: tuple[str, ...]
    others: tuple[str, ...]


def main(folder: Path, out: Path, models: list[str]) -> int:
    """Print the table, write the files; 1 if a tool failed."""
    print("| model | Eva: unproven in u | Gappa: error of u at most | measured | what remains |")
    print("|---|---|---|---|---|", flush=True)
    broken = False
    with ThreadPoolExecutor(WORKERS) as pool:
        for row in pool.map(lambda model: examine(folder / model, model), models):
            print(line(row), flush=True)
            broken |= FAILED in (row.unproven, row.without)
            (out / row.model).mkdir(parents=True, exist_ok=True)
            text = json.dumps(asdict(row), indent=1, ensure_ascii=False) + "\n"
            (out / row.model / "proof.json").write_text(text, encoding="utf-8")
    return int(broken)


def examine(folder: Path, model: str) -> Row:
    """Everything about one model."""
    sources = {
        name: hashlib.sha256((folder / "c" / name).read_bytes()).hexdigest() for name in (f"{model}.c", f"{model}_f.c")
    }
    size, in_pairs = operations(folder), twice_the_digits(folder)
    bounds, measured, without = rounding(folder, model, size <= MOST_FOR_GAPPA)
    unproven, printed = (IN_PAIRS if in_pairs else TOO_LONG), ""
    if size <= MOST_FOR_EVA and not in_pairs:
        unproven, printed = alarms(folder, model)
    denominators = named(folder, DENOMINATORS)
    others = () if denominators else origins(printed, folder)
    return Row(model, sources, unproven, bounds, measured, without, denominators, others)


def line(row: Row) -> str:
    """A row of the table."""
    largest = ", ".join(f"{bound:.2g}" for bound in row.bounds.values()) or row.without
    measured = ", ".join(f"{row.measured[entry]:.2g}" for entry in row.bounds if entry in row.measured) or "–"
    remains = "<br>".join((*row.denominators, *row.others)) or ("none" if row.unproven == "0" else "not known")
    return f"| {row.model} | {row.unproven} | {largest} | {measured} | {remains} |"


def operations(folder: Path) -> int:
    """Of u, as they are counted when it is derived."""
    kernels = json.loads((folder / "derivation.json").read_bytes())["kernels"]
    return sum(kernels["inverse_dynamics"]["operations"].values())


def twice_the_digits(folder: Path) -> bool:
    """Whether u in float32 works with pairs of numbers, of whose rests intervals know nothing."""
    kernels = json.loads((folder / "derivation.json").read_bytes())["kernels"]
    return "float32" in kernels["inverse_dynamics"].get("twice_the_digits", ())


def alarms(folder: Path, model: str) -> tuple[str, str]:
    """The number of alarms and of statuses that are not proved, or why there is none; and all that Eva says."""
    # Frama-C looks for files from where its caller stands
    here = folder.resolve()
    command = ["frama-c", "-eva", "-eva-precision", "1", "-warn-special-float", "non-finite"]
    command += [f"-cpp-extra-args=-I{here / 'c'}", "-main", "eva_inverse_dynamics"]
    command += [str(here / "proof" / f"{model}_f_eva.c"), str(here / "c" / f"{model}_f.c")]
    printed = output(command, folder)
    counted = re.search(r"(\d+) alarms? generated", printed)
    status = re.search(r"Assertions +\d+ valid +(\d+) unknown +(\d+) invalid", printed)
    if not counted or not status:
        return (printed if printed == TOO_LONG else FAILED), ""
    return str(int(counted[1]) + int(status[1]) + int(status[2])), printed


def origins(printed: str, folder: Path) -> tuple[str, ...]:
    """Eva's alarms by kind, each with the first statement, then what they may come from; nothing without alarms."""
    kinds: dict[str, list[str]] = {}
    for file, number, kind in ALARM.findall(printed):
        statement = (folder / "c" / Path(file).name).read_text().splitlines()[int(number) - 1]
        kinds.setdefault(kind, []).append(re.sub(r"^\s*(const )?(float |double )?|;$", "", statement))
    if not kinds:
        return ()
    remarks = [f"{len(places)} × {kind}, first `{places[0]}`" for kind, places in kinds.items()]
    remarks += [f"no bounds are known of `{name}`" for name in dict.fromkeys(WITHOUT_BOUNDS.findall(printed))]
    angles = named(folder, ANGLES)
    return (*remarks, f"sines over several quadrants: {', '.join(angles)} (`range:`)") if angles else tuple(remarks)


def rounding(folder: Path, model: str, short: bool) -> tuple[dict[int, float], dict[int, float], str]:
    """Certified bounds and measured errors by entry of u, or why there are none."""
    scripts = sorted((folder / "proof").glob("*.gappa"))
    if not scripts or not short:
        return {}, {}, TOO_LONG if scripts else "no script"
    printed = output(["gappa", str(scripts[0].relative_to(folder))], folder)
    by_name = {name: float(upper) for name, upper in re.findall(r"\|(\w+) - \w+\| in .*?\{([0-9.e+-]+),", printed)}
    if not by_name:
        return {}, {}, printed if printed == TOO_LONG else FAILED
    entries = re.findall(r"^# entry (\d+) of the result: (\w+)$", scripts[0].read_text(), re.MULTILINE)
    bounds = {int(entry): by_name[name] for entry, name in entries if name in by_name}
    measured = measure(folder, model)
    if len(bounds) != len(entries) or not measured or any(measured[k] > 1.00001 * bound for k, bound in bounds.items()):
        return {}, {}, FAILED
    return bounds, measured, ""


def measure(folder: Path, model: str) -> dict[int, float]:
    """What the program beside Gappa's script measures, by entry of u; empty if it fails."""
    sources = [f"proof/{model}_f_inverse_dynamics_error.c", f"c/{model}.c", f"c/{model}_f.c"]
    made = output(["cc", "-std=c99", "-O2", "-ffp-contract=off", "-Ic", *sources, "-o", "error", "-lm"], folder)
    printed = output(["./error"], folder) if not made else ""
    return {entry: float(error) for entry, error in enumerate(printed.split())}


def named(folder: Path, heading: str) -> tuple[str, ...]:
    """What the page of the proof folder names of u under a heading."""
    page = (folder / "proof" / "README.md").read_text().partition(f"## {heading}\n")[2].partition("\n## ")[0]
    match = re.search(r"^\| inverse_dynamics\([^|]*\| (.*) \|$", page, re.MULTILINE)
    return tuple(match[1].split("<br>")) if match else ()


def output(command: list[str], folder: Path) -> str:
    """What a tool says, or that it takes too long."""
    try:
        made = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return TOO_LONG
    return made.stdout + made.stderr


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]))
