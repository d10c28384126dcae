"""The table of all quantities: ratios to the cheapest peer, bold where missed, geometric means."""

from __future__ import annotations

from typing import Any

from symgen.laboratory.bench.peers.formulas.matrices import matrix_of
from symgen.laboratory.bench.reporting.quantity_pages import quantity_section
from symgen.laboratory.bench.run import MATRICES


def row(generator: str, form: str, instructions: int | None, **others: Any) -> dict[str, Any]:
    given = {"language": "C", "scalar": "float64", "chosen": generator == "symgen", "instructions": instructions}
    return {"generator": generator, "form": form, **given, **others}


def result(model: str, **comparisons: list[dict[str, Any]]) -> dict[str, Any]:
    return {"model": model, "comparisons": [{"quantity": q, "measured": rows} for q, rows in comparisons.items()]}


def test_the_cheapest_peer_counts() -> None:
    peers = [row("CasADi", "native", 400), row("SSA", "recursion", 100), row("CasADi", "lean", 10, scalar="float32")]
    own = [row("symgen", "minor, portable", 50), row("symgen", "minor, libm", 200)]
    dearer = [row("symgen", "kkt, libm", 20, chosen=False), row("symgen", "minor, Python", 1, language="Python")]
    no_angles = [row("symgen", "minors, portable", 25), row("CasADi SSA", "mass matrix", 100)]
    text = quantity_section(
        [result("arm", inverse_dynamics=[*own, *dearer, *peers], mass_matrix=no_angles), result("odd", multipliers=own)]
    )
    lines = text.splitlines()
    assert "|  | G | u |" in lines
    assert "| arm | 0.25 (0.25) | **2.00** (0.50) |" in lines
    assert "| geometric mean | 0.25 (0.25) | **2.00** (0.50) |" in lines
    assert lines[-1] == "All together: 0.71 (0.35)."


def test_nothing_is_shown_where_nothing_was_counted() -> None:
    uncounted = [row("symgen", "minor, portable", None), row("CasADi", "native", None)]
    assert quantity_section([result("arm", inverse_dynamics=uncounted)]) == ""


def test_every_matrix_has_a_peer() -> None:
    assert all(matrix_of(name) is not None for name in MATRICES)
    assert matrix_of("energy") is None
