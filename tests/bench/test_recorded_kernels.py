"""A benchmark measures the kernels that verification led to."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from wide_record import recorded

from symgen.laboratory.bench.peers.roster import LACKS_A_MASS
from symgen.laboratory.bench.run import MATRICES, benchmark


@pytest.mark.bench
@pytest.mark.toolchain
def test_bench_measures_twice_the_digits_and_not_what_is_left_out(
    tmp_path: Path, tool: Callable[[str], str]
) -> None:
    tool("gcc")
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"]}, {"inverse_dynamics": ["float32"]})
    measured = benchmark(path, 8, lambda _: None, out)
    assert {one.task.quantity for one in measured.comparisons} - set(MATRICES) == {"forward_dynamics", "multipliers"}
    (one,) = (one for one in measured.comparisons if one.task.quantity == "forward_dynamics")
    chosen = [m for m in one.measured if m.chosen and m.language == "C"]
    assert {m.scalar for m in chosen} == {"float64", "float32"}
    assert all("twice the digits in float32" in m.form and m.beyond == 0 for m in chosen)
    assert {("CasADi native", LACKS_A_MASS), ("CasADi Schur", LACKS_A_MASS)} <= set(one.left_out)
    code = {m.scalar: m.footprint.code for m in chosen if m.footprint is not None and "portable" in m.form}
    assert code["float32"] > 2 * code["float64"]  # with its table and what runs it
    assert any("inverse_dynamics is left out in float32" in note for note in measured.notes)
