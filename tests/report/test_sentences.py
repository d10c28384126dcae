"""Sentences begin with a capital, symbols with themselves."""

from __future__ import annotations

import pytest

from symgen.report.context import sentence


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
