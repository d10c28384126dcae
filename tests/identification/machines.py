"""Mechanisms whose counts of base parameters are published, or follow from reasons of their own."""

from __future__ import annotations

# Twists and offsets of a six-joint arm like the one of Khalil and Dombre, ch. 9: joint axes meet at right angles.
_ARM_JOINTS = (
    ("[0, 0, 0]", "[]"),
    ("[0, 0, 0]", "[[x, -pi/2]]"),
    ("[a2, 0, d3]", "[]"),
    ("[a3, d4, 0]", "[[x, -pi/2]]"),
    ("[0, 0, 0]", "[[x, pi/2]]"),
    ("[0, 0, 0]", "[[x, -pi/2]]"),
)


def six_joint_arm(gravity: str) -> str:
    """An arm with a spherical wrist and every inertial parameter set."""
    joints, bodies = [], []
    for k, (at, rotation) in enumerate(_ARM_JOINTS, 1):
        parent = f"parent: link_{k - 1}, " if k > 1 else ""
        turned = f"rotation: {rotation}, " if rotation != "[]" else ""
        joints.append(
            f"  j_{k}: {{type: revolute, {parent}at: {at}, {turned}axis: z, child: link_{k}, coordinate: q_{k}}}"
        )
        bodies.append(
            f"  link_{k}: {{mass: {k + 1}, com: [0.1, 0.0{k}, 0.05], "
            f"inertia: {{xx: 0.2, yy: 0.3, zz: 0.25, xy: 0.01, xz: 0.02, yz: 0.0{k}}}}}"
        )
    inputs = [f"  u_{k}: {{joint: q_{k}}}" for k in range(1, 7)]
    return "\n".join(
        [
            "model: arm6",
            "parameters:",
            "  a2: {value: 0.43}",
            "  a3: {value: 0.02}",
            "  d3: {value: 0.15}",
            "  d4: {value: 0.41}",
            f"gravity: {gravity}",
            "joints:",
            *joints,
            "bodies:",
            *bodies,
            "inputs:",
            *inputs,
            "",
        ]
    )


def planar_four_bar(gravity: str, lengths: tuple[str, str, str, str]) -> str:
    """Crank, coupler and rocker in the plane x-y, in the lengths ground, crank, coupler, rocker."""
    ground, crank, coupler, rocker = lengths
    return f"""
model: four_bar
parameters:
  l_0: {{value: {ground}}}
  l_1: {{value: {crank}}}
  l_2: {{value: {coupler}}}
  l_3: {{value: {rocker}}}
gravity: {gravity}
joints:
  crank: {{type: revolute, axis: z, coordinate: a}}
  coupler: {{type: revolute, parent: crank, at: [l_1, 0, 0], axis: z, coordinate: b}}
  rocker: {{type: revolute, at: [l_0, 0, 0], axis: z, coordinate: c}}
bodies:
  crank: {{mass: 1.1, com: [0.2, 0.05, 0], inertia: {{zz: 0.03}}}}
  coupler: {{mass: 1.3, com: [0.4, -0.04, 0], inertia: {{zz: 0.05}}}}
  rocker: {{mass: 0.9, com: [0.3, 0.02, 0], inertia: {{zz: 0.04}}}}
frames:
  end: {{parent: coupler, translation: [l_2, 0, 0]}}
  top: {{parent: rocker, translation: [l_3, 0, 0]}}
loops:
  pin: {{type: revolute, between: [end, top], axis: z}}
inputs:
  u: {{joint: a}}
configuration: {{a: 1.1, b: -0.9, c: 1.3}}
"""


def rusr_linkage(gravity: str) -> str:
    """A crank, a coupler on a universal joint, a ball, a rocker about another axis."""
    return f"""
model: rusr
parameters:
  l_1: {{value: 0.3}}
  l_2: {{value: 1.1}}
  l_3: {{value: 0.6}}
gravity: {gravity}
frames:
  stand: {{translation: [0.7, 0.5, 0.1], rotation: [[[1, 2, 2], 0.8]]}}
joints:
  crank: {{type: revolute, axis: z, coordinate: a}}
  cross: {{type: revolute, parent: crank, at: [l_1, 0, 0], axis: y, coordinate: b}}
  coupler: {{type: revolute, parent: cross, axis: z, coordinate: c}}
  rocker: {{type: revolute, parent: stand, axis: x, coordinate: d}}
bodies:
  crank: {{mass: 1.1, com: [0.2, 0.05, 0.01], inertia: {{xx: 0.02, yy: 0.025, zz: 0.03, xy: 0.001}}}}
  coupler: {{mass: 1.3, com: [0.4, -0.04, 0.03], inertia: {{xx: 0.02, yy: 0.055, zz: 0.05, yz: 0.003}}}}
  rocker: {{mass: 0.9, com: [0.03, 0.02, 0.3], inertia: {{xx: 0.05, yy: 0.045, zz: 0.04, xz: 0.002}}}}
points:
  end: {{frame: coupler, at: [l_2, 0, 0]}}
  ball: {{frame: rocker, at: [0, 0.1, l_3]}}
loops:
  ball: {{type: point, between: [end, ball]}}
inputs:
  u: {{joint: a}}
configuration: {{a: 0.3, b: -0.4, c: 0.4, d: 0.2}}
"""
