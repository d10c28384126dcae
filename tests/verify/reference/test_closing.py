"""Newton's method of the reference: loops close beside singular poses, too."""

from __future__ import annotations

import math

import pytest
from flint import arb

from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import closed
from symgen.verify.reference.configurations.manifold import RANK_BITS
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values

# A crank under a roller that its height holds, all but upright, and a wheel that another row turns.
UPRIGHT = """
model: upright
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
parameters: {height: {value: 0.9}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2)/2
constraints: {geometric: {roller: sin(a) - height, both: b - 3*c + a**2}}
outputs: [forward_dynamics]
"""


@pytest.mark.parametrize("away", [1e-1, 1e-3, 3.7e-6, 1e-7])
def test_a_loop_closes_however_small_a_slope_is_beside_the_others(away: float) -> None:
    a = math.pi / 2 - away
    system = ReferenceSystem(load_text(UPRIGHT, "upright.yaml"))
    with precision(RANK_BITS):
        start, heights = [a, 0.4, (0.4 + a * a) / 3], [arb(math.sin(a))]
        q, still_open = closed(system, start, heights, literal_values(system.literals), 2.0**-170)
    assert not still_open
    # what rounding leaves of a sine moves its angle by that over the slope
    assert float(q[0].mid()) == pytest.approx(a, abs=1e-15 + 1e-16 / away)
