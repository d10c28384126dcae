"""No kernel costs more than derivation.json says: the counts there are the baseline, and only growth is a failure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Counts = Mapping[str, int]


def growth(kernel: str, baseline: Counts, counted: Counts) -> list[str]:
    """What grew, one line for each kind of operation that did, if the kernel costs more in all; [] otherwise.

    A sine and cosine pair weighs 30 products, a quotient or root 6, another function 60, as in the choice of methods.
    """
    weights = {"add": 1, "mul": 1, "div": 6, "sqrt": 6, "sincos": 30, "other": 60}
    before, now = (sum(weights[kind] * number for kind, number in one.items()) for one in (baseline, counted))
    if now <= before:
        return []
    kinds = [
        f"{kind} {baseline[kind]} -> {number} ({number - baseline[kind]:+d})"
        for kind, number in counted.items()
        if number != baseline[kind]
    ]
    return [f"{kernel}: weighted cost {before} -> {now} ({now - before:+d}): {', '.join(kinds)}"]


def grown(model: str, recorded: Mapping[str, Any], made: Mapping[str, Any]) -> list[str]:
    """Every kernel of a model that costs more in the derivation just `made` than in the one `recorded`."""
    both = [kernel for kernel in made["kernels"] if kernel in recorded["kernels"]]
    counts = [(k, recorded["kernels"][k]["operations"], made["kernels"][k]["operations"]) for k in both]
    return [line for k, baseline, counted in counts for line in growth(f"{model}: {k}", baseline, counted)]
