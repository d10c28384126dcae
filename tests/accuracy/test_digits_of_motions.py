"""q_ddot and lambda keep their digits where lengths are far from those of the model file."""

from __future__ import annotations

import numpy as np
import pytest

from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.quantities import MOTIONS
from symgen.quantities.select import derive_quantities
from symgen.verify.lanes.rounding import RoundingErrors

# A point on a rod about a place that is no number of binary digits.
ROD = """model: rod
coordinates: {x: {unit: m}, y: {unit: m}}
parameters: {m: {value: 3.3}, squared: {value: 0.2}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2)
potential_energy: 9.81*y
constraints: {geometric: {rod: (x + 1.2)**2 + (y - 0.73)**2 - squared}}
inputs:
  u: {acts_on: {x: (5 - x)/sqrt((x - 5)**2 + (y - 5)**2), y: (5 - y)/sqrt((x - 5)**2 + (y - 5)**2)}}
outputs: [forward_dynamics, multipliers]
configuration: {x: -0.753, y: 0.73}
"""
RADIUS = 1.4e-5

# A car whose rear axle stands where its mass is: what drives it presses no row.
CAR = """model: car
coordinates: {x: {unit: m}, y: {unit: m}, theta: {unit: rad}, phi: {unit: rad}}
parameters: {m: {value: 2.5}, L: {value: 0.21}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + 1.5/2*theta_dot**2 + 0.16/2*phi_dot**2
constraints:
  nonholonomic:
    axle: sin(theta)*x_dot - cos(theta)*y_dot
    front: sin(theta + phi)*x_dot - cos(theta + phi)*y_dot - L*cos(phi)*theta_dot
inputs:
  u_1: {acts_on: {x: cos(theta), y: sin(theta)}}
  u_2: {acts_on: {phi: 1}}
outputs: [multipliers]
configuration: {x: 0.0, y: 0.0, theta: 2.35, phi: 0.59}
"""


def error(text: str, quantity: str, state: dict[str, list[float]]) -> float:
    """The rounding error of a kernel, estimated in units of d + eps |y|."""
    selection = derive_quantities(load_text(text, "model.yaml"), [quantity])
    program = schedule(selection.mechanics, selection.quantities, ("float64",))["float64"]
    (kernel,) = (one for one in program.kernels if one.name == quantity)
    (own,), (unit,) = RoundingErrors(kernel).with_units({part: np.array([values]) for part, values in state.items()})
    units = float(own / unit)
    assert units > 0
    return units


@pytest.mark.parametrize("quantity", MOTIONS)
def test_squares_of_short_distances_are_not_multiplied_out(quantity: str) -> None:
    q = [-1.2 + 0.6 * RADIUS, 0.73 - 0.8 * RADIUS]
    state = {"q": q, "qd": [0.5, 0.4], "u": [4.0], "p": [3.3, RADIUS**2]}
    assert error(ROD, quantity, state) < 8


@pytest.mark.parametrize("length", [0.21, 2.1e3, 2.1e8])
def test_forces_that_press_no_row_have_cancelled(length: float) -> None:
    theta, phi, speed = 1.96, 0.19, 0.8
    rates = [speed * np.cos(theta), speed * np.sin(theta), speed * np.tan(phi) / length, 0.93]
    state = {"q": [0.1, -0.1, theta, phi], "qd": rates, "u": [7.4, -7.1], "p": [2.5, length]}
    assert error(CAR, MOTIONS[1], state) < 4
