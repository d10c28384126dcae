"""Places without a singularity on the way: the part of the workspace around the start between curves where one lies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import binary_erosion, label
from studied_arm import SHIPPED, arm_file, plan_of, results_of
from test_study_modes import FIVE_BAR

from symgen.model.load import load_model
from symgen.study.shown.machine import task_at_start

pytestmark = pytest.mark.toolchain
FIVE_BAR_FILE = SHIPPED / "five_bar.yaml"


def parts_of(folder: Path, model: Path, over: list[str]) -> tuple[np.ndarray, np.ndarray, int]:
    """Where a way is regular by a study, and the part around the start of what has its sign and is within ranges, by
    flooding; how many places are within ranges."""
    results = results_of(folder / "partial", plan_of(over, "modes,regular,singularity", model))
    start = zip((results.x, results.y), task_at_start(load_model(model)), strict=True)
    middle = tuple(int(np.abs(axis.values - at).argmin()) for axis, at in start)
    determinant = results.choice.values[..., 0]
    same = (results.modes.values[..., 0] == 1) & (np.sign(determinant) == np.sign(determinant[middle]))
    parts, _ = label(same)
    return results.regular.values == 1, parts == parts[middle], int(results.modes.values[..., 0].sum())


@pytest.mark.campaign
def test_a_five_bar_stays_within_its_ranges(tmp_path: Path) -> None:
    regular, around, _ = parts_of(tmp_path, FIVE_BAR_FILE, ["x=-0.4:0.4:81", "y=-0.4:0.4:81"])
    assert 500 < around.sum() < 1500
    assert regular[binary_erosion(around)].all()
    assert not regular[~around].any()


def test_rods_in_line_part_a_workspace(tmp_path: Path) -> None:
    (tmp_path / "five_bar.yaml").write_text(FIVE_BAR, encoding="utf-8")
    over = ["x=-0.3:2.3:66", "y=-2.2:2.2:89"]
    regular, around, within = parts_of(tmp_path, tmp_path / "five_bar.yaml", over)
    assert 500 < around.sum() < within / 3
    assert regular[binary_erosion(around)].all()
    assert not regular[~around].any()


def test_with_more_drives_than_directions_ranges_alone_part_places(tmp_path: Path) -> None:
    plan = plan_of(["x=-1.2:1.2:25", "y=-1.2:1.2:25"], "modes,regular", arm_file())
    results = results_of(tmp_path / "partial", plan)
    assert (results.regular.values <= results.modes.values[..., 0]).all()
    assert results.regular.values.sum() > 0.9 * results.modes.values[..., 0].sum()


def test_where_nothing_moves_it_is_said_of_the_start(tmp_path: Path) -> None:
    results = results_of(tmp_path / "partial", plan_of(["J_m=1e-4:1e-3:3"], "regular", FIVE_BAR_FILE))
    assert (results.regular.values == 1).all()
