"""The page docs/bench/README.md, from the JSON of benchmark runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

from symgen.laboratory.bench.reporting.accuracy_pages import accuracy_section
from symgen.laboratory.bench.reporting.batch_pages import many_section
from symgen.laboratory.bench.reporting.goals import (
    AS_WRITTEN,
    BEST_ANY,
    BEST_VALID,
    COUNTED_EARLY,
    EARLY_COUNTS,
    FOOTPRINT_GOALS,
    FOOTPRINT_MODELS,
    GOALS,
    PAPER,
    REPRODUCED_WITHIN,
    VALID_METHODS,
    Goal,
)
from symgen.laboratory.bench.reporting.markdown import markdown_table
from symgen.laboratory.bench.reporting.quantity_pages import quantity_section

Row: TypeAlias = Mapping[str, Any]
Results: TypeAlias = Mapping[str, Sequence[Row]]  # what was measured of u, by model

HEAD = """# Run time against error

Written by `make bench`, measured on one machine; instruction counts repeat from run to run, times to a few per cent.

All C is compiled by the same gcc with `-O2 -std=c99 -ffp-contract=off -fPIC`, linked into one program and run in turns
on the same states; a time is the median of 301 passes, a count is that of valgrind's callgrind, library functions
included, and the mean over 64 states. symgen's kernels return statuses, the peers have none. Parameters are run-time
inputs for all and differ from state to state. Errors are those of whole kernels on admissible states against a
reference of 50 digits, relative to its norm; a unit is d + eps |u|, where d is how far the exact result moves when
inputs, parameters and literals are rounded.

Methods of the peers: **native** is the paper's (27) with (28) as a user writes it, with full matrices, `inv` and `@`;
**lean** applies Cholesky factors of B Bᵀ to vectors; **part** takes a basis of ker B from chosen coordinates;
**elimination** solves the passive rows for the multipliers, where M selects rows. `LDLᵀ` stands for factors without
roots, and for m = δ a direct solution. The choice of coordinates and multipliers is an expert's: the cheapest one that
stays away from singularities. All start from the energies in the model file. Times of Python are per state, all states
in one call.

CasADi exports its helper functions, so they cannot be inlined into position-independent code, which is what a loaded
library consists of; **native -fPIE** shows what inlining them is worth. **CasADi SSA** has CasADi's operations written
out as straight lines of C: no helper functions, no array of work, no null pointers.
"""


def page(results: Sequence[Mapping[str, Any]], charts: Mapping[str, Sequence[str]]) -> str:
    """The Markdown text; `results` are the contents of bench.json, `charts` the file names by model."""
    measured = _of_inverse_dynamics(results)
    parts = [HEAD]
    if _counted(measured):
        parts += [_goals(measured), _footprints(measured), _reproduced(measured)]
    parts += [quantity_section(results), accuracy_section(results), many_section(results)]
    for result in results:
        parts += _model(result, charts.get(result["model"], ()))
    return "\n".join(parts)


def deviation_lines(results: Sequence[Mapping[str, Any]]) -> list[str]:
    """The peers' counts beside the early ones, one line each; empty where not all were counted."""
    measured = _of_inverse_dynamics(results)
    if not _counted(measured):
        return []
    lines = []
    for against, cells in deviations(measured).items():
        for name, (count, here, label) in zip(PAPER, cells, strict=True):
            change = here / count - 1
            verdict = "DEARER than early" if change > REPRODUCED_WITHIN else ""
            verdict = "cheaper than early" if change < -REPRODUCED_WITHIN else verdict
            line = f"{name}: {against}: {here:.0f} ({label}), early {count:.0f}: {100 * change:+.1f} % {verdict}"
            lines.append(line.rstrip())
    return lines


def _of_inverse_dynamics(results: Sequence[Mapping[str, Any]]) -> Results:
    return {
        result["model"]: comparison["measured"]
        for result in results
        for comparison in result["comparisons"]
        if comparison["quantity"] == "inverse_dynamics"
    }


