"""Reports of systems the shipped models do not cover: no inputs, dependent constraints, too few or rivalling inputs."""

from __future__ import annotations

import pytest

from symgen.closedform.forms import derive_closed_forms
from symgen.closedform.laws.driven import laws_of_driven_coordinates
from symgen.closedform.laws.known import KnownNames
from symgen.closedform.laws.projections import laws_by_squares
from symgen.generation.explain_text import overview
from symgen.model.load import load_text
from symgen.report.compose import compose
from symgen.report.content import ReportInput
from symgen.report.html import render_html
from symgen.report.latex import render_latex
from symgen.report.pdf import render_pdf

BASE = """
model: variant
coordinates: {x: {}, y: {}, z: {}}
parameters: {m: 2}
kinetic_energy: m/2*(x_dot**2 + y_dot**2 + z_dot**2)
"""
NO_INPUTS = BASE + "constraints: {geometric: {level: z}, nonholonomic: {edge: sin(x)*x_dot - cos(x)*y_dot}}\n"
DEPENDENT = BASE + "constraints: {geometric: {one: z + x, two: (z + x)*(2 + y**2)}}\ninputs: {u: {acts_on: {y: 1}}}\n"
RIVALS = BASE + "inputs: {u: {acts_on: {x: 1}}, v: {acts_on: {x: 2}}}\n"


def report(text: str) -> str:
    """The report of a model given as text, in all three formats, as HTML."""
    model = load_text(text, "variant.yaml")
    forms = derive_closed_forms(model)
    document = compose(
        ReportInput(model, "1.2.3", forms.forms, forms.structure, forms.integrability, forms.singular_sets)
    )
    assert render_latex(document)
    assert render_pdf(document)
    return render_html(document)


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        (NO_INPUTS, ("There are no inputs", "Without inputs there is no inverse dynamics", "no inputs.")),
        (NO_INPUTS, ("A geometric constraint, paper", "A constraint linear in the rates, paper")),
        (DEPENDENT, ("the constraints depend on each other", "the multipliers are not unique")),
        (RIVALS, ("redundantly under-actuated", "Moore–Penrose inverse at this rank", "the residual tells")),
    ],
)
def test_words_for_unusual_systems(text: str, sentences: tuple[str, ...]) -> None:
    page = " ".join(report(text).split())
    for sentence in sentences:
        assert sentence in page


def test_rows_that_depend_on_each_other_are_said_by_squares(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where closed forms are too long: here they are short, and left away."""
    model = load_text(DEPENDENT.replace("inputs: {", "inputs: {v: {acts_on: {x: 1}}, "), "variant.yaml")
    forms = derive_closed_forms(model)
    laws = (*laws_by_squares(forms.exact), *laws_of_driven_coordinates(forms.exact, KnownNames(forms)))
    by_quantity = {law.quantity: tuple(one for one in laws if one.quantity == law.quantity) for law in laws}
    given = ReportInput(model, "1.2.3", forms.forms, forms.structure, laws=by_quantity)
    source = " ".join(render_latex(compose(given)).split())
    for text in (
        r"let the index $i$ stand for \texttt{one}. Where these are independent",
        r"\mathbf{I} - \mathbf{B}_{i}^{\mathrm{T}} \mathbf{S}^{-1} \mathbf{B}_{i}",
        r"= -\mathbf{B}_{a}^{\mathrm{T}} \mathbf{B}_{p} (\mathbf{B}_{p}^{\mathrm{T}} \mathbf{B}_{p})^{-1}",
        r"$|\mathbf{B}_{i} \mathbf{B}_{i}^{\mathrm{T}}| = 0$ for every choice $i$ of $1$ of the rows",
        r"this happens where $|\mathbf{B}_{p}^{\mathrm{T}} \mathbf{B}_{p}| = 0$",
    ):
        assert text in source, text
    assert render_pdf(compose(given)).startswith(b"%PDF")
    monkeypatch.setenv("COLUMNS", "80")
    shown = overview(given)
    assert "happens where |B_i B_iᵀ| = 0 for every choice i of 1 of the rows of B." in " ".join(shown.split())
    assert "input singularity:" in shown
