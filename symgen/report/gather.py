"""Brings together what the report says: closed forms, structure, counts, verdicts; and, measured, errors and charts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace

from symgen import __version__
from symgen.closedform.forms import ClosedForm, derive_closed_forms
from symgen.closedform.frame_steps import FrameStep, frame_steps
from symgen.closedform.laws.choice import derive_laws
from symgen.closedform.laws.singular_sets import derive_determinant_sets
from symgen.closedform.published import decide_published
from symgen.drawing.svg import drawing
from symgen.model.model import Model
from symgen.report.content import Chart, ErrorRow, ReportInput, Verification
from symgen.report.facts import Facts
from symgen.report.proof import ProofFacts
from symgen.report.targets import TargetCore
from symgen.verify.certificate import Certificate


def gather(model: Model, facts: Facts) -> ReportInput:
    """Everything that is a function of the model and symgen alone."""
    counts = facts.operations
    forms = derive_closed_forms(model, {name: count.total for name, count in counts.items()})
    return ReportInput(
        model=model,
        version=__version__,
        forms=forms.forms,
        laws=derive_laws(forms),
        determinants=derive_determinant_sets(forms),
        structure=forms.structure,
        integrability=forms.integrability,
        singular_sets=forms.singular_sets,
        skipped=facts.skipped,
        operation_counts={name: asdict(count) for name, count in counts.items()},
        verdicts=decide_published(model, forms),
        notices=tuple(notice.message for notice in model.notices),
        frame_steps=_frame_steps(model, forms.forms.get("mass_matrix")),
        drawing=drawing(model),
    )


def _frame_steps(model: Model, mass: ClosedForm | None) -> tuple[FrameStep, ...]:
    """Those of bodies whose mass matrix is asked for and too long to be written out."""
    return frame_steps(model) if mass is not None and mass.matrix is None and model.mechanism.bodies else ()


def with_measurements(
    report: ReportInput,
    certificate: Certificate,
    charts: Sequence[Chart],
    targets: Sequence[TargetCore] = (),
    proof: ProofFacts | None = None,
) -> ReportInput:
    """The same report with what this run measured, and what was measured on targets and proved before."""
    errors = tuple(
        ErrorRow(
            quantity=record.quantity,
            target=record.target,
            median=record.median,
            largest=record.largest,
        )
        for record in certificate.errors
    )
    invariants = tuple((law.target, law.name, f"{law.largest:.2g}") for law in certificate.invariants)
    verification = Verification(certificate.states, errors, invariants, (*certificate.versions, *_notes(certificate)))
    return replace(report, verification=verification, charts=tuple(charts), targets=tuple(targets), proof=proof)


def _notes(certificate: Certificate) -> Sequence[tuple[str, str]]:
    return [("not verified", note) for note in certificate.notes]


CAPTIONS: Mapping[str, str] = {
    "coordinates": "Coordinates along the path {path}.",
    "determinants": "Determinants of the projected control matrix along the path {path}, for every choice of as many "
    "inputs as there are degrees of freedom; marks show where a choice fails.",
    "inputs": "Inputs along the path {path}.",
}


def path_charts(model: Model) -> tuple[Chart, ...]:
    """The charts of every path of the model; drawing is imported only where there is something to draw."""
    if not model.paths:
        return ()
    from symgen.paths.charts import charts
    from symgen.paths.figures import figure_data

    drawn = []
    for path in model.paths:
        data = figure_data(model, path)
        for name, svg in charts(model, data).items():
            drawn.append(Chart(CAPTIONS[name].format(path=path.name), svg))
    return tuple(drawn)
