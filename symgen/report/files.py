"""The files of a report: HTML and LaTeX from the model alone, the PDF, and what a run measured as HTML and LaTeX."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from symgen.closedform.algebra.limits import TooLargeError
from symgen.diagnostics import Notice
from symgen.model.model import Model
from symgen.report.compose import compose, compose_measured, measured_name
from symgen.report.facts import Facts, ReportFiles
from symgen.report.gather import gather, path_charts, with_measurements
from symgen.report.html import render_html
from symgen.report.latex import drawing_file, render_latex, render_latex_sections
from symgen.report.pdf import render_drawing, render_pdf
from symgen.report.proof import ProofFacts
from symgen.report.targets import TargetCore
from symgen.verify.certificate import Certificate


def report_files(model: Model, receive: Callable[[], Any], measured: bool) -> ReportFiles:
    """The files; receives the `Facts` of the derivation, then the certificate or None where nothing was measured,
    then what was measured on targets, then what was proved.

    Charts are drawn while the measurement goes on, if there is one (`measured`).
    """
    facts: Facts = receive()
    try:
        report = gather(model, facts)
    except TooLargeError as large:
        return ReportFiles({}, (Notice(f"closed forms and report are left out: {large}"),))
    notices = tuple(
        Notice(f"the non-holonomic row {row.row} is integrable: {row.explanation}")
        for row in report.integrability
        if row.verdict == "integrable"
    )
    document, stem = compose(report), model.c_name
    files: dict[str, str | bytes] = {
        f"report/{stem}.html": render_html(document),
        f"report/{stem}.tex": render_latex(document),
    }
    if not measured:
        return ReportFiles(files, notices)
    from symgen.paths.path_equations import PathError  # with NumPy

    try:
        charts = path_charts(model)
    except PathError as error:
        return ReportFiles(files, notices, (error.mistake,))
    certificate: Certificate | None = receive()
    targets: tuple[TargetCore, ...] = receive()
    proof: ProofFacts | None = receive()
    if certificate is None:
        return ReportFiles(files, notices)
    report = with_measurements(report, certificate, charts, targets, proof)
    measurements, beside = compose_measured(report), measured_name(model)
    files |= {
        f"report/{beside}.html": render_html(measurements),
        f"report/{beside}.tex": render_latex_sections(measurements),
        f"report/{stem}.pdf": render_pdf(compose(report)),
    }
    figures = (*document.figures(), *measurements.figures())
    files |= {f"report/{drawing_file(stem, figure)}": render_drawing(figure) for figure in figures}
    return ReportFiles(files, notices)
