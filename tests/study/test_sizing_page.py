"""The page that sizes the drives of a Delta."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
import studied_arm  # noqa: F401  skips without what a study needs
from page_blocks import DOCS, Page


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_drives_of_a_delta(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page("drive-sizing.md", tmp_path)
    model, rotors = page.blocks("yaml")
    lengths, motors = page.blocks("sh")
    (catalogue,), (shown,) = page.blocks("csv"), page.blocks("text")
    page.write("picker.yaml", model)
    page.write("motors.csv", catalogue)
    page.run("sh", "-ec", lengths)
    study = (tmp_path / "lengths/picker/study.html").read_text(encoding="utf-8")
    assert (DOCS / "picker_compromise.svg").is_file()
    (states,) = re.findall(r"<td>(\d+), of which (\d+) have a result</td>", study)
    assert (int(states[0]) - int(states[1])) // 251 == 4
    assert "<h2>Inputs against singularity</h2>" in study
    rows = re.findall(r"<tr>" + r"<td>([\d.]+)</td>" * 4 + "</tr>", study)
    sentence = r"`l_1 = (\S+)` and `l_2 = (\S+)` m are about in the\nmiddle, with (\S+) N m and (\S+)\."
    middle = re.search(sentence, page.text)
    assert middle is not None
    near = [all(_rounds(float(b), a) for a, b in zip(middle.groups(), row, strict=True)) for row in rows]
    assert near.count(True) == 1
    printed = page.run("sh", "-ec", motors).stdout
    assert shown in printed
    (least,) = re.findall(r"was ([\d.]+) N m at most for `motor_1`", page.text)
    assert re.search(rf"largest inputs motor_1 +{least} N\*m", printed)
    fits = printed.partition("motors that fit")[2]
    page.write("picker.yaml", model + rotors)
    built = page.run("sh", "-ec", motors).stdout
    (more,) = re.findall(r"is ([\d.]+) N m: ten times", page.text)
    assert re.search(rf"largest inputs motor_1 +{more} N\*m", built)
    assert built.partition("motors that fit")[2] == fits


def _rounds(value: float, shown: str) -> bool:
    """Whether a value is shown with so many digits."""
    return f"{value:.{len(shown.partition('.')[2])}f}" == shown
