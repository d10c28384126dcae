"""Report inputs made from shipped and hostile models, derived once per test run."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

from symgen.closedform.forms import derive_closed_forms
from symgen.closedform.laws.choice import derive_laws
from symgen.closedform.laws.singular_sets import derive_determinant_sets
from symgen.closedform.published import Verdict
from symgen.drawing.svg import drawing
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.report.compose import compose
from symgen.report.content import Chart, ErrorRow, ReportInput, Verification
from symgen.report.document import Document

HERE = Path(__file__).parent
MODELS = HERE.parent.parent / "models"
CHART = '<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0L9 9"/></svg>'


@cache
def report_input(name: str) -> ReportInput:
    """The deterministic part of the input of a model's report."""
    return input_of(load_model(HERE / "hostile.yaml" if name == "hostile" else MODELS / f"{name}.yaml"))


def input_of(model: Model) -> ReportInput:
    """The same of any model."""
    forms = derive_closed_forms(model)
    return ReportInput(
        model=model,
        version="1.2.3",
        forms=forms.forms,
        laws=derive_laws(forms),
        determinants=derive_determinant_sets(forms),
        structure=forms.structure,
        integrability=forms.integrability,
        singular_sets=forms.singular_sets,
        skipped=(("potential forces", "the potential energy is constant"), ("constraint_residual", "empty")),
        operation_counts={"mass_matrix": {"add": 2, "mul": 5, "div": 0, "sqrt": 0, "sincos": 1, "other": 0}},
        verdicts=tuple(
            Verdict(k, item.equation, "", ("identical", "misprinted")[k % 2], None, "a < b & c")
            for k, item in enumerate(model.published)
        ),
        drawing=drawing(model),
        notices=("a notice with <angle> brackets & $dollars$",),
    )


@cache
def document(name: str) -> Document:
    """The deterministic report."""
    return compose(report_input(name))


@cache
def measured_input(name: str) -> ReportInput:
    """The report with measurements and a chart, as the PDF shows it."""
    row = ErrorRow("inverse_dynamics", "C float64", 0.2, 1.7)
    verification = Verification(64, (row,), (("C float64", "N² = N", "0.1"),), (("gcc", "12.2.0"),))
    return replace(report_input(name), verification=verification, charts=(Chart("a path", CHART),))


@cache
def measured_document(name: str) -> Document:
    """The document with what a run measured in it."""
    return compose(measured_input(name))
