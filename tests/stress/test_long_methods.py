"""Forms too long for a compiler are named, not compiled."""

from __future__ import annotations

from pathlib import Path

import pytest
import shipped

from symgen.laboratory.stress import method_kernels
from symgen.verify.reference.reference import State


def test_methods_above_the_limit_are_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(method_kernels, "MOST_OPERATIONS", 48)
    kernels = method_kernels.MethodKernels(shipped.model("skate"), tmp_path, ("inverse_dynamics",))
    long = {line.split(" of ")[0] for line in kernels.left_out}
    assert "method weighted" in long
    assert all(": not run, " in line and line.endswith(" operations") for line in kernels.left_out)
    model = shipped.model("skate")
    numbers = [(0.25,) * size for size in (model.n, model.n, model.n, model.m, len(model.parameters))]
    run = {label for label, _, _ in kernels.run(State(*numbers), "float64")}
    assert long.isdisjoint(run)
    assert "method minor" in run
