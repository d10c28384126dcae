"""Of rows that depend on each other on V the long ones are solved with: beside V short ones point elsewhere."""

from __future__ import annotations

import math

import pytest

from symgen.ir.kernel import Scalar
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.quantities import MOTIONS
from symgen.quantities.select import derive_quantities
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import Sample, rounded
from symgen.verify.tolerance import FACTOR, expectations

# The last row follows from the first, and is as short as the sine is; V is the same without it.
RING = """model: bead
parameters: {m: {value: 0.4}, J: {value: 0.03}, l: {value: 0.7}}
coordinates: {x: {unit: m}, y: {unit: m}, a: {unit: rad}}
kinetic_energy: (m*(x_dot**2 + y_dot**2) + J*a_dot**2)/2
potential_energy: 9.81*m*y
constraints:
  geometric: {along: x - l*cos(a), across: y - l*sin(a), again: sin(a)*(x - l*cos(a))}
inputs: {torque: {acts_on: {a: 1}}}
configuration: {x: 0.7*cos(1), y: 0.7*sin(1), a: 1}
outputs: [forward_dynamics, multipliers]
"""


@pytest.mark.parametrize("quantity", MOTIONS)
def test_results_hold_where_rounding_has_left_v_and_a_row_is_short(quantity: str) -> None:
    model = load_text(RING, "bead.yaml")
    selection = derive_quantities(model, [quantity])
    scalars: tuple[Scalar, ...] = ("float64", "float32")
    programs = schedule(selection.mechanics, selection.quantities, scalars)
    reference = Reference(model)
    for angle in (0.3, 1e-2, 2e-3, 1e-4):
        x, y = 0.7 * math.cos(angle), 0.7 * math.sin(angle)
        given = State((x, y, angle), (-2 * y, 2 * x, 2.0), (0.0, 0.0, 0.0), (0.3,), (0.4, 0.03, 0.7))
        # what the float64 kernel makes of it shows that rounding within a kernel has no part in this
        state = rounded(Sample(given, True, (1.0, 1.0)), "float32").state
        expected = expectations(reference, state, (quantity,), "float32", "short rows")[quantity]
        for scalar in scalars:
            program = programs[scalar]
            (kernel,) = (one for one in program.kernels if one.name == quantity)
            (made,) = outcomes(kernel, program.sincos, scalar, [state])
            assert made.valid
            assert expected.in_units(expected.distance(made.entries)) < FACTOR / 4
