"""Machines whose regressors are looked at: trees, loops, redundant and too few inputs, rolling, rotors, free bodies."""

from __future__ import annotations

from machines import planar_four_bar, rusr_linkage

OUTPUTS = "outputs: [inverse_dynamics, regressor]\n"
# A body with all of its ten parameters, one beside it on the same frame and one on the world; axes oblique to those of
# the frame; weight in no main direction; rotors.
ARM = (
    """
model: arm
parameters: {l: {value: 0.4}, J: {value: 0.02}, g: {value: 9.81}, m_1: {value: 1.7}}
gravity: [1, -2, -g]
joints:
  base: {type: revolute, axis: z, coordinate: a}
  upper: {type: revolute, parent: base, at: [0.1, 0, l], axis: [1, 2, 2], coordinate: b}
  slide: {type: prismatic, parent: upper, at: [l, 0, 0], axis: y, coordinate: s}
  hand: {type: revolute, parent: slide, at: [0, 0.1, 0.2], axis: [1, 1, 0], coordinate: c}
bodies:
  base: {mass: 2, com: [0.1, 0.2, 0.3], inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.01}}
  upper: {mass: m_1, com: [0.2, -0.03, 0.05], inertia: {xx: 0.1, yy: 0.2, zz: 0.15, xy: 0.02, xz: -0.03, yz: 0.01}}
  load: {frame: upper, mass: 0.5, com: [l, 0, 0]}
  slide: {mass: 0.7, com: [0, 0.1, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.015}}
  hand: {mass: 0.4, com: [0.02, 0.01, 0.1], inertia: {xx: 0.01, yy: 0.012, zz: 0.004, xz: 0.001, yz: 0.002}}
  stand: {frame: world, mass: 40, com: [0, 0, 0.2]}
rotor_inertias: {a: J, s: 1.5}
inputs: {u_a: {joint: a}, u_b: {joint: b}, u_s: {joint: s}, u_c: {joint: c}}
"""
    + OUTPUTS
)
# Two drives for one direction of motion.
FOUR_BAR = planar_four_bar("[0, -9.81, 0]", ("1", "0.4", "0.9", "0.7")).replace(
    "  u: {joint: a}", "  u: {joint: a}\n  w: {joint: c}\nrotor_inertias: {c: 0.02}"
) + OUTPUTS.rstrip("\n")  # fmt: skip
LINKAGE = rusr_linkage("[1, -5, -9.81]") + OUTPUTS
# A wheel that rolls without sliding, a fork that holds it upright, a pendulum upon that.
ROLLING = (
    """
model: rolling
parameters: {R: {value: 0.3}, h: {value: 0.5}}
coordinates: {x: {}, y: {}, heading: {unit: rad}, turn: {unit: rad}, swing: {unit: rad}}
gravity: [0, 0, -9.81]
frames:
  fork: {translation: [x, y, R], rotation: [[z, heading]]}
  wheel: {parent: fork, rotation: [[y, turn]]}
  rod: {parent: fork, translation: [0, 0, h], rotation: [[y, swing]]}
bodies:
  fork: {mass: 1, com: [0.1, 0, 0.2], inertia: {zz: 0.1}}
  wheel: {mass: 2, inertia: {xx: 0.05, yy: 0.1, zz: 0.05}}
  rod: {mass: 0.6, com: [0.02, 0.03, -0.3], inertia: {xx: 0.03, yy: 0.04, zz: 0.01, xz: 0.004}}
rotor_inertias: {turn: 0.004}
constraints:
  nonholonomic:
    along: x_dot*cos(heading) + y_dot*sin(heading) - R*turn_dot
    across: y_dot*cos(heading) - x_dot*sin(heading)
inputs: {drive: {acts_on: {turn: 1}}, steer: {acts_on: {heading: 1}}, lean: {acts_on: {swing: 1, turn: -1}}}
ranges: {x: [-1, 1], y: [-1, 1]}
"""
    + OUTPUTS
)
# Free bodies, attitudes by quaternions, one drive for ten directions of motion.
FLOATING = (
    """
model: floating
gravity: [0, 0, -9.81]
joints:
  hull: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}
  arm: {type: revolute, parent: hull, at: [0.1, 0.2, 0.3], axis: [1, 1, 1], coordinate: a}
  ball: {type: spherical, parent: arm, at: [0.2, 0, 0.1], coordinates: [f_0, f_1, f_2, f_3]}
bodies:
  hull: {mass: 5, com: [0.02, 0.01, 0.03], inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.02, xz: 0.01, yz: -0.03}}
  arm: {mass: 1, com: [0.2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.03}}
  ball: {mass: 0.4, com: [0.05, 0.01, 0], inertia: {xx: 0.001, yy: 0.002, zz: 0.0015}}
inputs: {u: {joint: a}}
configuration: {e_0: 1, f_0: 1}
"""
    + OUTPUTS
)
MACHINES = {"arm": ARM, "four_bar": FOUR_BAR, "linkage": LINKAGE, "rolling": ROLLING, "floating": FLOATING}
