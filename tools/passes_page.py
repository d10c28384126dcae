"""docs/passes.md: what each rewriting pass is worth, from the model files given and from drawn systems."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from symgen.diagnostics import ModelError
from symgen.laboratory.bench.tuning.passes import counted, page
from symgen.laboratory.zoo.campaign import write
from symgen.laboratory.zoo.draws.families import draw
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.quantities import MAIN

TARGET = Path(__file__).resolve().parent.parent / "docs" / "passes.md"
SEED, DRAWS = 14, 40


def main(paths: list[str]) -> None:
    """Writes the page."""
    shipped = [load_model(Path(path)) for path in paths]
    with tempfile.TemporaryDirectory() as folder:
        drawn = [counted(model, MAIN) for model in _drawn(Path(folder))]
    page_text = page([counted(model, model.outputs) for model in shipped], [one for one in drawn if one.whole])
    TARGET.write_text(page_text, encoding="utf-8")


def _drawn(folder: Path) -> Iterator[Model]:
    """Those of a campaign of the zoo that are no mistakes."""
    for place in range(DRAWS):
        path = folder / str(place) / "zoo.yaml"
        write(draw(SEED, place), path)
        try:
            yield load_model(path)
        except ModelError:
            continue


if __name__ == "__main__":
    main(sys.argv[1:])
