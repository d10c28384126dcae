"""The page docs/stress/README.md, from the JSON of stress runs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from symgen.generation.runnable import STRESSED
from symgen.model.quantities import MAIN, ROWS

SYMBOLS = {name: ROWS[name].symbol for name in STRESSED}
CAPTIONS = {
    "claim": "Error of u against the distance d to parameter singularities.",
    "methods": "Errors of u, q̈, λ and N_B against d, float64 and float32.",
    "own_methods": "symgen's methods by name, float64: error in units against d (thick: generated; dashed: allowed).",
    "families": "symgen's error in units of what rounding does (dashed: what is allowed), by kind of trouble.",
    "long_run": "Constraint drift, tracking error and energy balance over the long run.",
}
ORDER = tuple(CAPTIONS)
METHOD_NAMES = (
    *("minor", "nullspace", "elimination", "householder", "printed", "printed_fixed"),  # some not of u alone
    *("weighted", "kkt", "schur_qr", "shifted", "articulated"),
)
METHODS = (
    *("(9) fixed partition", "(27)+(28) fixed", "(27)+(28) switching", "symgen"),
    *(f"method {name}" for name in METHOD_NAMES),
)
KIND_TITLES = {
    "parameter": "near parameter singularities",
    "input": "near input singularities",
    "constraint": "near constraint singularities",
    "mass ratios": "under extreme mass ratios",
}
KINDS = tuple(KIND_TITLES)
HEAD = """# Numerical stability

Written by `make stress`. Every family of trouble was found by `symgen stress` itself: the zeros of the factored
determinants of all choices of independent coordinates and of inputs on the constraint manifold, and extremes of
angles, masses, position drift and rates. d runs from 1 to 1e-12 in float64 and to 1e-6 in float32; in the family
"large angles" it is one radian over the angle. "Near-redundant" is the model with one geometric row more, which
follows from the others on the constraint manifold and is independent of them by as much as the configuration has
drifted; "incompatible inputs" are rates and accelerations that violate the constraints by d of their size.

Errors are those of whole kernels against a reference of 50 digits. The unit of error is d + eps |y|, where this d is
how far the exact result moves when inputs, parameters and literals are rounded; 16 units are allowed. The paper's
formulas run in NumPy, in the same precision, on B, M, G, C and Q as the generated kernels compute them: (9) with the
coordinates, and (28) with the inputs, that fail where the family leads. Beside (27) and (28), N_B is (21), and λ and q̈
are (14) and (15) as corrected. Methods by name are symgen's own, compiled as the generated one is (decisions 8, 12 and
20; `--method` takes them); they answer for the states that the generated kernel accepts. "Breaks" is the largest d at
which a method is beyond the tolerance.
"""
CLAIM = """## The paper's claim

A formulation in chosen coordinates, or with a chosen partition of the inputs, loses its digits near the singularities
of the choice, where nothing happens to the mechanism. The generated kernels make no choice.
"""
RULE = """## The rule of statuses

Status 0 means within 16 units, and a status means that a measure is below its threshold: of the ranks of B and of the
inputs along the constraints, with rows of length 1, in the model's coordinates and in such as have equal inertias, or
of the mass matrix along the constraints in these. Every model is taken towards each of its singular sets in half
decades down to 1e-15, and each of its masses and lengths, and all of them at random, up to nine decades from what they
are. [Random models](random-models.md) are held against the same rule.

"""


def page(results: Sequence[str], charts: Mapping[str, Sequence[str]]) -> str:
    """The Markdown text; `results` are the texts of stress.json, `charts` the file names by model."""
    loaded = [json.loads(text) for text in results]
    parts = [HEAD, CLAIM, *_claim(charts), _overview(loaded), _rule(loaded)]
    for result in loaded:
        parts += _model(result, charts.get(result["model"], ()))
    return "\n".join(parts)


def _claim(charts: Mapping[str, Sequence[str]]) -> list[str]:
    names = [file for model in ("rapkm_2rrr_rr", *charts) for file in charts.get(model, ())]
    chosen = [file for file in names if file.endswith("claim.svg")]
    return [f"![{CAPTIONS['claim']}]({chosen[0]})\n"] if chosen else []


def _overview(results: Sequence[Mapping[str, Any]]) -> str:
    """The largest error of symgen's kernels by model and kind of trouble."""
    kinds = list(dict.fromkeys(family["kind"] for result in results for family in result["families"]))
    rows = []
    for result in results:
        cells = [f"[{result['model']}](#{result['model']})"]
        for kind in kinds:
            chosen = {i for i, family in enumerate(result["families"]) if family["kind"] == kind}
            mine = [s for s in result["series"] if s["family"] in chosen and s["form"] == "symgen"]
            worst = max(mine, key=_units, default=None)
            cells.append("" if worst is None else f"{_units(worst):.2g} {SYMBOLS[worst['quantity']]}")
        rows.append(cells)
    title = "## symgen's largest error, in units (16 are allowed), and of which quantity\n\n"
    return title + _table(["model", *kinds], rows)


