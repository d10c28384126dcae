"""docs/identify-and-track.md is true: motion, log and parameters are made, and tracking with them is better."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from math import cos, dist, sin
from pathlib import Path

import pytest
from page_blocks import DOCS, Page

TRUTH = {"m_1": 0.6, "J_1": 0.0028, "m_2": 0.36, "J_2": 0.0034, "m_t": 0.9, "d": 0.12, "f": 0.25, "J_m": 0.0045}
ERROR = re.compile(r"error in rad +(\S+) at most")
DRAWN = re.compile(r"condition number ([\d.]+) of 13 parameters.* drawn motions ([\d.]+) at best, ([\d.]+) in", re.S)
# An optimised motion is that of the processor, and what is estimated from it differs within its errors.
LIKELY = 3.0


def printed_errors(text: str) -> list[float]:
    """Largest errors of angles, run by run."""
    return [float(x) for x in ERROR.findall(text)]


def off_at_the_tool(folder: Path) -> float:
    """How far the tool is from its planned place at most, in m."""
    with (folder / "placer/tracking.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return max(dist(place(row, ""), place(row, "_planned")) for row in rows)


def place(row: dict[str, str], which: str) -> tuple[float, float]:
    """Where it is, from the left drive on."""
    a, c = (float(row[f"{name}{which}"]) for name in ("a_1", "c_1"))
    return 0.2 * cos(a) + 0.32 * cos(a + c), 0.2 * sin(a) + 0.32 * sin(a + c)


@pytest.mark.campaign
@pytest.mark.toolchain
def test_from_a_model_to_better_tracking(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page("identify-and-track.md", tmp_path)
    (model,), (settings, *steps) = page.blocks("yaml"), page.blocks("sh")
    page.write("placer.yaml", model)
    before, excite, record, identify, after = (page.run("sh", "-ec", settings + step).stdout for step in steps)
    said_before, said_excite, said_identify, said_after = page.blocks("text")
    assert dict(pair.split("=") for pair in settings.split()[0].removeprefix("MACHINE=").split(",")) == {
        name: f"{value:g}" for name, value in TRUTH.items()
    }
    assert said_before in before
    seen, said = (DRAWN.search(text) for text in (excite, said_excite))
    assert seen is not None
    assert said is not None
    assert seen.groups()[1:] == said.groups()[1:]
    assert float(seen[1]) == pytest.approx(float(said[1]), rel=0.2)
    assert "5 s in 5001 samples" in record
    assert printed_errors(record)[0] == pytest.approx(0.05, rel=0.2)
    _estimates(tmp_path, identify, said_identify)
    with_estimates, with_truth = printed_errors(after)
    assert with_estimates == pytest.approx(*printed_errors(said_after), rel=0.2)
    assert with_estimates < printed_errors(before)[0] / 40
    assert with_estimates < 1.3 * with_truth
    _places(tmp_path, page.text)


def _estimates(folder: Path, printed: str, said: str) -> None:
    """Within their errors of the truth, as are those of the page, and what the sentences say of them."""
    record = json.loads((folder / "identified/placer/identified.json").read_text(encoding="utf-8"))
    shown = {one["name"]: one for one in record["file"]}
    assert shown.keys() == TRUTH.keys()
    for name, true in TRUTH.items():
        value, error = shown[name]["value"], shown[name]["standard_error"]
        assert abs(value - true) < LIKELY * error
        row = re.search(rf"^  {name} +(\S+) +(\S+) +(\S+)$", said, re.M)
        assert row is not None
        assert re.search(rf"^  {name} +{re.escape(row[1])} +\S+ +\S+$", printed, re.M)
        assert abs(float(row[2]) - true) < LIKELY * float(row[3])
        assert float(row[3]) == pytest.approx(error, rel=0.3)
    for name in ("d", "f"):
        assert shown[name]["standard_error"] < 0.01 * TRUTH[name]
    assert shown["m_t"]["standard_error"] == pytest.approx(0.1, rel=0.3)
    predicted = [float(x) for x in re.findall(r"^  u_\d +\S+ +\S+ +(\S+) ", printed, re.M)]
    assert len(predicted) == 2
    assert max(predicted) < 0.01
    assert "w stays as it is" in printed


def _places(folder: Path, text: str) -> None:
    """The tool in mm, as the sentences have it; each picture is one of the files that the commands write."""
    (now, then) = re.findall(r"That is (\S+) mm at the tool in place of (\S+) mm", text)[0]
    (known,) = re.findall(r"to the last digit: (\S+) mm, too", text)
    assert f"{off_at_the_tool(folder / 'before') * 1e3:.1f}" == then
    assert f"{off_at_the_tool(folder / 'known') * 1e3:.2f}" == known
    assert off_at_the_tool(folder / "after") * 1e3 == pytest.approx(float(now), rel=0.15)
    pictures = re.findall(r"\]\((placer_\w+\.svg)\)", text)
    assert len(pictures) == 4
    for name in pictures:
        assert (DOCS / name).read_text(encoding="utf-8").rstrip().endswith("</svg>")
    for made in ("before/placer/tracking.svg", "excited/placer/excitation.svg", "after/placer/tracking.svg"):
        assert (folder / made).is_file()
