"""Sentences begin with a capital, symbols with themselves."""

from __future__ import annotations

import pytest

from symgen.report.context import sentence
from symgen.report.document import InlineCode, InlineMath
from symgen.report.mathematics.text import text_math
from symgen.report.prose import worded


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
    text = "singular where `2*cos(a_3)*l_1` = 0, although M~ keeps its rank; by `--method minor`, left out of `all`"
    shown = [text_math(part.node) if isinstance(part, InlineMath) else part for part in worded(text)]
    assert shown == [
        "singular where ",
        "2l₁ cos a₃",
        " = 0, although ",
        "M̃",
        " keeps its rank; by ",
        InlineCode("--method minor"),
        ", left out of ",
        InlineCode("all"),
    ]


def test_projected_matrices_of_laws_are_set() -> None:
    shown = [text_math(part.node) if isinstance(part, InlineMath) else part for part in worded("d/dt G~ (X = M~+)")]
    assert shown == ["d/dt ", "G̃", " (X = ", "M̃⁺", ")"]
