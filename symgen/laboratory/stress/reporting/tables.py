"""What the terminal shows of a stress run."""

from __future__ import annotations

import math

from symgen.generation.runnable import STRESSED
from symgen.laboratory.stress.run import Stress
from symgen.laboratory.stress.series import METHODS, SYMGEN, by_method
from symgen.model.quantities import MAIN, ROWS
from symgen.terminal import columns

# Columns count characters, of which dots over a letter are one more: q̈ is called as in C.
SHORTEST = {
    name: ROWS[name].result if name == "forward_dynamics" else ROWS[name].symbol for name in STRESSED
}
LONGEST_LABEL = 44


def stress_tables(result: Stress) -> str:
    """Tables of errors, statuses, units and the long run."""
    sizes = ", ".join(f"{'δ' if key == 'delta' else key} = {value}" for key, value in result.sizes.items())
    sections = [f"{result.model}   {sizes}   ({result.engine})", _families(result), _methods(result), _statuses(result)]
    sections += [_breaches(result), _units(result), _runs(result)]
    if result.searched.nowhere:
        sections.append("\n".join(f"  {line}" for line in ("not singular:", *result.searched.nowhere)))
    for title, lines in (("known limits:", result.limits), ("WRONG:", result.failures)):
        if lines:
            sections.append("\n".join(f"  {line}" for line in (title, *lines)))
    return "\n\n".join(section for section in sections if section) + "\n"


def _families(result: Stress) -> str:
    """The worst of symgen's kernels along each family, in units of d + eps |y*|."""
    rows = []
    for index, family in enumerate(result.families):
        cells = [family.kind, _short(family.label)]
        for scalar in ("float64", "float32"):
            mine = [s for s in result.series if s.family == index and s.scalar == scalar and s.method == SYMGEN]
            worst = max(mine, key=lambda s: s.largest.units, default=None)
            cells.append("" if worst is None else f"{worst.largest.units:.2g} {SHORTEST[worst.quantity]}")
        rows.append(cells)
    searched = result.searched
    choices = f"\n  {searched.failing} of {searched.partitions} choices of independent coordinates fail along these"
    return columns(("family", "singular where / what", "float64*", "float32*"), rows, "<<>>") + (
        "\n  * symgen's largest error in units of what rounding the inputs and the result does; 16 are allowed"
        + (choices if searched.partitions else "")
    )


def _breaches(result: Stress) -> str:
    """The kernels that break the rule of statuses, with the worst state of each; nothing where none does."""
    rows = []
    for held in result.rule:
        worst = max(held.beyond, key=lambda case: case.units, default=None)
        case = worst or next(iter(held.unexplained), None)
        if case is not None:
            counts = (held.states, held.answered, len(held.beyond), f"{held.largest:.2g}", len(held.unexplained))
            rows.append([SHORTEST[held.quantity], held.scalar, *map(str, counts), case.where])
    titles = ("the rule is broken by", "", "states", "status 0", "beyond", "units", "unexplained", "worst, first")
    return columns(titles, rows, "<<>>>>><") if rows else ""


def _methods(result: Stress) -> str:
    """Along all parameter singularities: largest relative error of each method, and where it is beyond tolerance."""
    chosen = [i for i, family in enumerate(result.families) if family.kind == "parameter"]
    rows = []
    for quantity, symbol in SHORTEST.items():
        both = [by_method(result.series, quantity, scalar, chosen) for scalar in ("float64", "float32")]
        for method in METHODS:
            if method in both[0] and method in both[1]:
                cells = [symbol, method]
                for one in (both[0][method], both[1][method]):
                    worst = max(e.relative for e in one.errors)
                    cells += [
                        f"{worst:.1e}" if math.isfinite(worst) else "fails",
                        "nowhere" if one.breaks is None else f"d ≤ {one.breaks:.1e}",
                    ]
                rows.append(cells)
    if not rows:
        return ""
    head = ("", "at parameter singularities", "float64", "breaks", "float32", "breaks")
    return columns(head, rows, "<<>>>>")


def _statuses(result: Stress) -> str:
    rows = [
        [SHORTEST[s.quantity], s.scalar, f"{s.states}", f"{s.refused}", f"{s.singular}", f"{s.singular_passed}",
         f"{s.regular}", f"{s.regular_refused}"]
        for s in result.statuses
    ]
    head = ("status", "", "states", "refused", "singular", "passed", "regular", "refused")
    return columns(head, rows, "<<>>>>>>")


def _units(result: Stress) -> str:
    rows = []
    for change in dict.fromkeys(s.change for s in result.scaled):
        cells = [change]
        for quantity in MAIN:
            mine = [s for s in result.scaled if s.change == change and s.quantity == quantity]
            if not mine:
                cells.append("")
            elif not all(s.covariant for s in mine):
                cells.append("depends on units")
            elif all(s.identical for s in mine):
                cells.append("same bits")
            else:
                cells.append(f"{max(s.units for s in mine):.2g}" + _refused(sum(s.refused for s in mine)))
        rows.append(cells)
    head = ("other units*", *(SHORTEST[quantity] for quantity in MAIN))
    return columns(head, rows, "<>>>") + "\n  * error as above, both scalar types"


def _refused(states: int) -> str:
    return f", {states} refused" if states else ""


def _runs(result: Stress) -> str:
    if not result.runs:
        return f"  no long run: {result.no_run}"
    rows = []
    for run in result.runs:
        name = f"{run.path}, {run.steps} steps{', projected' if run.projected else ''}"
        if run.complaint:
            rows.append([name, run.complaint, "", "", ""])
            continue
        values = (run.position_drift, run.rate_drift, run.tracking, run.energy)
        rows.append([name, *(f"{max(column):.1e}" for column in values)])
    return columns(("long run", "|g|", "|B qd|", "tracking", "energy"), rows, "<>>>>")


def _short(label: str) -> str:
    return label if len(label) <= LONGEST_LABEL else f"{label[: LONGEST_LABEL - 1]}…"
