"""What rounding leaves along the rows is taken out again: light bodies between heavy ones that are driven hard."""

from __future__ import annotations

import random

import pytest

from symgen.lowering.schedule import schedule
from symgen.methods.forward_dynamics.motion import Problem
from symgen.model.load import load_text
from symgen.model.quantities import MOTIONS
from symgen.quantities.select import derive_quantities
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import Sample, rounded
from symgen.verify.tolerance import FACTOR, expectations

# Three rows hold two light bodies between three heavy ones; their entries are parameters.
ROWS = {name: [f"k_{name}_{j}" for j in "xyzvw"] for name in ("first", "second", "third")}
ENTRIES = [entry for row in ROWS.values() for entry in row]
VALUES = ", ".join(f"{entry}: {{value: {(-1) ** i * (1 + i * i % 7) / 8}}}" for i, entry in enumerate(ENTRIES))
BETWEEN = f"""model: between
parameters: {{heavy: {{value: 1e8}}, {VALUES}}}
coordinates: {{x: {{unit: m}}, y: {{unit: m}}, z: {{unit: m}}, v: {{unit: m}}, w: {{unit: m}}}}
kinetic_energy: (x_dot**2 + 2*y_dot**2 + heavy*(z_dot**2 + 3*v_dot**2 + 2*w_dot**2))/2
constraints:
  nonholonomic:
""" + "".join(
    f"    {name}: {' + '.join(f'{entry}*{entry[-1]}_dot' for entry in row)}\n" for name, row in ROWS.items()
) + """inputs: {one: {acts_on: {z: 1}}, two: {acts_on: {v: 1}}, three: {acts_on: {w: 1}}}
outputs: [forward_dynamics, multipliers]
"""


@pytest.mark.parametrize("quantity", MOTIONS)
def test_light_bodies_between_heavy_ones_keep_their_digits(quantity: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Problem, "rows_in_line", True)
    model = load_text(BETWEEN, "between.yaml")
    selection = derive_quantities(model, [quantity], {quantity: "schur_qr_refined"})
    program = schedule(selection.mechanics, selection.quantities, ("float32",))["float32"]
    (kernel,) = (one for one in program.kernels if one.name == quantity)
    reference, source = Reference(model), random.Random(5)
    for _ in range(24):
        entries = tuple(source.uniform(-1, 1) for _ in ENTRIES)
        u = tuple(1e8 * source.uniform(-1, 1) for _ in range(3))
        given = State((0.0,) * 5, (0.0,) * 5, (0.0,) * 5, u, (1e8, *entries))
        state = rounded(Sample(given, True, (1.0, 1.0)), "float32").state
        expected = expectations(reference, state, (quantity,), "float32", "between")[quantity]
        (made,) = outcomes(kernel, program.sincos, "float32", [state])
        assert made.valid
        assert expected.in_units(expected.distance(made.entries)) < FACTOR / 16
