"""docs/bench/mechanisms.md, from what `symgen bench --bodies` left under a folder.

`python tools/mechanisms_page.py build/bench arm7 ...` reads build/bench/<model>/bench.bodies.json, where there is one.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from symgen.laboratory.bench.reporting.mechanism_pages import page

TARGET = Path(__file__).resolve().parent.parent / "docs" / "bench" / "mechanisms.md"


def main(folder: Path, names: list[str]) -> None:
    """Writes the page from the models that have results below the folder."""
    files = {name: folder / name / "bench.bodies.json" for name in names}
    results = {name: json.loads(file.read_text(encoding="utf-8")) for name, file in files.items() if file.exists()}
    TARGET.write_text(page(results), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
