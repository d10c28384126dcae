"""Wheels that lean: the rows of their contact down to where they lie flat, and whatever frame carries them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shipped import ROOT

from symgen.dynamics.mechanics import Mechanics
from symgen.graph.evaluate import Evaluator
from symgen.model.load import load_text
from symgen.model.mechanics import default_values

DISC = (ROOT / "models" / "rolling_disc.yaml").read_text(encoding="utf-8")
TURNS = "rotation: [[z, psi], [x, beta]]}\n  disc: {parent: fork, rotation: [[y, phi]]}"


def rows(text: str, lean: float) -> np.ndarray:
    """B at some heading and spin."""
    model = load_text(text, "disc.yaml")
    B = Mechanics(model).constraint_jacobian
    values = default_values(model.parameters) | {"x": 0.1, "y": 0.2, "z": 0.3, "psi": 0.7, "beta": lean, "phi": 2.1}
    return np.array(Evaluator([entry for row in B for entry in row])(values)).reshape(3, 6)


@pytest.mark.parametrize("lean", [0.2, -1.4, 2.0, math.pi / 2 - 1e-9])
def test_rows_keep_their_digits_until_the_wheel_lies_flat(lean: float) -> None:
    """The contact moves along the heading as the wheel turns, and across it as it leans."""
    R, psi, side = 0.4, 0.7, math.copysign(1, math.cos(lean))
    along, across = np.array([math.cos(psi), math.sin(psi)]), np.array([-math.sin(psi), math.cos(psi)])
    height, *slip = rows(DISC, lean)
    assert height == pytest.approx(np.array([0, 0, 1, 0, side * R * math.sin(lean), 0]), rel=1e-14)
    expected = np.column_stack(
        [
            np.eye(2),
            np.zeros(2),
            -side * R * math.sin(lean) * along,
            side * R * math.cos(lean) * across,
            -side * R * along,
        ]
    )
    assert np.array(slip) == pytest.approx(expected, rel=1e-13, abs=1e-16)


def test_the_spin_may_hide_in_the_wheels_own_frame() -> None:
    """Lean and spin in one frame: no other frame sees the axle at rest."""
    assert TURNS in DISC
    other = DISC.replace(TURNS, "rotation: [[z, psi]]}\n  disc: {parent: fork, rotation: [[x, beta], [y, phi]]}")
    assert rows(other, 0.4) == pytest.approx(rows(DISC, 0.4), rel=1e-13, abs=1e-15)
