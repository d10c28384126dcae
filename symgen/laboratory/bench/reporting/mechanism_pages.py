"""The page docs/bench/mechanisms.md, from the JSON of `symgen bench --bodies`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from symgen.laboratory.bench.reporting.goals import AS_WRITTEN, Goal
from symgen.laboratory.bench.reporting.markdown import markdown_table
from symgen.laboratory.bench.reporting.mechanism_goals import (
    AS_WRITTEN_METHODS,
    CHEAPEST_WRITTEN,
    EARLY_COUNTS,
    GOALS,
    MECHANISMS,
    WRITTEN,
)
from symgen.terminal import columns

SERIAL_METHOD = "AD"  # of peers of mechanisms without loops
COLUMNS = ("", "instructions", "ns", "code", "stack", "operations", "difference")
Row = Mapping[str, Any]
Results = Mapping[str, Mapping[str, Any]]

HEAD = """# Mechanisms given by bodies

Written by `make bench-mechanisms`, measured on one machine: u in float64 as `make bench` measures it, at states that
are drawn from the ranges of the coordinates. symgen's kernels return statuses, the peers have none.

The peers walk the frames in their own scalars, as somebody writes a mechanism who knows the tool: rotation matrices and
velocities in body axes from frame to frame, energies as sums over bodies, motion equations by the tool's derivatives
along directions, never through matrices. **literal** is (27) with (28) on those, **native** the same with the matrices
G and C; **lean**, **part** and **elimination** are the methods of [the other page](README.md), **AD** is a mechanism
without loops, *in world axes* with rotation matrices multiplied up and the velocities of mass centres as the world sees
them. *from energies* starts from energies written out in world axes, which is shorter for a few mechanisms in the
plane. **recursion** is the recursive Newton-Euler algorithm of textbooks, for trees: through CasADi, and as straight
lines of C (*SSA*) in which every value is a constant of its own and no habit of a tool counts.

*As written* is what a user of CasADi writes down: native, where it is not too long to be built (16 links: literal);
without loops AD of energies in world axes. The row below it takes whichever of native, literal and AD is cheapest, for
comparison; the best peer by any method is the strongest of all.
"""


def page(results: Results) -> str:
    """The Markdown text; `results` are the contents of bench.bodies.json by model."""
    names = [name for name in MECHANISMS if name in results]
    parts = [HEAD]
    if names:
        parts += [_goals(results, names), _library(results, names), _early(results, names)]
    for name, result in results.items():
        parts.append(f"## {name}\n\n{markdown_table(COLUMNS, _rows(result))}")
        parts += [f"Not measured: {what} ({why}).\n" for what, why in _left_out(result)]
    return "\n".join(parts)


def table_of(result: Mapping[str, Any]) -> str:
    """The kernels of one mechanism for a terminal."""
    lines = [result["model"], columns(COLUMNS, _rows(result), "<" + ">" * (len(COLUMNS) - 1))]
    lines += [] if isinstance(result["pinocchio"], str) else [f"  Pinocchio: {_pinocchio(result)}"]
    lines += [f"  not measured: {what} ({why})" for what, why in _left_out(result)]
    return "\n".join(lines)


def _rows(result: Mapping[str, Any]) -> list[tuple[str, ...]]:
    return [_cells(row) for row in sorted(result["kernels"], key=counted)]


def _goals(results: Results, names: Sequence[str]) -> str:
    rows = []
    for goal in GOALS:
        cells = [ratio(results[name]["kernels"], goal, goal.ratios[MECHANISMS.index(name)]) for name in names]
        rows.append([f"{goal.against}, symgen with {goal.trig}", *cells])
    text = "## Goals\n\nInstructions of symgen's u over the peer's; in brackets the goal, bold if missed.\n\n"
    return text + markdown_table(["against", *names], rows)


def _library(results: Results, names: Sequence[str]) -> str:
    measured = [name for name in names if not isinstance(results[name]["pinocchio"], str)]
    if not measured:
        return ""
    asked = ["0.25" if SERIAL_METHOD in _methods(results[name]) else "0.08" for name in measured]
    cells = [f"{_pinocchio(results[name])} (goal {goal})" for name, goal in zip(measured, asked, strict=True)]
    return (
        "## Pinocchio\n\nTimes of symgen's u with portable sine and cosine over those of Pinocchio, in a program of "
        "its own: RNEA, and for loops the Jacobians of their points and Eigen's reflections of B^T. Its parameters are "
        "fixed when its model is built.\n\n" + markdown_table(["", *measured], [["time", *cells]])
    )


def _pinocchio(result: Mapping[str, Any]) -> str:
    time, difference = result["pinocchio"]
    mine = float(_own(result["kernels"], "portable")["nanoseconds"])
    return f"{mine / time:.2f}: {mine:.0f} / {time:.0f} ns, difference {difference:.0e}"


def _methods(result: Mapping[str, Any]) -> set[str]:
    return {row["form"] for row in result["kernels"]}


def _left_out(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    absent = [("Pinocchio", result["pinocchio"])] if isinstance(result["pinocchio"], str) else []
    return [*result["left_out"], *absent]


def ratio(rows: Sequence[Row], goal: Goal, wanted: float | None) -> str:
    """symgen's count over that of the peer that a goal is against, beside what is wanted."""
    mine, peer = _own(rows, goal.trig), _peer(rows, goal.against)
    if peer is None:
        return "none"
    quotient = counted(mine) / counted(peer)
    digits = 3 if wanted is not None and wanted < 0.1 else 2
    shown = f"{quotient:.{digits}f}"
    shown = shown if wanted is None or round(quotient, digits) <= wanted else f"**{shown}**"
    asked = "" if wanted is None else f" ({wanted})"
    return f"{shown}{asked}: {counted(mine):.0f} / {counted(peer):.0f} {peer['generator']} {peer['form']}"


