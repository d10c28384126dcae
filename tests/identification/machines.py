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


def delta_with_rods(gravity: str, turned: tuple[str, ...]) -> str:
    """A Delta with rods that are bodies, each on a universal joint at its arm and a ball at the platform, which slides.

    Rods in pairs move alike: one body stands for two.  Arm k is turned by `turned[k]` about the vertical.
    """
    frames, joints, bodies, points, loops, inputs, places = (list[str]() for _ in range(7))
    for k, angle in enumerate(turned, 1):
        rotation = f"rotation: [[z, {angle}]]"
        frames += [f"  side_{k}: {{{rotation}}}", f"  foot_{k}: {{parent: platform, {rotation}}}"]
        joints += [
            f"  arm_{k}: {{type: revolute, parent: side_{k}, at: [R, 0, 0], axis: y, coordinate: a_{k}}}",
            f"  cross_{k}: {{type: revolute, parent: arm_{k}, at: [l_1, 0, 0], axis: y, coordinate: b_{k}}}",
            f"  rod_{k}: {{type: revolute, parent: cross_{k}, axis: z, coordinate: c_{k}}}",
        ]
        bodies += [
            f"  arm_{k}: {{mass: 0.8, com: [0.1, 0.01, 0.02], inertia: {{xx: 0.001, yy: 0.006, zz: 0.006}}}}",
            f"  rod_{k}: {{mass: 0.2, com: [0.4, 0.01, 0.02], inertia: {{xx: 0.001, yy: 0.01, zz: 0.01, xz: 0.0001}}}}",
        ]
        points += [f"  end_{k}: {{frame: rod_{k}, at: [l_2, 0, 0]}}", f"  seat_{k}: {{frame: foot_{k}, at: [r, 0, 0]}}"]
        loops.append(f"  ball_{k}: {{type: point, between: [end_{k}, seat_{k}]}}")
        inputs.append(f"  u_{k}: {{joint: a_{k}}}")
        places.append(f"a_{k}: 0.3, b_{k}: 1, c_{k}: 0")
    return "\n".join(
        [
            "model: delta_with_rods",
            "parameters: {R: {value: 0.2}, r: {value: 0.05}, l_1: {value: 0.3}, l_2: {value: 0.8}}",
            f"gravity: {gravity}",
            "coordinates: {x: {unit: m}, y: {unit: m}, z: {unit: m}}",
            "frames:",
            "  platform: {translation: [x, y, z]}",
            *frames,
            "joints:",
            *joints,
            "bodies:",
            "  platform: {mass: 0.6, com: [0.01, 0.02, 0.03], inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}",
            *bodies,
            "points:",
            *points,
            "loops:",
            *loops,
            "inputs:",
            *inputs,
            f"configuration: {{{', '.join(places)}, x: 0, y: 0, z: -0.75}}",
            "",
        ]
    )
