"""No kernel costs more than derivation.json says: the counts there are the baseline, and only growth is a failure."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest
import shipped

from symgen.emit.operations import count_operations

ROOT = Path(__file__).resolve().parents[1]
Counts = Mapping[str, int]


def growth(kernel: str, baseline: Counts, counted: Counts) -> list[str]:
    """What grew, one line for each kind of operation that did, if the kernel costs more in all; [] otherwise.

    A sine and cosine pair weighs 30 products, a quotient or root 6, another function 60, as in the choice of forms.
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


@pytest.mark.parametrize("name", shipped.ALL)
def test_no_kernel_grows(name: str) -> None:
    recorded = json.loads((ROOT / "generated" / name / "derivation.json").read_text(encoding="utf-8"))["kernels"]
    found: list[str] = []
    for kernel in shipped.programs(name)["float64"].kernels:
        if kernel.name in recorded:
            counts = count_operations(kernel.statements)
            baseline = recorded[kernel.name]["operations"]
            found += growth(f"{name}: {kernel.name}", baseline, {kind: getattr(counts, kind) for kind in baseline})
    assert not found, "kernels grew beyond the counts of derivation.json:\n" + "\n".join(found)


def test_growth_names_the_kernel_and_the_amount() -> None:
    baseline = {"add": 10, "mul": 20, "div": 1, "sqrt": 0, "sincos": 2, "other": 0}
    assert growth("m: u", baseline, baseline) == []
    assert growth("m: u", baseline, {**baseline, "add": 9}) == []
    assert growth("m: u", baseline, {**baseline, "add": 14, "div": 0}) == []
    assert growth("m: u", baseline, {**baseline, "mul": 23, "add": 8}) == [
        "m: u: weighted cost 96 -> 97 (+1): add 10 -> 8 (-2), mul 20 -> 23 (+3)"
    ]
