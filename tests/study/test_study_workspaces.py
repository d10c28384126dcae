"""Workspaces as they are published: where each leg can close, in closed form, against what a study reaches."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from studied_arm import SHIPPED, plan_of, results_of

pytestmark = pytest.mark.toolchain


def within_tori(x: np.ndarray, y: np.ndarray, z: np.ndarray, base: float, l_1: float, l_2: float) -> np.ndarray:
    """How far inside a place is of what three legs of a Delta allow (m; outside it is negative).

    The workspace is the intersection of three solid tori, as M. A. Laribi, L. Romdhane, S. Zeghloul, Analysis and
    dimensional synthesis of the DELTA robot for a prescribed workspace (2007), have it: the ball of a leg lies on a
    sphere of radius l_2 around the end of the arm, which moves on a circle of radius l_1; `base` is R - r.
    """
    margins = []
    for turn in (0.0, 2 * np.pi / 3, 4 * np.pi / 3):
        across = x * np.sin(turn) - y * np.cos(turn)
        along = x * np.cos(turn) + y * np.sin(turn) - base
        from_circle = np.hypot(along, z)
        rod = np.sqrt(np.maximum(l_2**2 - across**2, 0.0))
        margins += [l_1 + rod - from_circle, from_circle - np.abs(l_1 - rod), l_2 - np.abs(across)]
    return np.min(margins, axis=0)


def test_a_delta_reaches_what_three_tori_have_in_common(tmp_path: Path) -> None:
    over = ["x=-0.9:0.9:19", "y=-0.9:0.9:19", "z=-1.2:-0.45:16"]
    results = results_of(tmp_path / "partial", plan_of(over, "reach", SHIPPED / "delta.yaml"))
    margin = within_tori(*np.meshgrid(results.x, results.y, results.z, indexing="ij"), 0.15, 0.3, 0.8)
    reach = results.reach.values
    # next to the border the loops may be closed within their tolerance, or the border be too near to step to
    assert (reach[margin < -1e-6] == 0).all()
    assert (reach[margin > 0.005] == 1).all()
    assert 800 < reach.sum() < 3000


def test_a_five_bar_reaches_what_two_rings_have_in_common(tmp_path: Path) -> None:
    """As X.-J. Liu, J. Wang, G. Pritschow, Kinematics, singularity and workspace of planar 5R symmetrical parallel
    mechanisms (2006), have it: each leg has a ring around its drive."""
    plan = plan_of(["x=-0.5:0.5:41", "y=-0.5:0.5:41"], "reach", SHIPPED / "five_bar.yaml")
    results = results_of(tmp_path / "partial", plan)
    margins = []
    for drive in (-0.06, 0.06):
        away = np.hypot(*np.meshgrid(results.x - drive, results.y, indexing="ij"))
        margins += [0.16 + 0.22 - away, away - (0.22 - 0.16)]
    margin = np.min(margins, axis=0)
    reach = results.reach.values
    assert (reach[margin < -1e-6] == 0).all()
    # behind the drives, too
    assert (reach[margin > 0.005] == 1).all()
    assert reach[:, results.y.values < -0.1].sum() > 100