def deviations(measured: Results) -> dict[str, tuple[tuple[float, float, str], ...]]:
    """By row of the early counts, in the order of the paper's models: the early count, the one found here, by whom."""
    by_row = {}
    for against, counts in EARLY_COUNTS.items():
        cells = []
        for (count, _), name in zip(counts, PAPER, strict=True):
            best = _best(measured.get(COUNTED_EARLY.get(name, name), measured[name]), _PEERS[against])
            cells.append((float(count), float(best["instructions"]), _label(best)))
        by_row[against] = tuple(cells)
    return by_row


def _goals(measured: Results) -> str:
    rows = [[f"{goal.against}, symgen with {goal.trig}", *_ratios(goal, measured)] for goal in GOALS]
    times = [
        [f"{goal.against}, symgen with {goal.trig}", *(_time_ratio(goal, measured[name]) for name in PAPER)]
        for goal in GOALS
    ]
    text = "## Goals\n\nInstructions of symgen's u over the peer's, float64; in brackets the goal, bold if missed.\n\n"
    head = ["against", *PAPER]
    text += markdown_table(head, rows) + "\nThe same of the times:\n\n" + markdown_table(head, times)
    return text


def _ratios(goal: Goal, measured: Results) -> list[str]:
    cells = []
    for name, wanted in zip(PAPER, goal.ratios, strict=True):
        mine, peer = _own(measured[name], goal.trig), _best(measured[name], _PEERS[goal.against])
        ratio = mine["instructions"] / peer["instructions"]
        shown = f"{ratio:.2f}" if wanted is None or round(ratio, 2) <= wanted else f"**{ratio:.2f}**"
        cells.append(f"{shown} ({wanted:.2f}): {mine['instructions']:.0f} / {peer['instructions']:.0f} {_label(peer)}")
    return cells


def _time_ratio(goal: Goal, rows: Sequence[Row]) -> str:
    mine = _own(rows, goal.trig)
    peer = min(_peers(rows, _PEERS[goal.against]), key=lambda row: row["nanoseconds"])
    ratio = mine["nanoseconds"] / peer["nanoseconds"]
    return f"{ratio:.2f}: {mine['nanoseconds']:.0f} / {peer['nanoseconds']:.0f} ns {_label(peer)}"


def _footprints(measured: Results) -> str:
    rows = [
        [f"{what}, {against}, symgen with {trig}", *(_footprint(measured, name, trig, against, what) for name in PAPER)]
        for trig in ("libm", "portable")
        for against in (BEST_ANY, BEST_VALID)
        for what in ("code", "stack")
    ]
    return (
        "## Code and stack\n\nBytes of u in float64 over those of the peer with the fewest instructions; in brackets "
        "the goal, bold if missed. Code is that of all functions of a candidate, with what symgen's do to test "
        "denominators and results and to tell the causes of a failure; stack is that of their frames together. The "
        "peers test nothing. With libm nobody's sine and cosine are counted, with portable symgen's are and the "
        "peers' are not: linked statically, `sincos` of the GNU library adds 12 kB. "
        "[0019](../decisions/0019-instructions-and-bytes.md) says what the tests take.\n\n"
        + markdown_table(["", *PAPER], rows)
    )


def _footprint(measured: Results, name: str, trig: str, against: str, what: str) -> str:
    peer = _best(measured[name], _PEERS[against])
    mine, theirs = (row["footprint"][what] for row in (_own(measured[name], trig), peer))
    ratio, goal = mine / theirs, FOOTPRINT_GOALS[what]
    shown = f"{ratio:.2f}"
    if (trig, against) == ("libm", BEST_ANY) and name in FOOTPRINT_MODELS:
        shown = f"{shown} ({goal:.2f})" if round(ratio, 2) <= goal else f"**{shown}** ({goal:.2f})"
    return f"{shown}: {mine} / {theirs} {_label(peer)}"


