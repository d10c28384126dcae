"""Growth of a kernel is told by name and amount; test_generated.py asks it of every kernel of every model."""

from __future__ import annotations

from kernel_growth import growth


def test_growth_names_the_kernel_and_the_amount() -> None:
    baseline = {"add": 10, "mul": 20, "div": 1, "sqrt": 0, "sincos": 2, "other": 0}
    assert growth("m: u", baseline, baseline) == []
    assert growth("m: u", baseline, {**baseline, "add": 9}) == []
    assert growth("m: u", baseline, {**baseline, "add": 14, "div": 0}) == []
    assert growth("m: u", baseline, {**baseline, "mul": 23, "add": 8}) == [
        "m: u: weighted cost 96 -> 97 (+1): add 10 -> 8 (-2), mul 20 -> 23 (+3)"
    ]
