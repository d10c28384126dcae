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
    (model,), (make_log,), (command,), (printed,) = map(page.blocks, ("yaml", "python", "sh", "text"))
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
