"""docs/stress/: the measured tables and charts of `symgen stress`, from what its runs left under a folder.

`python tools/stress_pages.py generated models/a.yaml ...` reads generated/<model>/stress.json and its charts.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from symgen.laboratory.stress.reporting.pages import page

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs" / "stress"
IN_FULL = "rapkm_2rrr_rr"  # the model whose methods are drawn quantity by quantity


def main(generated: Path, names: list[str]) -> None:
    """Writes docs/stress/README.md and its charts."""
    TARGET.mkdir(parents=True, exist_ok=True)
    for old in TARGET.glob("*.*.svg"):
        old.unlink()
    charts: dict[str, list[str]] = {}
    for name in names:
        for chart in sorted((generated / name).glob("stress*.svg")):
            kind = chart.name.removeprefix("stress").removesuffix("svg").strip(".")
            if not kind and name != IN_FULL:
                continue  # the tables of the page say as much
            target = f"{name}.{kind or 'methods'}.svg"
            shutil.copyfile(chart, TARGET / target)
            charts.setdefault(name, []).append(target)
    text = page([(generated / name / "stress.json").read_text(encoding="utf-8") for name in names], charts)
    (TARGET / "README.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(name).stem for name in sys.argv[2:]])
