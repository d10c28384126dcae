"""What was proved reaches the PDF, and only that about the same C."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

from report_inputs import report_input

from symgen.report.compose import compose
from symgen.report.html import render_html
from symgen.report.pdf import render_pdf, render_typst
from symgen.report.proof import read_proof

SOURCES = {"c/skate.c": "int x;\n", "c/skate_f.c": "int y;\n"}


def _written(folder: Path, **changed: object) -> Path:
    sources = {Path(path).name: hashlib.sha256(text.encode()).hexdigest() for path, text in SOURCES.items()}
    record: dict[str, object] = {
        "model": "skate", "sources": sources, "unproven": "0", "bounds": {"0": 4.75e-7, "1": 5.1e-5},
        "measured": {"0": 4.7e-7, "1": 2.2e-5}, "without": "", "denominators": [], "others": [],
    }
    path = folder / "proof.json"
    path.write_text(json.dumps(record | changed))
    return path


def test_bounds_stand_beside_measured_errors_in_the_pdf_alone(tmp_path: Path) -> None:
    facts = read_proof(_written(tmp_path), SOURCES)
    assert facts is not None
    assert facts.rounding == ((0, 4.75e-7, 4.7e-7), (1, 5.1e-5, 2.2e-5))
    document = compose(replace(report_input("skate"), proof=facts))
    for text in ("Eva: 0 alarms", "4.7e-07", "5.1e-05", "2.2e-05"):
        assert text in render_typst(document)
    assert render_pdf(document)
    assert "Eva" not in render_html(compose(report_input("skate")))


def test_what_remains_is_told(tmp_path: Path) -> None:
    path = _written(tmp_path, unproven="12", bounds={}, measured={}, without="no script", denominators=["t3", "t5"])
    text = render_typst(compose(replace(report_input("skate"), proof=read_proof(path, SOURCES))))
    assert "12 statements remain unproven" in text
    assert "do not keep 2 of the denominators" in text
    assert "What remains: " not in text
    path = _written(tmp_path, unproven="8", others=["8 × overflow, first `x = a`", "sines over several quadrants: `q`"])
    text = render_typst(compose(replace(report_input("skate"), proof=read_proof(path, SOURCES))))
    assert "What remains: 8 × overflow, first x = a; sines over several quadrants: q." in text


def test_proofs_of_other_files_are_not_shown(tmp_path: Path) -> None:
    path = _written(tmp_path)
    assert read_proof(path, {**SOURCES, "c/skate.c": "int z;\n"}) is None
    assert read_proof(path, {"c/skate.c": SOURCES["c/skate.c"]}) is None
    assert read_proof(_written(tmp_path, sources={}), SOURCES) is None
    path.write_text("{")
    assert read_proof(path, SOURCES) is None
