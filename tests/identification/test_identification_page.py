"""docs/identification.md is true: its log is made, its command identifies it, and prints what the page says."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest
from page_blocks import Page

from symgen.model.load import load_model

NUMBER = re.compile(r" +-?\d+(\.\d+)?(e[+-]?\d+)?")


@pytest.mark.campaign
def test_the_press_of_the_page(tmp_path: Path) -> None:
    page = Page("identification.md", tmp_path)
    (model, _), (make_log,), (command,), (printed, _) = map(page.blocks, ("yaml", "python", "sh", "text"))
    page.write("press.yaml", model)
    page.run(sys.executable, "-c", make_log)
    made = page.run("sh", "-ec", command.replace(" --quiet", ""))
    # the last digits of numbers are those of the processor
    assert NUMBER.sub(" #", made.stdout).strip() == NUMBER.sub(" #", printed).strip()
    record = json.loads((tmp_path / "identified/press/identified.json").read_text(encoding="utf-8"))
    shown = {one["name"]: one for one in record["file"]}
    assert abs(shown["d"]["value"] - 35) < 3 * shown["d"]["standard_error"]
    assert shown["d"]["standard_error"] < 0.35
    assert load_model(tmp_path / "identified/press/press.identified.yaml").name == "press"


@pytest.mark.campaign
def test_the_press_by_its_current(tmp_path: Path) -> None:
    """The model with the lines of the second block, and a log of the gain that the page says."""
    page = Page("identification.md", tmp_path)
    (model, changes), (make_log,), (command,), (_, printed) = map(page.blocks, ("yaml", "python", "sh", "text"))
    blocks = dict(re.findall(r"^(\w+):\n((?:  .*\n)+)", changes, re.M))
    model = model.replace("gravity:", f"{blocks['parameters']}gravity:", 1)
    model = model.replace("friction:", f"springs:\n{blocks['springs']}friction:", 1)
    model = model.replace("  motor: {joint: a, unit: N*m}\n", blocks["inputs"])
    page.write("press.yaml", model + changes.splitlines()[-1] + "\n")
    assert "`k=0.58` among the true parameters" in page.text
    page.run(sys.executable, "-c", make_log.replace("d=35)", "d=35, k=0.58)").replace("[N*m]", "[A]"))
    made = page.run("sh", "-ec", command.replace(" --quiet", ""))
    assert NUMBER.sub(" #", printed).strip("\n") in NUMBER.sub(" #", made.stdout)
    record = json.loads((tmp_path / "identified/press/identified.json").read_text(encoding="utf-8"))
    (gain,) = (one for one in record["parameters"] if one["name"] == "k")
    assert abs(gain["value"] - 0.58) < 3 * gain["standard_error"] < 0.03