def _rule(results: Sequence[Mapping[str, Any]]) -> str:
    """What was counted of the rule of statuses, of each model and scalar type."""
    rows = []
    for result in results:
        for held in result.get("rule", ()):
            counts = (held["states"], held["answered"], held["beyond"], held["states"] - held["answered"])
            rows.append([
                result["model"], SYMBOLS[held["quantity"]], held["scalar"], *map(str, counts),
                str(held["unexplained"]), f"{_finite(held['largest']):.2g}",
            ])
    if not rows:
        return ""
    head = ["model", "", "", "states", "status 0", "beyond 16 units", "statuses", "unexplained", "largest, in units"]
    return RULE + _table(head, rows)


def _model(result: Mapping[str, Any], charts: Sequence[str]) -> list[str]:
    parts = [f"## {result['model']}\n"]
    families = [f"- {family['kind']}: `{family['label']}`" for family in result["families"] if _singular(family)]
    parts.append("\n".join(["Singularities found:\n", *(families or ["- none"])]) + "\n")
    if result["partitions"]:
        choices = f"{result['failing_partitions']} of {result['partitions']} choices of independent coordinates"
        parts.append(f"Along these fail {choices}.\n")
    if result["nowhere"]:
        parts.append("\n".join(["Looked for without success:\n", *(f"- {line}" for line in result["nowhere"])]) + "\n")
    parts += [_methods(result, kind) for kind in KINDS]
    parts += [_statuses(result), _scaling(result), _runs(result)]
    for title, lines in (("Known limits:", result["limits"]), ("Wrong:", result["failures"])):
        if lines:
            parts.append("\n".join([f"{title}\n", *(f"- {line}" for line in lines)]) + "\n")
    for name in sorted(charts, key=_place):
        parts.append(f"![{CAPTIONS[name.split('.')[-2]]}]({name})\n")
    return [part for part in parts if part]


def _place(name: str) -> int:
    return ORDER.index(name.split(".")[-2])


def _singular(family: Mapping[str, Any]) -> bool:
    return family["kind"] in ("constraint", "input", "parameter")


def _methods(result: Mapping[str, Any], kind: str) -> str:
    """Errors of every method in one kind of trouble, and where it breaks; nothing where there is no such trouble."""
    chosen = {i for i, family in enumerate(result["families"]) if family["kind"] == kind}
    rows = []
    for quantity, symbol in SYMBOLS.items():
        for method in METHODS:
            cells = [symbol, method]
            for scalar in ("float64", "float32"):
                mine = [
                    s
                    for s in result["series"]
                    if s["family"] in chosen
                    and (s["quantity"], s["form"], s["scalar"]) == (quantity, method, scalar)
                ]
                errors = [relative for s in mine for _, relative, _ in s["errors"]]
                breaks = max((s["breaks"] for s in mine if s["breaks"] is not None), default=None)
                cells.append("fails" if None in errors else f"{max(errors, default=0.0):.1e}")
                cells.append("nowhere" if breaks is None else f"d ≤ {breaks:.0e}")
                if not mine:
                    break
            else:
                rows.append(cells)
    if not rows:
        return ""
    head = ["", f"method, {KIND_TITLES[kind]}", "float64", "breaks", "float32", "breaks"]
    return _table(head, rows)


def _statuses(result: Mapping[str, Any]) -> str:
    rows = [
        [SYMBOLS[s["quantity"]], s["scalar"], *(str(s[key]) for key in
         ("states", "refused", "singular", "singular_passed", "regular", "regular_refused"))]
        for s in result["statuses"]
    ]
    head = ["status of", "", "states", "refused", "singular", "of these passed", "regular", "of these refused"]
    return _table(head, rows)


def _scaling(result: Mapping[str, Any]) -> str:
    rows = []
    for change in dict.fromkeys(s["change"] for s in result["scaling"]):
        cells = [change]
        for quantity in MAIN:
            mine = [s for s in result["scaling"] if (s["change"], s["quantity"]) == (change, quantity)]
            if not mine:
                cells.append("")
            elif not all(s["covariant"] for s in mine):
                cells.append("depends on units")
            elif all(s["identical"] for s in mine):
                cells.append("same bits")
            else:
                refused = sum(s["refused"] for s in mine)
                error = f"{max(_finite(s['units']) for s in mine):.2g}"
                cells.append(f"{error}, {refused} refused" if refused else error)
        rows.append(cells)
    return _table(["other units (error in units)", *(SYMBOLS[quantity] for quantity in MAIN)], rows)


def _runs(result: Mapping[str, Any]) -> str:
    if not result["long_runs"]:
        return f"No long run: {result['no_long_run']}.\n"
    rows = []
    for run in result["long_runs"]:
        name = f"{run['path']}, {run['steps']} steps, {'with' if run['projected'] else 'without'} projections"
        columns = [run[key] for key in ("position_drift", "rate_drift", "tracking", "energy")]
        rows.append([name, *(f"{max(map(_finite, c), default=0.0):.1e}" for c in columns), run["complaint"]])
    return _table(["long run", "largest abs. g", "B q̇", "tracking error", "energy error in J", ""], rows)


def _units(series: Mapping[str, Any]) -> float:
    return max(_finite(units) for _, _, units in series["errors"])


def _finite(value: float | None) -> float:
    return float("inf") if value is None else value


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)]
    return "\n".join(lines) + "\n"
