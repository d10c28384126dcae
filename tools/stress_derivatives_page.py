"""docs/stress/derivatives.md and its chart: derivatives of u of a model towards its parameter singularities.

`python tools/stress_derivatives_page.py models/rapkm_2rrr_rr.yaml` takes minutes.
"""

from __future__ import annotations

import sys
from pathlib import Path

from symgen.laboratory.slopes.errors import derivative_errors
from symgen.laboratory.slopes.page import derivatives_page
from symgen.laboratory.stress.families import search
from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_model
from symgen.verify.reference.reference import Reference

TARGET = Path(__file__).resolve().parent.parent / "docs" / "stress"


def main(file: Path) -> None:
    """Writes the page from the families in which a choice of coordinates fails together with one of inputs."""
    model = without_allocation(load_model(file))
    reference = Reference(model)
    families = [one for one in search(reference).families if one.kind == "parameter" and one.partitions and one.inputs]
    results = {family.label: derivative_errors(model, reference, family) for family in families}
    text, chart = derivatives_page(model.name, results)
    (TARGET / "derivatives.md").write_text(text, encoding="utf-8")
    (TARGET / "derivatives.svg").write_text(chart, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
