"""Quarter turns that were computed elsewhere are quarter turns."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symgen.model.expressions.expression import Expression, Number
from symgen.model.kinematics.fixed_angles import exact_sine_and_cosine, quarter_turns
from symgen.model.load import load_text
from symgen.model.model import Model

TEXT = """
model: turned
joints:
  hinge: {type: revolute, axis: z, rotation: [[x, ANGLE]], coordinate: a}
bodies:
  hinge: {mass: 2, com: [0.1, 0, 0.2], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
gravity: [0, 0, -9.81]
inputs: {motor: {joint: a}}
"""


def _first_angle(model: Model) -> Expression:
    rotation = model.mechanism.frames[0].rotation
    assert isinstance(rotation, tuple)
    return rotation[0].angle


@pytest.mark.parametrize("written", ["1.5707963267948966", "-3.141592653589793", "1.57079633"])
def test_they_stand_for_multiples_of_pi(written: str) -> None:
    turns = round(float(written) / 1.5707963)
    model, exact = (load_text(TEXT.replace("ANGLE", angle), "turned.yaml") for angle in (written, f"{turns}/2*pi"))
    sine_and_cosine, meant = (exact_sine_and_cosine(_first_angle(one)) for one in (model, exact))
    assert sine_and_cosine is not None
    assert sine_and_cosine == meant
    assert f"`{written}` is taken for {turns}*pi/2" in [notice.message for notice in model.notices]


@pytest.mark.parametrize("written", ["0", "1.5708", "1.5707963", "0.78539816"])
def test_others_are_taken_as_written(written: str) -> None:
    assert quarter_turns(Number(Fraction(written))) is None
