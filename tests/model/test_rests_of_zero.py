"""What computing a vector left of 0 is 0: a collinear joint stays collinear, whoever worked out its axis."""

from __future__ import annotations

import pytest

from symgen.model.load import load_text
from symgen.model.model import Model

TEXT = """
model: pair
joints:
  first: {type: revolute, axis: AXIS, coordinate: a}
  second: {type: revolute, axis: x, at: AT, coordinate: b}
frames:
  dock: {parent: first, translation: [0, 0, 0], rotation: [[TURN, 0.4]]}
bodies:
  first: {mass: 2, com: [0.1, 0, 0.2], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  second: {mass: 1, com: [0.1, 0, 0.2], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
gravity: [0, 0, -9.81]
inputs: {motor: {joint: a}}
outputs: [mass_matrix]
"""
USUAL = {"AXIS": "[1, 0, 0]", "AT": "[0, 0, 0.3]", "TURN": "[1, 0, 0]"}


def _model(**parts: str) -> Model:
    text = TEXT
    for name, value in (USUAL | parts).items():
        text = text.replace(name, value)
    return load_text(text, "pair.yaml")


@pytest.mark.parametrize(
    "part",
    [
        {"AXIS": "[1, 1.2106836856538812e-16, 0]"},
        {"TURN": "[1, 0, -1.2106836856538812e-16]"},
        {"AT": "[0, 2*3.061616997868383e-17, 0.3]"},
    ],
)
def test_a_component_that_rounding_left_is_zero_and_told(part: dict[str, str]) -> None:
    model = _model(**part)
    meant = _model()
    assert [frame.rotation for frame in model.mechanism.frames] == [frame.rotation for frame in meant.mechanism.frames]
    assert [frame.translation for frame in model.mechanism.frames] == [
        frame.translation for frame in meant.mechanism.frames
    ]
    assert sum("is taken for 0" in notice.message for notice in model.notices) == 1


@pytest.mark.parametrize("part", [{"AXIS": "[1, 1e-9, 0]"}, {"AT": "[0, 1e-17, 0]"}, {"AT": "[0, 1e-13, 0.3]"}])
def test_what_stands_alone_or_is_only_small_is_taken_as_written(part: dict[str, str]) -> None:
    assert not any("is taken for 0" in notice.message for notice in _model(**part).notices)
