"""docs/constants.md: what each tuned constant of the derivation changes, over the model files given."""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.laboratory.bench.tuning.constants import measured, page
from symgen.laboratory.bench.tuning.tuned import tuned

TARGET = Path(__file__).resolve().parent.parent / "docs" / "constants.md"


def main(paths: list[str]) -> None:
    """Writes the page."""
    TARGET.write_text(page(measured(tuned(), [Path(path) for path in paths])), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
