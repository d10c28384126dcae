"""Fills the marked blocks of README.md and docs/, and makes the generated pages.

`python tools/fill_readme.py` rewrites everything; `--check` compares the deterministic parts and lists what differs.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from symgen.closedform.forms import derive_closed_forms
from symgen.closedform.published import decide_published
from symgen.model.inertial_parameters import ELEMENTS
from symgen.model.load import load_model
from symgen.model.quantities import QUANTITIES

ROOT = Path(__file__).resolve().parent.parent
PAPER_MODELS = ("skate", "front_car", "front_car_wheelset", "rear_car", "rapkm_2rrr_rr")
FILLED = ("README.md", "docs/commands.md", "docs/paper.md", "docs/verified.md")
BLOCK = re.compile(r"(<!-- begin (\w+) -->\n).*?(<!-- end \2 -->)", re.DOTALL)

WITH_MISTAKES = """\
model: cart
coordinates:
  x: {unit: m}
  phi: {unit: rad}
parameters:
  m: {value: 2, unit: kg}
  l: {value: "0,5", unit: m}
kinetic_energy: m/2*(x_dot**2 + l**2*ph_dot**2)
potential_energy: m*9.81*l*cos(phi)^1
inputs:
  F: {unit: N, acts_on: {x: 1}}
"""


def symgen(*arguments: str, folder: Path = ROOT) -> str:
    """What the command prints as its result, or else what it complains about."""
    command = [sys.executable, "-m", "symgen", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}
    result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return result.stdout or result.stderr


def example_model() -> str:
    """The car's file up to the blocks that serve the paper's tests."""
    return model_file("front_car")


def model_file(name: str) -> str:
    """A model without comments and without the blocks that serve tests."""
    text = (ROOT / f"models/{name}.yaml").read_text(encoding="utf-8")
    head = re.split(r"^(?:published|paths):", text, maxsplit=1, flags=re.MULTILINE)[0]
    lines = [line for line in head.rstrip().splitlines() if not line.startswith("#")]
    return "```yaml\n" + "\n".join(lines).strip() + "\n```\n"


def example_output() -> str:
    """A run on the car, the measured column left as this machine found it."""
    outputs = "inverse_dynamics,forward_dynamics,multipliers"
    with tempfile.TemporaryDirectory() as folder:
        text = symgen("models/front_car.yaml", "--outputs", outputs, "--out", folder)
        text = text.replace(folder, "generated")
    return f"```text\n$ symgen models/front_car.yaml --outputs {outputs}\n{text.strip()}\n```\n"


def explained() -> str:
    """Equation (43) in the terminal."""
    text = symgen("explain", "models/front_car.yaml", "nullspace_projector")
    return f"```text\n{text.strip()}\n```\n"


def mistakes() -> str:
    """A file with mistakes and the answer to it."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "cart.yaml").write_text(WITH_MISTAKES, encoding="utf-8")
        text = symgen("cart.yaml", folder=Path(folder))
    return f"```text\n{text.strip()}\n```\n"


def paper() -> str:
    """One line for each published formula: where it stands, what was found, and the proof."""
    lines = ["| equation | model | what | verdict | corrected form |", "|---|---|---|---|---|"]
    for name in PAPER_MODELS:
        model = load_model(ROOT / f"models/{name}.yaml")
        if not model.published:
            continue
        for verdict in decide_published(model, derive_closed_forms(model)):
            what = verdict.quantity.replace("_", " ") or "equations"
            proven = {None: "", True: "proven", False: "not proven"}[verdict.corrected_proven]
            lines.append(f"| {verdict.equation} | {name} | {what} | {verdict.verdict} | {proven} |")
    return "\n".join(lines) + "\n"


def measured() -> str:
    """Cold starts on this machine."""
    some = ("--outputs", "inverse_dynamics,forward_dynamics,multipliers")
    ways: tuple[tuple[str, ...], ...] = ((), ("--no-verify",), ("--no-verify", "--only", "c"))
    runs = [
        *(("front_car", way) for way in ways),
        *(("rapkm_2rrr_rr", (*some, *way)) for way in ways),
        *(("rapkm_2rrr_rr", way) for way in ways),
    ]
    lines = ["| `symgen models/…` | cold start to written files |", "|---|---|"]
    for name, options in runs:
        with tempfile.TemporaryDirectory() as folder:
            start = time.perf_counter()
            symgen(f"models/{name}.yaml", *options, "--quiet", "--out", folder)
            seconds = time.perf_counter() - start
        lines.append(f"| `{' '.join((f'{name}.yaml', *options))}` | {seconds:.1f} s |")
    return "\n".join(lines) + "\n"


