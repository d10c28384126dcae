"""Loops of measured lengths close where these agree to a ten thousand millionth of the ranges, and not beyond."""

from __future__ import annotations

import pytest

from symgen.diagnostics import ModelError
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text

# One distance, measured twice.
BELTS = """
model: belts
coordinates:
  x: {unit: m, range: [-1, 1]}
  y: {unit: m, range: [-1, 1]}
  z: {unit: m, range: [-1, 1]}
kinetic_energy: x_dot**2 + 2*y_dot**2 + 3*z_dot**2
constraints: {geometric: {belt: x - y - 0.3, tape: x - y - LENGTH}}
inputs: {u: {acts_on: {x: 1}}}
"""


@pytest.mark.parametrize("length", ["0.3", "0.30000000001", "0.3000000001", "0.2999999999"])
def test_lengths_that_are_the_same_to_ten_digits_are_one(length: str) -> None:
    generic = genericity(System(load_text(BELTS.replace("LENGTH", length), "belts.yaml")))
    assert (generic.rank, generic.delta) == (1, 2)


@pytest.mark.parametrize(("length", "gap"), [("0.3000000004", "2e-10"), ("0.29999999", "5e-09"), ("0.2999", "5e-05")])
def test_lengths_that_differ_by_more_stay_apart_by_half_of_that(length: str, gap: str) -> None:
    with pytest.raises(ModelError, match=f"satisfies all geometric constraints; `(belt|tape)` stays at -?{gap} "):
        load_text(BELTS.replace("LENGTH", length), "belts.yaml")
