"""docs/bench/derivatives.md, from what `symgen bench --derivatives` left under a folder.

`python tools/derivatives_page.py build/bench arm7 ...` reads build/bench/<model>/bench.derivatives.json, where there
is one, and prints the goals that are missed.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from symgen.laboratory.bench.reporting.derivative_pages import missed, page

TARGET = Path(__file__).resolve().parent.parent / "docs" / "bench" / "derivatives.md"


def main(folder: Path, names: list[str]) -> None:
    """Writes the page from the models that have results below the folder."""
    files = {name: folder / name / "bench.derivatives.json" for name in names}
    results = {name: json.loads(file.read_text(encoding="utf-8")) for name, file in files.items() if file.exists()}
    TARGET.write_text(page(results), encoding="utf-8")
    for line in missed(results):
        print(line)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
