"""What symgen says about spoiled robot descriptions, beside what it is expected to say."""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

import pytest

from symgen.diagnostics import ModelError
from symgen.model.model import Model

Case = tuple[str, str]
Load = Callable[[Path, str, str], Model]


def replaced(good: Case, *pieces: str) -> Case:
    """The good file with pieces replaced, old and new in turn; the model file as it is."""
    text, head = good
    for old, new in zip(pieces[::2], pieces[1::2], strict=True):
        assert old in text, old
        text = text.replace(old, new, 1)
    return text, head


def check_group(load: Load, cases: Mapping[str, Case], expected: Path, folder: Path) -> None:
    """The mistakes of each spoiled file are those of the text, each with a place and a remedy."""
    sections: dict[str, str] = {}
    for section in expected.read_text(encoding="utf-8").split("== ")[1:]:
        name, _, text = section.partition("\n")
        sections[name] = text
    assert list(sections) == list(cases)
    for name, case in cases.items():
        assert said(load, case, folder) + "\n" == sections[name], f"case {name} of {expected.stem}"


def said(load: Load, case: Case, folder: Path) -> str:
    """The mistakes of a spoiled file, with the folder left out of the places."""
    with pytest.raises(ModelError) as raised:
        load(folder, *case)
    for mistake in raised.value.mistakes:
        assert mistake.span is not None
        text = case[0] if mistake.span.file else case[1]
        assert 1 <= mistake.span.line <= text.count("\n") + 2
        assert mistake.span.end_column > mistake.span.column >= 1
    return raised.value.render().replace(f"{folder}{os.sep}", "")


def check_damaged(load: Load, good: Case, folder: Path, pieces: list[str]) -> None:
    """Characters put in anywhere lead to mistakes, and nothing else."""
    source = random.Random(7)
    pieces = [*pieces, "<", ">", '"', "/", "&", "0", "-", "e", " ", "9" * 50, "\u202e", "<!--", "]]>", "1e308", "nan"]
    survived = 0
    for _ in range(250):
        text = good[0]
        for _ in range(source.randrange(1, 4)):
            start = source.randrange(len(text))
            text = text[:start] + source.choice(pieces) + text[start + source.randrange(12) :]
        with suppress(ModelError):
            load(folder, text, good[1])
            survived += 1
    assert survived < 200
