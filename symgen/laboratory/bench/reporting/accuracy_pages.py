"""The section on errors of symgen's u in docs/bench/README.md, with the goals of the parallel robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

GOALS = {"float64": 2e-14, "float32": 1e-5}  # of the median and of 99 % of the states
HELD_TO = "rapkm_2rrr_rr"
HEAD = ("", "median", "99 %", "largest", "median, float32", "99 %, float32", "largest, float32", "beyond the tolerance")


def accuracy_section(results: Sequence[Mapping[str, Any]]) -> str:
    """Errors of what symgen generates, one line for each model; goals in brackets, bold if missed."""
    rows = [line for result in results for comparison in result["comparisons"] if (line := _line(result, comparison))]
    if not rows:
        return ""
    lines = [HEAD, ["---"] * len(HEAD), *rows]
    return (
        "## Errors of symgen's u\n\nRelative, over all states, with the portable sine and cosine; how many states of "
        f"both scalar types are beyond 16 units; in brackets the goals of {HELD_TO}, bold if missed.\n\n"
        + "".join(f"| {' | '.join(line)} |\n" for line in lines)
    )


def _line(result: Mapping[str, Any], comparison: Mapping[str, Any]) -> list[str]:
    if comparison["quantity"] != "inverse_dynamics":
        return []
    cells = [result["model"]]
    beyond: list[int] = []
    for scalar, goal in GOALS.items():
        row = _generated(comparison["measured"], scalar)
        if row is None:
            return []
        held = goal if result["model"] == HELD_TO else None
        errors = row["errors"]
        cells += [_number(errors[key], held) for key in ("median", "percentile_99")]
        cells.append(_number(errors["largest"], None))
        beyond += [] if row.get("beyond") is None else [row["beyond"]]
    return [*cells, f"{sum(beyond)} of {2 * comparison['states']}" if beyond else ""]


def _generated(measured: Sequence[Mapping[str, Any]], scalar: str) -> Mapping[str, Any] | None:
    chosen = (m for m in measured if m["chosen"] and (m["language"], m["scalar"]) == ("C", scalar))
    return next((m for m in chosen if not m["form"].endswith(", libm")), None)


def _number(value: float | None, goal: float | None) -> str:
    text = "fails" if value is None else f"{value:.1e}"
    if goal is None:
        return text
    return f"{text} ({goal:.0e})" if value is not None and value <= goal else f"**{text}** ({goal:.0e})"
