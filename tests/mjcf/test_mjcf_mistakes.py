"""What is wrong with an MJCF file is told at its place in that file, and hostile files are refused at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from mjcf_files import load
from spoiled_files import check_damaged, check_group
from spoiled_mjcf import ARM, GROUPS, HEAD

EXPECTED = Path(__file__).parent / "expected"


def test_the_good_file_is_good(tmp_path: Path) -> None:
    assert load(tmp_path, ARM, HEAD).n >= 2


@pytest.mark.parametrize("group", GROUPS)
def test_mistakes_are_told_with_place_and_remedy(group: str, tmp_path: Path) -> None:
    check_group(load, GROUPS[group], EXPECTED / f"{group}.txt", tmp_path)


def test_damaged_files_are_mistakes_and_nothing_else(tmp_path: Path) -> None:
    check_damaged(load, (ARM, HEAD), tmp_path, ["body", "link", "joint", "pose", "class", "world"])
