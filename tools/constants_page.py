"""docs/constants.md: what each tuned constant of the derivation changes, over the model files given."""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.laboratory.bench.tuning.constants import measured, page
from symgen.laboratory.bench.tuning.tuned import tuned

TARGET = Path(__file__).resolve().parent.parent / "docs" / "constants.md"


def main(paths: list[str]) -> int:
    """Writes the page; 2 where no model is named, of which it would say nothing."""
    if not paths:
        print("constants_page.py: name the model files, or run `make constants`", file=sys.stderr)
        return 2
    TARGET.write_text(page(measured(tuned(), [Path(path) for path in paths])), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
