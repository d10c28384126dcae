"""Noise of rounding is seen by second differences: along one line first, and along others where that is not quiet."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from symgen.ir.kernel import Argument, Block, Kernel, Literal, Load, Local, Statement
from symgen.verify import rounding_noise
from symgen.verify.rounding_noise import LINES, noise_in_units
from symgen.verify.tolerance import FACTOR

BIG = 2.0**20


@pytest.fixture
def looked_at(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many states the kernel is run at each time."""
    counts: list[int] = []
    run = rounding_noise.run_together

    def counted(kernel: Any, sincos: Any, scalar: Any, sets: list[Mapping[str, Any]]) -> Any:
        counts.extend(len(one["q"]) for one in sets)
        return run(kernel, sincos, scalar, sets)

    monkeypatch.setattr(rounding_noise, "run_together", counted)
    return counts


def in_small_steps() -> Kernel:
    """y = ((x + 1) + z) - 1 - z, which has few digits where x is tiny."""
    a, b = Local("a"), Local("b")
    one = Literal(Fraction(1))
    statements = (
        Statement(("s",), "add", (a, one)),
        Statement(("t",), "add", (Local("s"), b)),
        Statement(("u",), "sub", (Local("t"), one)),
        Statement(("y",), "sub", (Local("u"), b)),
    )
    loads = (Load("a", "q", 0), Load("b", "q", 1))
    return Kernel("k", (Argument("q", 2),), loads, (Block(statements, ()),), (Local("y"),), (1,))


def test_only_noisy_states_are_looked_at_along_more_lines(looked_at: list[int]) -> None:
    rows = np.array([[3.7, 0.0], [5.1, 0.0], [1.3 / BIG**2, 1.0 / 3], [1.7 / BIG**2, 1.0 / 7]])
    units = noise_in_units(in_small_steps(), None, {"q": rows, "p": np.zeros((4, 0))})
    assert units[0] < rounding_noise.NOISY > units[1]
    assert units[2] > FACTOR < units[3]
    assert looked_at == [4, 4, 4] + [2] * (2 * (LINES - 1))


def test_more_lines_show_no_less(looked_at: list[int]) -> None:
    rows = np.array([[10.0**-k, 1 / 3] for k in range(16)])
    given = {"q": rows, "p": np.zeros((16, 0))}
    short = noise_in_units(in_small_steps(), None, given, lines=1)
    looked_at.clear()
    assert (noise_in_units(in_small_steps(), None, given) >= short / 2).all()
    assert len(looked_at) == 1 + 2 * LINES
