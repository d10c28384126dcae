"""Systems with redundant inputs: each as text, with the block `allocation` to be filled in."""

from __future__ import annotations

from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# One axis, two drives: m = 2, delta = 1, no constraint.
AXIS = """\
model: axis
coordinates: {x: {unit: m}}
parameters: {mass: {value: 5, unit: kg, range: [4, 6]}}
kinetic_energy: mass/2*x_dot**2
inputs: {left: {unit: N, acts_on: {x: 1}}, right: {unit: N, acts_on: {x: 2}}}
"""
# A plate in the plane with thrusters that no single one of can be missed: n = delta = 3, m = 4.
PLATE = """\
model: plate
coordinates: {x: {unit: m}, y: {unit: m}, a: {unit: rad}}
parameters: {mass: {value: 2, unit: kg}, inertia: {value: 0.3, unit: kg*m**2}, arm: {value: 0.4, unit: m}}
kinetic_energy: mass/2*(x_dot**2 + y_dot**2) + inertia/2*a_dot**2
inputs:
  p: {unit: N, acts_on: {x: cos(a), y: sin(a), a: arm}}
  q_1: {unit: N, acts_on: {x: cos(a + 2), y: sin(a + 2), a: arm/2}}
  s: {unit: N, acts_on: {x: cos(a + 4), y: sin(a + 4), a: -arm}}
  t_1: {unit: N, acts_on: {x: -sin(a), y: cos(a), a: arm/3}}
"""
# The same with a fifth thruster and a skid: r = 1, delta = 2, m = 5.
SKID = (
    PLATE.replace("model: plate", "model: skid")
    + """\
  v: {unit: N, acts_on: {x: 1}}
constraints: {nonholonomic: {skid: sin(a)*x_dot - cos(a)*y_dot + 0.3*a_dot}}
"""
)
# Two inputs on one of two free axes: alpha = 1 < delta = 2.
LAME = """\
model: lame
coordinates: {x: {unit: m}, y: {unit: m}}
parameters: {mass: {value: 5, unit: kg}}
kinetic_energy: mass/2*(x_dot**2 + y_dot**2 + x_dot*y_dot)
inputs: {left: {unit: N, acts_on: {x: 1, y: 1}}, right: {unit: N, acts_on: {x: 3, y: 3}}}
"""
# A beam on two parallel cranks whose loop is closed twice: rank 2 of 3 rows.
CRANKS = """\
model: cranks
coordinates: {a: {unit: rad, range: [-1, 1]}, b: {unit: rad, range: [-1, 1]}, c: {unit: rad, range: [-1, 1]}}
parameters: {inertia: {value: 0.3, unit: kg*m**2}}
kinetic_energy: inertia/2*(a_dot**2 + b_dot**2 + c_dot**2)
constraints: {geometric: {ab: a - b, bc: b - c, ca: c - a}}
inputs: {A: {unit: N*m, acts_on: {a: 1}}, B: {unit: N*m, acts_on: {b: 1}}, C: {unit: N*m, acts_on: {c: 2}}}
"""


@cache
def parallel_robot() -> str:
    """The RA-PKM with three drives for two degrees of freedom, without its paths."""
    text = (ROOT / "models" / "rapkm_2rrr_rr.yaml").read_text(encoding="utf-8")
    return text[: text.index("# The circle of Figs")].replace("outputs: all\n", "")