def _reproduced(measured: Results) -> str:
    """The peers' counts beside the early ones that the goals come from."""
    rows = []
    for against, cells in deviations(measured).items():
        row = [against]
        for (count, here, label), (_, by) in zip(cells, EARLY_COUNTS[against], strict=True):
            change = here / count - 1
            shown = f"{100 * change:+.0f} %"
            shown = f"**{shown}**" if change > REPRODUCED_WITHIN else shown
            row.append(f"{count:.0f} {by}; here {here:.0f} {label}, {shown}")
        rows.append(row)
    swapped = ", ".join(f"{other} in place of {name}" for name, other in COUNTED_EARLY.items() if other in measured)
    note = f" With {swapped}, which is the mechanism of that count." if swapped else ""
    return (
        "## The peers are no straw men\n\nInstructions of u in float64 as counted before the goals were set, and "
        f"here; bold where a peer is more than {100 * REPRODUCED_WITHIN:.0f} % dearer here, a minus where it is "
        f"cheaper.{note}\n\n" + markdown_table(["", *PAPER], rows)
    )


def _model(result: Mapping[str, Any], charts: Sequence[str]) -> list[str]:
    parts = [f"## {result['model']}\n"]
    parts += [f"![Run time against error of {result['model']}]({chart})\n" for chart in charts]
    for comparison in result["comparisons"]:
        rows = [_cells(row) for row in sorted(comparison["measured"], key=_place)]
        head = ["", "", "ns", "instructions", "operations", "code", "stack", "median", "99 %", "largest", "units"]
        title = f"{comparison['quantity']}, {comparison['states']} states"
        parts.append(f"<details><summary>{title}</summary>\n\n{markdown_table(head, rows)}\n</details>\n")
        parts += [f"Not measured: {name} ({why}).\n" for name, why in comparison["left_out"].items()]
    return parts


def _cells(row: Row) -> list[str]:
    footprint, operations, errors = row["footprint"] or {}, row["operations"] or {}, row["errors"]
    label = _label(row) + (", Python" if row["language"] == "Python" and row["generator"] != "symgen" else "")
    return [
        f"**{label}**" if row["chosen"] else label,
        row["scalar"],
        f"{row['nanoseconds']:.0f}",
        "" if row["instructions"] is None else f"{row['instructions']:.0f}",
        " ".join(f"{count} {kind}" for kind, count in operations.items()),
        str(footprint.get("code", "")),
        str(footprint.get("stack", "")),
        *(_number(errors[key], ".1e") for key in ("median", "percentile_99", "largest")),
        _number(errors["largest_in_units"], ".2g"),
    ]


def _number(value: float | None, form: str) -> str:
    return "fails" if value is None else format(value, form)


def _place(row: Row) -> tuple[bool, bool, float]:
    return row["language"] != "C", row["scalar"] != "float64", row["nanoseconds"]


def _label(row: Row) -> str:
    return f"{row['generator']} {row['form']}"


_PEERS: dict[str, Callable[[Row], bool]] = {
    AS_WRITTEN: lambda row: _label(row) == "CasADi native",
    BEST_VALID: lambda row: row["form"] in VALID_METHODS,
    BEST_ANY: lambda row: bool(row["form"]),
}


def _peers(rows: Sequence[Row], chosen: Callable[[Row], bool]) -> list[Row]:
    return [r for r in rows if r["generator"] != "symgen" and _is_double_c(r) and chosen(r)]


def _best(rows: Sequence[Row], chosen: Callable[[Row], bool]) -> Row:
    return min(_peers(rows, chosen), key=lambda row: row["instructions"])


def _own(rows: Sequence[Row], trig: str) -> Row:
    return next(r for r in rows if r["chosen"] and _is_double_c(r) and r["form"].endswith(f", {trig}"))


def _is_double_c(row: Row) -> bool:
    return (row["language"], row["scalar"]) == ("C", "float64")


def _counted(measured: Results) -> bool:
    """Whether the paper's models were all measured, with valgrind."""
    rows = [row for name in PAPER for row in measured.get(name, ()) if row["language"] == "C"]
    return all(name in measured for name in PAPER) and all(row["instructions"] is not None for row in rows)
