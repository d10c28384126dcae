"""What a misspelt name was meant to be."""

from __future__ import annotations

import pytest

from symgen.model.expressions.names import nearest
from symgen.model.quantities import ROWS


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("inverse_dynamics_jacobain", "inverse_dynamics_jacobian"),  # not inverse_dynamics, which it begins with
        ("forward_dynamic", "forward_dynamics"),
        ("Energy", "energy"),
        ("multiplier", "multipliers"),
        ("inverse", "inverse_dynamics"),
        ("torque", ""),
    ],
)
def test_a_slip_comes_before_a_beginning(written: str, meant: str) -> None:
    assert nearest(written, sorted(ROWS)) == meant
