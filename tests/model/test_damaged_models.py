"""Whatever is done to a model file, loading ends with a model or with mistakes that have a place; never otherwise."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from shipped import sparing

from symgen.diagnostics import ModelError
from symgen.model.load import load_text

OTHERS = ("skate", "slider_crank", "rolling_disc")
FOLDER = Path(__file__).parents[2] / "models"
PIECES = [
    "(",
    ")",
    "**",
    "*",
    ", ",
    ": ",
    "{",
    "}",
    "[",
    "]",
    "-",
    "'",
    '"',
    "\n",
    "  ",
    "#",
    "0",
    "x_dot",
    "1e9",
    "phi",
    "|\n",
    "&a ",
    "t",
]


def damaged(text: str, generator: random.Random) -> str:
    """The text after a few deletions, insertions and swaps."""
    for _ in range(generator.randint(1, 3)):
        at = generator.randrange(len(text))
        match generator.randrange(3):
            case 0:
                text = text[:at] + text[at + generator.randint(1, 12) :]
            case 1:
                text = text[:at] + generator.choice(PIECES) + text[at:]
            case _:
                lines = text.split("\n")
                i, j = generator.randrange(len(lines)), generator.randrange(len(lines))
                lines[i], lines[j] = lines[j], lines[i]
                text = "\n".join(lines)
    return text


def outcome(text: str) -> ModelError | None:
    """The mistakes of a model file, or nothing."""
    try:
        load_text(text, "damaged.yaml")
    except ModelError as error:
        return error
    return None


@pytest.mark.slow
@pytest.mark.parametrize("name", sparing(["front_car", "scara", *OTHERS], OTHERS))
def test_damage_is_survived(name: str) -> None:
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    generator = random.Random(name)
    spoiled = 0
    for _ in range(100):
        candidate = damaged(text, generator)
        error = outcome(candidate)
        if error is None:
            continue
        spoiled += 1
        assert error.render()
        for mistake in error.mistakes:
            assert mistake.span is not None, mistake
            assert 1 <= mistake.span.line <= candidate.count("\n") + 2
    assert spoiled > 50


@pytest.mark.campaign
@pytest.mark.slow
def test_long_chains_of_definitions() -> None:
    chain = "\n".join(f"  d{i}: d{i - 1} + x_dot" for i in range(1, 600))
    positions = "\n".join(f"  e{i}: e{i - 1} + x" for i in range(1, 600))
    load_text(
        f"model: m\ncoordinates: {{x: , y: }}\ndefinitions:\n  d0: x_dot\n{chain}\n  e0: x\n{positions}\n"
        "kinetic_energy: d599**2 + y_dot**2\nconstraints: {geometric: {c: e599 - y}}\n",
        "m.yaml",
    )
