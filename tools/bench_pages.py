"""docs/bench/: the measured tables and charts of `symgen bench`, from what its runs left under a folder.

`python tools/bench_pages.py generated models/a.yaml ...` reads generated/<model>/bench.json and bench.svg, and says
where a peer takes more instructions than when the goals were set.
"""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

from symgen.laboratory.bench.reporting.pages import deviation_lines, page

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs" / "bench"


def main(generated: Path, names: list[str]) -> None:
    """Writes docs/bench/README.md and its charts, and prints where a peer differs from the early counts."""
    TARGET.mkdir(parents=True, exist_ok=True)
    for old in TARGET.glob("*.svg"):
        old.unlink()
    charts: dict[str, list[str]] = {}
    for name in names:
        chart = generated / name / "bench.svg"
        if chart.exists():
            shutil.copyfile(chart, TARGET / f"{name}.svg")
            charts[name] = [f"{name}.svg"]
    results = [json.loads((generated / name / "bench.json").read_text(encoding="utf-8")) for name in names]
    (TARGET / "README.md").write_text(page(results, charts), encoding="utf-8")
    for line in deviation_lines(results):
        print(line)


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(name).stem for name in sys.argv[2:]])
