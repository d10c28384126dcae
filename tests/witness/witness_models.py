"""Mechanisms for the tests of the witness that no shipped model covers."""

# A beam on three parallel cranks: six loop closures of rank five, whatever rows are chosen.
CRANKS = """
model: cranks
coordinates: {a: {}, b: {}, c: {}, x: {}, y: {}, turn: {}}
parameters: {l: 0.5, m: 2, J: 0.3, g: 9.81}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*(turn_dot**2 + a_dot**2) + J/3*b_dot**2 + J/5*c_dot**2
potential_energy: g*m*y
constraints:
  geometric:
    ax: l*cos(a) - x
    ay: l*sin(a) - y
    bx: l*cos(b) + 1 - x - cos(turn)
    by: l*sin(b) - y - sin(turn)
    cx: l*cos(c) + 2 - x - 2*cos(turn)
    cy: l*sin(c) - y - 2*sin(turn)
inputs: {drive: {acts_on: {a: 1}}}
configuration: {a: 1.5, b: 1.5, c: 1.5, x: 0.035, y: 0.499, turn: 0}
outputs: all
"""

# Two inputs that pull in the same direction, three degrees of freedom.
UNDER_ACTUATED = """
model: under_actuated
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + (2 + cos(y))*y_dot**2 + z_dot**2 + x_dot*y_dot*sin(z)
potential_energy: x*z
inputs: {pull: {acts_on: {x: 1, y: cos(z)}}, push: {acts_on: {x: 2, y: 2*cos(z)}}}
applied_forces: {x: -y*x_dot}
outputs: all
"""

EXTRA = {"cranks": CRANKS, "under_actuated": UNDER_ACTUATED}
