"""The page docs/bench/derivatives.md, from the JSON of `symgen bench --derivatives`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from symgen.laboratory.bench.peers.jacobian_peers import PINOCCHIO
from symgen.laboratory.bench.reporting.markdown import markdown_table
from symgen.laboratory.bench.reporting.mechanism_pages import COLUMNS, Results, Row, counted
from symgen.terminal import columns


@dataclass(frozen=True, slots=True)
class SlopeGoal:
    """symgen's instructions with the C library's sine over those of a tool's cheapest form, at most; below, if so."""

    against: str
    ratio: float
    below: bool


GOALS = (SlopeGoal("CasADi", 1.0, below=True), SlopeGoal(PINOCCHIO, 0.7, below=False))
HEAD = """# Derivatives of u

Written by `make bench-derivatives`, measured on one machine: `inverse_dynamics_jacobian`, J_u with its columns by q, q̇
and q̈ each by itself, in float64, as the [other pages](README.md) measure u: the same gcc with the same flags, counts of
valgrind's callgrind with library functions, parameters as inputs, states drawn from the ranges of the coordinates.
symgen's kernels return statuses, the peers have none. *difference* is the median of |J − J'|/|J'| against the peer that
takes least.

**CasADi** is `casadi.jacobian` of u by (q, q̇, q̈), after `cse`, in every form of u that CasADi has on
[README.md](README.md) and [mechanisms.md](mechanisms.md): as its code generator prints it, and with its operations
written out as straight lines (*SSA*). **Pinocchio** is its `computeRNEADerivatives` for arms and trees, in CasADi's
scalars and printed in both ways; its parameters are numbers when its model is built, which the other kernels take at
each call. Operations are those that a value is assigned by, a pair of sine and cosine being one of symgen's and two of
the peers', a change of sign one of each; forms of more than 30 000 are left out, but for the
shortest one. Chains of 32 links are not measured: CasADi's shortest form has too many operations to be compiled.
"""


def page(results: Results) -> str:
    """The Markdown text; `results` are the contents of bench.derivatives.json by model."""
    parts = [HEAD]
    if results:
        parts.append(_goals(results))
    for name, result in results.items():
        parts.append(f"## {name}\n\n{markdown_table(COLUMNS, _rows(result))}")
        parts += [f"Not measured: {what} ({why}).\n" for what, why in result["left_out"]]
    return "\n".join(parts)


def table_of(result: Mapping[str, Any]) -> str:
    """The kernels of one model for a terminal."""
    lines = [result["model"], columns(COLUMNS, _rows(result), "<" + ">" * (len(COLUMNS) - 1))]
    lines += [f"  not measured: {what} ({why})" for what, why in result["left_out"]]
    return "\n".join(lines)


def missed(results: Results) -> list[str]:
    """A sentence for each goal that a model misses."""
    return [
        f"{name} takes {quotient:.2f} of {goal.against}"
        for name, result in results.items()
        for goal in GOALS
        if (quotient := _quotient(result["kernels"], goal)) is not None and not _is_met(quotient, goal)
    ]


def _goals(results: Results) -> str:
    head = ["", "symgen, libm", "portable"]
    head += [f"{goal.against} ({'below' if goal.below else 'at most'} {goal.ratio})" for goal in GOALS]
    rows = []
    for name, result in results.items():
        kernels = result["kernels"]
        counts = [f"{counted(_own(kernels, trig)):.0f}" for trig in ("libm", "portable")]
        rows.append([name, *counts, *(_shown(kernels, goal) for goal in GOALS)])
    failures = missed(results)
    verdict = f"Missed: {'; '.join(failures)}." if failures else "No goal is missed."
    return (
        "## Goals\n\nInstructions of symgen's J_u, with the C library's sine and cosine and with its own; and with the "
        "library's on both sides over the cheapest form of a tool, in brackets the goal, bold if missed.\n\n"
        f"{markdown_table(head, rows)}\n{verdict}\n"
    )


def _shown(kernels: Sequence[Row], goal: SlopeGoal) -> str:
    quotient, peer = _quotient(kernels, goal), _peer(kernels, goal.against)
    if quotient is None or peer is None:
        return ""
    shown = f"{quotient:.2f}" if _is_met(quotient, goal) else f"**{quotient:.2f}**"
    return f"{shown}: {counted(peer):.0f} {peer['generator']} {peer['form']}"


def _quotient(kernels: Sequence[Row], goal: SlopeGoal) -> float | None:
    peer = _peer(kernels, goal.against)
    return None if peer is None else counted(_own(kernels, "libm")) / counted(peer)


def _is_met(quotient: float, goal: SlopeGoal) -> bool:
    return quotient < goal.ratio if goal.below else quotient <= goal.ratio


def _own(kernels: Sequence[Row], trig: str) -> Row:
    """symgen's kernel; one without angles has one form."""
    own = [row for row in kernels if row["generator"] == "symgen"]
    return next((row for row in own if row["form"].endswith(f", {trig}")), own[0])


def _peer(kernels: Sequence[Row], against: str) -> Row | None:
    return min((row for row in kernels if row["generator"].startswith(against)), key=counted, default=None)


def _rows(result: Mapping[str, Any]) -> list[tuple[str, ...]]:
    return [_cells(row) for row in sorted(result["kernels"], key=counted)]


def _cells(row: Row) -> tuple[str, ...]:
    return (
        f"{row['generator']} {row['form']}",
        "" if row["instructions"] is None else f"{row['instructions']:.0f}",
        f"{row['nanoseconds']:.0f}",
        str(row["footprint"]["code"]),
        str(row["footprint"]["stack"]),
        str(sum((row["operations"] or {}).values())),
        f"{row['difference']:.1e}",
    )

