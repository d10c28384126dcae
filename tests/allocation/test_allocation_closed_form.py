"""Closed forms and report of allocated inputs: the printed parts give the reference's numbers, the words are there."""

from __future__ import annotations

import pytest
import sympy
from laws_harness import System
from test_allocation_witness import CASES

import symgen
from symgen.closedform.forms import derive_closed_forms
from symgen.report.compose import compose
from symgen.report.content import ReportInput
from symgen.report.html import render_html
from symgen.report.latex import render_latex
from symgen.report.pdf import render_pdf
from symgen.verify.sampling.states import sample_states

# the common denominator of M is negative, and with it the sign of the minors without it
FLIPPED = """\
model: flipped
coordinates: {x: {}}
kinetic_energy: x_dot**2
inputs: {left: {acts_on: {x: 1}}, right: {acts_on: {x: 1/(x - 3)}}}
"""
WRITTEN = {
    **{name: case for name, case in CASES.items() if name not in ("lame", "within limits")},
    "flipped": (FLIPPED, "weights: {right: 3}, preload: 0.7"),
}


def test_what_is_taken_at_each_state_is_not_written_out() -> None:
    text, block = CASES["within limits"]
    made = System(f"{text}allocation: {{{block}}}\n", ("inverse_dynamics",))
    form = derive_closed_forms(made.model).forms["inverse_dynamics"]
    assert form.matrix is None
    assert form.note.startswith("not written out: of all sets of limits that inputs may reach")


@pytest.mark.parametrize("name", WRITTEN)
def test_the_printed_parts_give_the_numbers_of_the_reference(name: str) -> None:
    text, block = WRITTEN[name]
    made = System(f"{text}allocation: {{{block}}}\n", ("inverse_dynamics",))
    form = derive_closed_forms(made.model).forms["inverse_dynamics"]
    assert form.matrix is not None
    parts = [*form.intermediates, *((sympy.Symbol(f"input {k}"), entry) for k, entry in enumerate(form.matrix))]
    functions = [
        (symbol.name, sorted(e.free_symbols, key=str), sympy.lambdify(sorted(e.free_symbols, key=str), e, "math"))
        for symbol, e in parts
    ]
    for sample in sample_states(made.reference, ["inverse_dynamics"], 8):
        state = sample.state
        values = {p.name: x for p, x in zip(made.model.parameters, state.parameters, strict=True)}
        for k, c in enumerate(made.model.coordinates):
            values |= {c.name: state.q[k], c.rate: state.qd[k], c.acceleration: state.qdd[k]}
        for target, symbols, function in functions:
            values[target] = function(*(values[symbol.name] for symbol in symbols))
        inputs = [values[f"input {k}"] for k in range(made.model.m)]
        wanted = [float(x) for x in made.reference.evaluate(state, ["inverse_dynamics"])["inverse_dynamics"]]
        size = max(map(abs, wanted))
        assert inputs == pytest.approx(wanted, rel=1e-9, abs=1e-9 * size)


def test_a_notebook_is_told_where_the_parts_are() -> None:
    text, block = CASES["axis"]
    derived = symgen.derive(System(f"{text}allocation: {{{block}}}\n").model)
    with pytest.raises(KeyError, match=r"closed_forms\.forms: limits choose by minima and maxima"):
        derived.sympy["inverse_dynamics"]
    assert derived.casadi["inverse_dynamics"]


SENTENCES = {
    "axis": ("With one input more than needed", "the middle one is taken"),
    "skid": ("holds the preferred values of p, v", "the weights: those of q_1, v are parameters"),
    "lame": ("redundantly under-actuated", "the weights: those of left are parameters"),
}


@pytest.mark.parametrize("name", SENTENCES)
def test_report(name: str) -> None:
    text, block = CASES[name]
    model = System(f"{text}allocation: {{{block}}}\n").model
    forms = derive_closed_forms(model)
    document = compose(
        ReportInput(model, "1.2.3", forms.forms, forms.structure, forms.integrability, forms.singular_sets)
    )
    assert render_latex(document)
    assert render_pdf(document)
    page = " ".join(render_html(document).split())
    for sentence in SENTENCES[name]:
        assert sentence in page
