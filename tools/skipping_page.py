"""docs/skipping.md: what each part of the structure analysis is worth, from the model files given."""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.laboratory.bench.tuning.skipping import page, skipped
from symgen.model.load import load_model

TARGET = Path(__file__).resolve().parent.parent / "docs" / "skipping.md"


def main(paths: list[str]) -> None:
    """Writes the page from the models that have inputs."""
    models = [load_model(Path(path)) for path in paths]
    TARGET.write_text(page([skipped(model) for model in models if model.inputs]), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
