"""Machines whose parameters are identified: what leads their motion, what is measured, and the truth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from simulated_logs import Motion

ROOT = Path(__file__).resolve().parents[2]
# An arm with two joints in gravity, friction in both, a spring in the second.
ARM_WITH_FRICTION = """
model: arm_with_friction   # of two joints
parameters:
  l:   {value: 0.4, unit: m}
  m_1: {value: 2.0, unit: kg}      # upper arm
  c_1: {value: 0.18, unit: m}
  J_1: {value: 0.03, unit: kg*m**2, range: [0.001, 0.05]}
  m_2: {value: 1.0, unit: kg}
  c_2: {value: 0.15, unit: m}
  J_2: {value: 0.012, unit: kg*m**2}
  d_1: {value: 0.3, unit: N*m*s/rad}
  f_1: {value: 0.5, unit: N*m}
  d_2: {value: 0.1, unit: N*m*s/rad}
  f_2: {value: 0.2, unit: N*m}
  k:   {value: 1.0, unit: N*m/rad}
  w:   {value: 0.05, unit: rad/s}
gravity: [0, -9.81, 0]
joints:
  shoulder: {type: revolute, axis: z, coordinate: a}
  elbow: {type: revolute, parent: shoulder, at: [l, 0, 0], axis: z, coordinate: b}
bodies:
  shoulder: {mass: m_1, com: [c_1, 0, 0], inertia: {zz: J_1}}
  elbow: {mass: m_2, com: [c_2, 0, 0], inertia: {zz: J_2}}
springs:
  band: {joint: b, stiffness: k, length: 0.2}
friction:
  a: {viscous: d_1, coulomb: f_1, width: w}
  b: {viscous: d_2, coulomb: f_2, width: w}
inputs:
  u_a: {joint: a, unit: N*m}
  u_b: {joint: b, unit: N*m}
"""
# A crank and a rocker in gravity, whose bodies are parameters of their own; drives at both.
FOUR_BAR_WITH_NAMES = """
model: driven_four_bar
parameters:
  l_0: {value: 1.0, unit: m}
  l_1: {value: 0.4, unit: m}
  l_2: {value: 0.9, unit: m}
  l_3: {value: 0.7, unit: m}
  m_1: {value: 1.1, unit: kg}
  x_1: {value: 0.2, unit: m}
  J_1: {value: 0.03, unit: kg*m**2}
  m_2: {value: 1.3, unit: kg}
  x_2: {value: 0.4, unit: m}
  J_2: {value: 0.05, unit: kg*m**2}
  m_3: {value: 0.9, unit: kg}
  x_3: {value: 0.3, unit: m}
  J_3: {value: 0.04, unit: kg*m**2}
  d: {value: 0.2, unit: N*m*s}
gravity: [0, -9.81, 0]
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  coupler: {type: revolute, parent: crank, at: [l_1, 0, 0], axis: z, coordinate: b}
  rocker: {type: revolute, at: [l_0, 0, 0], axis: z, coordinate: c}
bodies:
  crank: {mass: m_1, com: [x_1, 0, 0], inertia: {zz: J_1}}
  coupler: {mass: m_2, com: [x_2, 0, 0], inertia: {zz: J_2}}
  rocker: {mass: m_3, com: [x_3, 0, 0], inertia: {zz: J_3}}
frames:
  end: {parent: coupler, translation: [l_2, 0, 0]}
  top: {parent: rocker, translation: [l_3, 0, 0]}
loops:
  pin: {type: revolute, between: [end, top], axis: z}
friction:
  c: {viscous: d}
inputs:
  u: {joint: a, unit: N*m}
  v: {joint: c, unit: N*m}
configuration: {a: 1.1, b: -0.9, c: 1.3}
"""

# A body in space with all of its moments, turned about one axis.
WHEEL = """
model: wheel
parameters:
  m: {value: 2, unit: kg}
  I_x: {value: 0.3, unit: kg*m**2}
  I_y: {value: 0.4, unit: kg*m**2}
  I_z: {value: 0.5, unit: kg*m**2}
  c: {value: 0.1, unit: m}
gravity: [0, -9.81, 0]
joints:
  hub: {type: revolute, axis: z, coordinate: a}
bodies:
  hub: {mass: m, com: [c, 0, 0], inertia: {xx: I_x, yy: I_y, zz: I_z}}
inputs:
  u: {joint: a}
"""


@dataclass(frozen=True)
class IdentifiedMachine:
    """A model file with wrong values, the motion of its log, what is measured, and the true values."""

    text: str
    motion: Motion
    measured: tuple[str, ...]
    truth: Mapping[str, float]


MACHINES_WITH_LOGS = {
    "rapkm": IdentifiedMachine(
        (ROOT / "models" / "rapkm_bodies.yaml").read_text(encoding="utf-8"),
        Motion({"a_1": (-0.4317, 0.3), "b_1": (1.9106, 0.45)}),
        ("a_1", "a_2", "a_3"),
        {"m_1": 0.26, "m_2": 0.12, "J_1": 1.1e-3, "J_2": 5e-4, "J_motor": 1.4e-3, "m_payload": 0.2},
    ),
    "delta": IdentifiedMachine(
        (ROOT / "models" / "delta.yaml").read_text(encoding="utf-8"),
        Motion({"a_1": (0.3, 0.35), "a_2": (0.3, 0.35), "a_3": (0.3, 0.35)}),
        ("a_1", "a_2", "a_3"),
        {"m_a": 1.0, "J_a": 0.008, "m_r": 0.28, "m_p": 0.9, "J_m": 0.03},
    ),
    "four_bar": IdentifiedMachine(
        FOUR_BAR_WITH_NAMES,
        Motion({"a": (1.1, 0.9)}),
        ("a", "c"),
        {"m_1": 1.3, "x_1": 0.17, "J_1": 0.04, "m_2": 1.0, "x_2": 0.5, "J_2": 0.04, "m_3": 1.2, "x_3": 0.35,
         "J_3": 0.05, "d": 0.35},
    ),
    "arm": IdentifiedMachine(
        ARM_WITH_FRICTION,
        Motion({"a": (0.3, 1.2), "b": (0.5, 1.4)}),
        ("a", "b"),
        {"m_1": 2.6, "c_1": 0.2, "J_1": 0.04, "m_2": 0.8, "c_2": 0.17, "J_2": 0.009, "d_1": 0.5, "f_1": 0.8,
         "d_2": 0.15, "f_2": 0.1, "k": 1.6},
    ),
}  # fmt: skip