def _early(results: Results, names: Sequence[str]) -> str:
    rows = []
    for against, counts in EARLY_COUNTS.items():
        cells = []
        for name in names:
            peer, count = _peer(results[name]["kernels"], against), counts[MECHANISMS.index(name)]
            if peer is None or count is None:
                cells.append("")
                continue
            libm, portable = (counted(_own(results[name]["kernels"], trig)) / count for trig in ("libm", "portable"))
            here = f"here {100 * (counted(peer) / count - 1):+.0f} %"
            cells.append(f"{count}; {here}; symgen {libm:.2f} ({portable:.2f}) of it")
        rows.append([against, *cells])
    return (
        "## The peers are no straw men\n\nInstructions of the peers as counted before the goals were set, how far the "
        "peers here are from them, and symgen's u with libm (portable) over the early count. The arm, Delta and "
        "Gough-Stewart platform of the early counts have other parameters: the platform here has its joints given by "
        "angles, whose sines the peers evaluate. The arm's strongest peers here, recursions, were not counted then, "
        "nor when its goals were set.\n\n"
        + markdown_table(["against", *names], rows)
    )


def _own(rows: Sequence[Row], trig: str) -> Row:
    return next(row for row in rows if row["generator"] == "symgen" and row["form"].endswith(f", {trig}"))


def _peer(rows: Sequence[Row], against: str) -> Row | None:
    peers = [row for row in rows if row["generator"] != "symgen"]
    if against == AS_WRITTEN:
        kinds = ([row for row in peers if row["form"] in methods] for methods in AS_WRITTEN_METHODS)
        peers = next(filter(None, kinds), [])
    elif against == CHEAPEST_WRITTEN:
        peers = [row for row in peers if row["form"] in WRITTEN]
    return min(peers, key=counted, default=None)


def counted(row: Row) -> float:
    """Instructions, or times where there is no valgrind."""
    return float(row["nanoseconds"] if row["instructions"] is None else row["instructions"])


def _cells(row: Row) -> tuple[str, ...]:
    return (
        f"{row['generator']} {row['form']}",
        "" if row["instructions"] is None else f"{row['instructions']:.0f}",
        f"{row['nanoseconds']:.0f}",
        str(row["footprint"]["code"]),
        str(row["footprint"]["stack"]),
        " ".join(f"{count} {kind}" for kind, count in (row["operations"] or {}).items()),
        f"{row['difference']:.1e}",
    )
