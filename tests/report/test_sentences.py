"""Sentences begin with a capital, symbols with themselves."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.model.load import load_model
from symgen.report.context import sentence
from symgen.report.document import InlineCode, InlineMath
from symgen.report.mathematics.text import text_math
from symgen.report.prose import worded
from symgen.report.sections.bookkeeping import subject


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("the potential energy is constant", "The potential energy is constant."),
        ("a motion is lost!", "A motion is lost!"),
        ("δ = 1 for 3 coordinates", "δ = 1 for 3 coordinates."),
        ("m = 2", "m = 2."),
        ("m_1, which is 0", "m_1, which is 0."),
        ("", ""),
    ],
)
def test_a_sentence_begins_as_it_should(text: str, written: str) -> None:
    assert sentence(text) == written


def test_formulas_that_messages_quote_are_set_and_all_else_is_code() -> None:
    text = "singular where `2*cos(a_3)*l_1` = 0, although M~ keeps its rank; by `--method minor`, not in `all`, N_B"
    shown = [text_math(part.node) if isinstance(part, InlineMath) else part for part in worded(text)]
    assert shown == [
        "singular where ",
        "2l₁ cos a₃",
        " = 0, although ",
        "M̃",
        " keeps its rank; by ",
        InlineCode("--method minor"),
        ", not in ",
        InlineCode("all"),
        ", ",
        "N_B",
    ]


@pytest.mark.parametrize(
    ("what", "shown"),
    [
        ("sine and cosine of theta + phi", ["Sine and cosine of ", "θ + φ"]),
        ("the values of x, y", ["The values of ", "x", ", ", "y"]),
        ("3 of 8 entries of B", ["3 of 8 entries of B"]),
        ("repeated work on 3 groups of parameters", ["Repeated work on 3 groups of parameters"]),
        ("constraint_residual", [InlineCode("constraint_residual")]),
    ],
)
def test_coordinates_in_what_was_left_out_are_set(what: str, shown: list[str]) -> None:
    model = load_model(Path(__file__).parents[2] / "models/front_car.yaml")
    said = subject(what, model)
    assert [text_math(part.node) if isinstance(part, InlineMath) else part for part in said] == shown


def test_projected_matrices_of_laws_are_set() -> None:
    shown = [text_math(part.node) if isinstance(part, InlineMath) else part for part in worded("d/dt G~ (X = M~+)")]
    assert shown == ["d/dt ", "G̃", " (X = ", "M̃⁺", ")"]
