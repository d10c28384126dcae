"""Measurements on targets reach the PDF, and only those of the same C."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

from report_inputs import report_input

from symgen.laboratory.target.footprint import KernelFootprint
from symgen.laboratory.target.record import Cell, CoreReport, KernelCost, TargetReport
from symgen.report.compose import compose
from symgen.report.html import render_html
from symgen.report.pdf import render_pdf, render_typst
from symgen.report.targets import read_targets

SOURCES = {"c/skate.c": "int x;\n", "c/skate_f.c": "int y;\n"}


def _written(folder: Path, failures: tuple[str, ...] = ()) -> Path:
    cells = (
        Cell("cortex-m4f", "gcc", "-O2", "float32", "portable", 1, 300, 0),
        Cell("cortex-m4f", "gcc", "-O2", "float32", "libm", 1, 300, 7, 2.0),
        Cell("host", "gcc", "-O1", "float32", "portable", 1, 300, 0),
    )
    costs = (
        KernelCost("inverse_dynamics", "float32", "-O2", 256, 84, 84, 16, None),
        KernelCost("inverse_dynamics", "float32", "-Os", 256, 73, 73, 12, KernelFootprint(344, 344, 0, 16, ())),
        KernelCost("forward_dynamics", "float64", "-Os", 256, 90210, 91017, 48, KernelFootprint(5088, 9120, 0, 40, ())),
    )
    digests = {Path(path).name: hashlib.sha256(text.encode()).hexdigest() for path, text in SOURCES.items()}
    report = TargetReport(
        "skate", {"regular": 256}, {}, {}, digests, cells, (CoreReport("cortex-m4f", "", costs),), failures, ()
    )
    path = folder / "target.json"
    path.write_text(json.dumps(report.to_json()))
    return path


def test_the_table_of_a_core_is_in_the_pdf_alone(tmp_path: Path) -> None:
    targets = read_targets(_written(tmp_path), SOURCES)
    (core,) = targets
    row, large = core.rows
    assert (core.name, core.same_bits) == ("cortex-m4f", 1)
    assert (row.fewest, row.most, row.code, row.stack) == (84, 84, 344, 12)
    assert (large.level, large.fewest, large.code) == ("-Os", 90210, 5088)
    measured = compose(replace(report_input("skate"), targets=targets))
    for text in ("cortex-m4f: 1 builds", "inverse_dynamics", "84", "344", "90210–91017 (-Os)"):
        assert text in render_typst(measured)
    assert render_pdf(measured)
    assert "cortex-m4f" not in render_html(compose(report_input("skate")))


def test_measurements_of_other_files_or_with_failures_are_not_shown(tmp_path: Path) -> None:
    path = _written(tmp_path)
    assert read_targets(path, SOURCES)
    assert read_targets(path, {**SOURCES, "c/skate.c": "int z;\n"}) == ()
    assert read_targets(path, {"c/skate.c": SOURCES["c/skate.c"]}) == ()
    assert read_targets(_written(tmp_path, ("wrong",)), SOURCES) == ()
    path.write_text("{")
    assert read_targets(path, SOURCES) == ()
    assert read_targets(tmp_path / "none.json", SOURCES) == ()
