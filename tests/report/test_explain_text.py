"""`symgen explain` without a name: lines fit the terminal, sets are said as the report says them."""

from __future__ import annotations

import unicodedata
from dataclasses import replace

import pytest
from report_inputs import document, report_input

from symgen.closedform.forms import derive_closed_forms
from symgen.closedform.published import decide_published
from symgen.generation.explain_text import overview, quantity_text
from symgen.report.content import ReportInput
from symgen.report.latex import render_latex


def _lines(report: ReportInput, monkeypatch: pytest.MonkeyPatch, columns: int = 80) -> list[str]:
    monkeypatch.setenv("COLUMNS", str(columns))
    return overview(report).splitlines()


def _columns(line: str) -> int:
    return sum(not unicodedata.combining(character) for character in line)


@pytest.mark.parametrize("name", ["front_car", "delta", "rapkm_bodies", "gough_stewart", "hostile"])
def test_lines_fit_the_terminal(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert max(map(_columns, _lines(report_input(name), monkeypatch))) <= 80
    for quantity in ("inverse_dynamics", "singularity"):
        assert max(map(_columns, quantity_text(report_input(name), quantity).splitlines())) <= 80


def test_long_sets_are_determinants(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "\n".join(_lines(report_input("delta"), monkeypatch))
    assert "D₁ = | B₂,₄  B₂,₅  B₂,₆ |" in text
    assert "measured singularity:\n    What is measured does not determine" in text
    assert "        z cos a₁ + (r − R + x) sin a₁ = 0\n" in text
    assert "not worked out" not in text


def test_expressions_that_vanish_at_once_have_lines_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = _lines(report_input("rapkm_bodies"), monkeypatch)
    assert "      l₁ l₂ sin b₂ sin b₃" in lines


def test_what_is_not_worked_out_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    delta = report_input("delta")
    unknown = replace(delta.singular_sets[0], vanishing=(), decided=False, explanation="not worked out: too many terms")
    text = " ".join(_lines(replace(delta, determinants=(), singular_sets=(unknown,)), monkeypatch))
    assert text.count("not worked out") == 1
    assert "The quantity singularity (0 there) says in numbers" in " ".join(text.split())


def test_formulas_in_verdicts_are_set(monkeypatch: pytest.MonkeyPatch) -> None:
    car = report_input("front_car")
    text = " ".join("\n".join(_lines(car, monkeypatch)).split())
    assert "columns 1 and 2 of the null-space basis W is −L, not zero" in text
    assert r"basis W is $-L$, not zero" in " ".join(render_latex(document("front_car")).split())
    verdicts = decide_published(car.model, derive_closed_forms(car.model))
    decided = " ".join("\n".join(_lines(replace(car, verdicts=verdicts), monkeypatch)).split())
    assert "derived minus printed is 2 tan θ; its value" in decided
    assert "exists where cos θ or sin φ vanishes" in decided


def test_formulas_in_reasons_are_set(monkeypatch: pytest.MonkeyPatch) -> None:
    skipped = (("method nullspace of u", "singular where `2*cos(a_3)*l_1` = 0, although M~ keeps `rank`"),)
    text = " ".join("\n".join(_lines(replace(report_input("delta"), skipped=skipped), monkeypatch)).split())
    assert "singular where 2l₁ cos a₃ = 0, although M\u0303 keeps `rank`" in text