def quantities() -> str:
    """docs/quantities.md."""
    lines = [
        "# Quantities",
        "",
        "Names in `outputs:`, C and Python, with the symbols and equation numbers of the paper.",
        "τ = G q̈ + C q̇ + Q − Q_a. Matrices are row-major.",
        "",
        "n coordinates, m inputs, r constraints, of these r_g geometric, δ degrees of freedom, k coordinates of a "
        "task, p points; q_m, qd_m and qdd_m are measured coordinates, rates and accelerations, x_t, xd_t and xdd_t "
        "those of a task; w_u and w_qdd are weights of u and q̈, v_x is a direction of (q, qd, qdd).",
        "",
        "| name | symbol | equation | what | arguments | shape |",
        "|---|---|---|---|---|---|",
    ]
    for q in QUANTITIES:
        shape = " × ".join(q.shape).replace("delta", "δ").replace("3*points", "3p").replace("points", "p")
        for size in ("inertial_parameters", "base_parameters"):
            shape = shape.replace(size, size.replace("_", " "))
        row = (f"`{q.name}`", q.symbol, q.equation, q.description, ", ".join(q.arguments), shape)
        lines.append(f"| {' | '.join(row)} |")
    lines += [
        "",
        f"Inertial parameters are {', '.join(ELEMENTS)} of each body in the order of the file (mass, first moments, "
        "the inertia tensor about the origin of the body's frame, in its axes), then Ir of each rotor in "
        "`rotor_inertias`. Columns of `regressor` have their names in C (`PRESS_PI_CRANK_MX`), in Python "
        "(`INERTIAL_PARAMETERS`) and in the help of each function; it is made where it is named, `all` leaves it out "
        "([base parameters](base-parameters.md#the-regressor)). Those of `base_regressor` and the entries of "
        "`base_parameters` are named in C (`PRESS_BETA_CRANK_MZ`) and in the help; these two are made where they are "
        "named, too ([its base](base-parameters.md#its-base)).",
    ]
    return "\n".join(lines) + "\n"


def picture() -> str:
    """docs/rapkm_determinants.svg: Fig. 6 of the paper."""
    from symgen.paths.charts import charts
    from symgen.paths.drawing import with_numbered_regions
    from symgen.paths.figures import figure_data

    model = load_model(ROOT / "models/rapkm_2rrr_rr.yaml")
    return with_numbered_regions(charts(model, figure_data(model, model.paths[0]))["determinants"])


DETERMINISTIC: dict[str, Callable[[], str]] = {
    "model": example_model,
    "explain": explained,
    "mistakes": mistakes,
    "paper": paper,
}
MEASURED: dict[str, Callable[[], str]] = {"output": example_output, "measured": measured}


def filled(text: str, blocks: dict[str, Callable[[], str]]) -> str:
    """A page with the given blocks made anew."""

    def replace(match: re.Match[str]) -> str:
        make = blocks.get(match[2])
        return match[0] if make is None else match[1] + make() + match[3]

    return BLOCK.sub(replace, text)


def main() -> int:
    """Rewrites, or with --check compares."""
    pages = {path: (ROOT / path).read_text(encoding="utf-8") for path in FILLED}
    if "--check" in sys.argv[1:]:
        stale = [path for path, text in pages.items() if filled(text, DETERMINISTIC) != text]
        if (ROOT / "docs/quantities.md").read_text(encoding="utf-8") != quantities():
            stale.append("docs/quantities.md")
        for name in stale:
            print(f"{name} is stale: run python tools/fill_readme.py")
        return 1 if stale else 0
    for path, text in pages.items():
        (ROOT / path).write_text(filled(text, DETERMINISTIC | MEASURED), encoding="utf-8")
    (ROOT / "docs/quantities.md").write_text(quantities(), encoding="utf-8")
    (ROOT / "docs/rapkm_determinants.svg").write_text(picture(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
