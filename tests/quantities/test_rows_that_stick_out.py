"""Rows and inputs that depend on each other on the constraints alone, at configurations that are measured."""

from __future__ import annotations

import math

import pytest

from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Status
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities

# Two rows that say the same as long as x = y; two inputs of which, so long, one is as good as the other.
ROWS = """
model: guided_twice
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + y_dot**2 + 2*z_dot**2
potential_energy: 3*x - z
constraints: {geometric: {first: 3*(x - y), second: 0.5*(x - y)*(2 + z)}}
inputs: {a: {acts_on: {x: 1}}, b: {acts_on: {z: 1}}}
configuration: {x: 0.3, y: 0.3, z: 0.5}
"""
INPUTS = """
model: pushed_twice
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + y_dot**2 + 2*z_dot**2
potential_energy: 3*x
constraints: {geometric: {guide: x - y}}
inputs: {a: {acts_on: {x: 1}}, b: {acts_on: {x: 1, z: x - y}}}
configuration: {x: 0.3, y: 0.3, z: 0.5}
"""


@pytest.mark.parametrize(("share", "passes"), [(0.0, True), (0.009, True), (0.011, False), (0.5, False)])
@pytest.mark.parametrize(
    ("text", "length", "lost"),
    [(ROWS, math.sqrt(12.5), Status.CONSTRAINT_RANK), (INPUTS, 1.0, Status.ACTUATION_RANK)],
    ids=["rows", "inputs"],
)
def test_they_stick_out_by_a_hundredth_of_their_length_and_no_more(
    text: str, length: float, lost: Status, share: float, passes: bool
) -> None:
    """The second has this `length` along the first and x - y out of it: `share` is the sine between them."""
    model = load_text(text, "model.yaml")
    generic = genericity(System(model))
    assert (generic.rank, generic.alpha) == ((1, 2) if text is ROWS else (1, 1))
    derived = derive_quantities(model, ["inverse_dynamics"])
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    gap = length * share / math.sqrt(1 - share**2)
    state = {"q": [0.3 + gap, 0.3, 0.5], "qd": [0.0] * 3, "qdd": [0.0] * 3}
    status, u = Interpreter(program.sincos).run(program.kernels[0], state, [])
    assert status == (Status.OK if passes else lost)
    if passes:
        assert sum(u) == pytest.approx(2 if text is ROWS else 3, rel=1e-3)
