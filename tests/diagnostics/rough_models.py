"""Models whose friction of reactions is spoiled in one way each."""

from __future__ import annotations

CRANK = """\
model: crank
parameters: {r: 0.1, l: 0.3, m: 1, J: 0.01, mu: 0.1, rho: 0.01, w: 0.1}
joints:
  crank: {type: revolute, coordinate: a}
  rod: {type: revolute, parent: crank, at: [r, 0, 0], coordinate: b}
  block: {type: prismatic, axis: x, coordinate: s}
bodies:
  crank: {mass: m, inertia: {zz: J}}
  rod: {mass: m, inertia: {zz: J}}
  block: {mass: m}
points: {tip: {frame: rod, at: [l, 0, 0]}, eye: {frame: block}}
loops:
  wrist: {type: point, between: [tip, eye]}
inputs: {motor: {joint: a}}
configuration: {a: 0.5, b: -0.6, s: 0.38}
"""


def rough(entries: str, text: str = CRANK, more: str = "") -> str:
    """The crank with those entries under `friction`."""
    return f"{text}{more}friction: {{{entries}}}\n"


BALL = """\
model: ball
parameters: {m: 1, J: 0.01, l: 0.3, mu: 0.1, rho: 0.01, w: 0.1}
joints:
  swing: {type: revolute, axis: [0, 3, 4], coordinate: a}
  ball: {type: spherical, parent: swing, at: [l, 0, 0], coordinates: [e_0, e_1, e_2, e_3]}
bodies:
  ball: {mass: m, com: [l, 0, 0], inertia: {xx: J, yy: J, zz: J}}
inputs: {motor: {joint: a}}
"""
CART = """\
model: cart
parameters: {R: 0.1, m: 1, J: 0.01, mu: 0.1, rho: 0.01, w: 0.1}
coordinates: {x: {unit: m}, turn: {unit: rad}}
joints:
  frame: {type: prismatic, at: [0, 0, R], axis: x, coordinate: x}
  wheel: {type: revolute, parent: frame, axis: y, coordinate: turn}
bodies: {frame: {mass: m}, wheel: {mass: m, inertia: {yy: J}}}
rolling: {tyre: {frame: wheel, radius: R}}
inputs: {motor: {joint: turn}}
"""
BAR = "bar: {type: distance, between: [tip, eye], length: l}"
SECOND = "constraints: {geometric: {again: tip.y}}\n"
ROUGH = {
    "without_a_radius": rough("rod: {coulomb: mu, width: w}, wrist: {coulomb: mu, width: w}"),
    "without_a_width": rough("rod: {coulomb: mu, radius: rho}"),
    "without_a_coefficient": rough("rod: {radius: rho, width: w}"),
    "radius_of_a_guide": rough("block: {coulomb: mu, radius: rho, width: w}"),
    "negative": rough("rod: {coulomb: -mu, radius: rho, width: 0}"),
    "radius_of_a_coordinate": rough("b: {coulomb: mu, radius: rho, width: w}"),
    "viscous_beside_it": rough("rod: {viscous: 1, coulomb: mu, radius: rho, width: w}"),
    "rate_of_a_joint": rough("rod: {coulomb: mu, radius: rho, width: w, rate: b_dot}"),
    "no_such_place": rough("rodd: {coulomb: mu, radius: rho, width: w}"),
    "no_such_row": rough("pin: {coulomb: mu, radius: rho, width: w, reaction: [wrist_z], rate: b_dot}"),
    "rows_without_a_rate": rough("pin: {coulomb: mu, radius: rho, width: w, reaction: [wrist_x]}"),
    "rate_that_is_squared": rough("pin: {coulomb: mu, width: w, reaction: [wrist_x], rate: b_dot**2}"),
    "state_in_a_coefficient": rough("rod: {coulomb: mu*cos(a), radius: rho, width: w}"),
    "spherical_and_oblique": rough(
        "ball: {coulomb: mu, radius: rho, width: w}, swing: {coulomb: mu, radius: rho, width: w}", BALL
    ),
    "wheel": rough("wheel: {coulomb: mu, radius: rho, width: w}", CART),
    "energy_written_out": rough("rod: {coulomb: mu, radius: rho, width: w}", more="kinetic_energy: J/2*a_dot**2\n"),
    "distance": rough(
        "bar: {coulomb: mu, radius: rho, width: w}",
        CRANK.replace("wrist: {type: point, between: [tip, eye]}", BAR),
    ),
    "dependent_rows": rough("rod: {coulomb: mu, radius: rho, width: w}", more=SECOND),
    "no_inputs": rough("rod: {coulomb: mu, radius: rho, width: w}", CRANK.replace("inputs: {motor: {joint: a}}\n", "")),
    "allocation": rough(
        "rod: {coulomb: mu, radius: rho, width: w}",
        CRANK.replace("{motor: {joint: a}}", "{motor: {joint: a}, push: {joint: s}}"),
        "allocation: {weights: {push: 2}}\n",
    ),
    "locks_everywhere": rough("rod: {coulomb: 20, radius: 1, width: w}"),
}
