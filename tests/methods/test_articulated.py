"""q_ddot and lambda by articulated inertias are those of the dense factor, for every kind of joint and constraint."""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import Any

import pytest
import shipped

import symgen.methods.forward_dynamics.articulated as by_frames
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.rigid_bodies.newton_euler import frame_motions
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics import joint_accelerations
from symgen.methods.forward_dynamics.articulated import articulated
from symgen.methods.forward_dynamics.loop_points import acceleration, loop_points
from symgen.methods.forward_dynamics.motion import Problem
from symgen.methods.forward_dynamics.schur import schur_qr
from symgen.model.kinematics.triples import applied
from symgen.model.load import load_model
from symgen.model.mechanism import WORLD
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import reached

# revolute and prismatic joints, rotors, points of wheels, floating bodies in the plane, damped and driven
NAMES = ("scara", "five_bar", "delta", "differential_drive", "rolling_disc", "front_car_bodies", "arm7", "gough_loops")
JOINTS = """model: joints
coordinates:
  x: {unit: m, range: [-1, 1]}
  y: {unit: m, range: [-1, 1]}
  a: {unit: rad, range: [-1, 1]}
  b: {unit: rad, range: [-1, 1]}
  c: {unit: rad, range: [-1, 1]}
  d: {unit: m, range: [0.2, 1]}
parameters:
  l: {value: 0.4, unit: m}
  m: {value: 1.5, unit: kg}
  J: {value: 0.02, unit: kg*m**2}
  g: {value: 9.81, unit: m/s**2}
gravity: [0, 0, -g]
frames:
  base: {translation: [x, y, 0], rotation: [[z, a]]}
  wrist: {parent: base, translation: [l, 0, l/2], rotation: [[y, b], [x, c]]}
  slide: {parent: wrist, translation: [l, 0, d]}
bodies:
  base: {mass: 2*m, com: [l/3, l/5, 0], inertia: {xx: J, yy: 2*J, zz: 2*J, xy: J/5}}
  wrist: {mass: m, com: [0, l/2, l/3], inertia: {xx: J, yy: 2*J, zz: 1.5*J, yz: J/7}}
  slide: {mass: m, com: [0, 0, l], inertia: {xx: J, yy: J, zz: J}}
points:
  tip: {frame: slide, at: [l/2, 0, l/4]}
constraints:
  geometric:
    height: tip.z - l
    gear: b - 2*c
  nonholonomic:
    skate: base.vy*cos(a) - base.vx*sin(a)
inputs:
  u: {unit: N, joint: d}
rotor_inertias:
  c: J/10
"""


# a cart with a stack of slides and turns about one axis that branches; points of two branches meet, one keeps a place
PLANE = """model: plane
coordinates:
  x: {unit: m, range: [-1, 1]}
  y: {unit: m, range: [-1, 1]}
  a: {unit: rad, range: [-1, 1]}
  s: {unit: m, range: [0.2, 1]}
  b: {unit: rad, range: [-1, 1]}
  c: {unit: rad, range: [-1, 1]}
  d: {unit: rad, range: [-1, 1]}
  e: {unit: rad, range: [-1, 1]}
parameters:
  l: {value: 0.4, unit: m}
  m: {value: 1.5, unit: kg}
  J: {value: 0.02, unit: kg*m**2}
  g: {value: 9.81, unit: m/s**2}
gravity: [g/3, 0, -g]
frames:
  ramp: {translation: [0, l, 0], rotation: [[y, 0.4]]}
  cart: {parent: ramp, translation: [x, l, y], rotation: [[y, a]]}
  slide: {parent: cart, translation: [l, 0, s*s/l]}
  elbow: {parent: slide, translation: [0, l/2, l], rotation: [[y, -b]]}
  tail: {parent: elbow, translation: [l, l/3, l/5], rotation: [[y, c]]}
  leg: {parent: cart, translation: [-l, 0, l/4], rotation: [[y, d]]}
  foot: {parent: leg, translation: [0, 0, -l], rotation: [[y, e]]}
bodies:
  cart: {mass: 2*m, com: [l/3, l/5, 0], inertia: {xx: J, yy: 2*J, zz: 2*J, xy: J/5}}
  elbow: {mass: m, com: [l/2, 0, l/7], inertia: {xx: J, yy: J, zz: J, xz: J/5}}
  tail: {mass: 3*m, com: [0, l/2, l/3], inertia: {xx: J, yy: 2*J, zz: 1.5*J, yz: J/7}}
  leg: {mass: m, com: [0, 0, -l/2], inertia: {xx: J, yy: J, zz: J}}
  foot: {mass: m/3, com: [l/9, 0, -l/2], inertia: {xx: J, yy: J, zz: J}}
points:
  tip: {frame: tail, at: [l/2, 0, l/4]}
  toe: {frame: foot, at: [l, l, -l/8]}
constraints:
  geometric:
    across: tip.x - 2*toe.x
    along: tip.z - 2*toe.z
    held: toe.z - l
    gear: b - 2*c
inputs:
  u: {unit: N, joint: s}
  v: {unit: N*m, joint: d}
rotor_inertias:
  c: J/10
"""

# the tip stays at a place of the world, in place of a height only
HELD = """to_x: tip.x - l
    to_y: tip.y
    to_z: tip.z - l"""

FREE = """model: free
coordinates:
  psi: {unit: rad, range: [-1, 1]}
  x: {unit: m, range: [-1, 1]}
  theta: {unit: rad, range: [-1, 1]}
  y: {unit: m, range: [-1, 1]}
  z: {unit: m, range: [-1, 1]}
  phi: {unit: rad, range: [-1, 1]}
  a: {unit: rad, range: [-1, 1]}
parameters:
  l: {value: 0.4, unit: m, range: [0.1, 1]}
  m: {value: 1.5, unit: kg, range: [1, 2]}
  J: {value: 0.2, unit: kg*m**2, range: [0.1, 1]}
  g: {value: 9.81, unit: m/s**2}
gravity: [0, 0, -g]
frames:
  craft: {translation: [x, y, z], rotation: [[z, psi], [y, theta], [x, phi]]}
  flap: {parent: craft, translation: [l, 0, l/2], rotation: [[y, a]]}
bodies:
  craft: {mass: 2*m, com: [l/3, l/5, 0], inertia: {xx: J, yy: 2*J, zz: 2*J, xy: J/5}}
  flap: {mass: m, com: [0, l/2, l/3], inertia: {xx: J, yy: 2*J, zz: 1.5*J, yz: J/7}}
points:
  tip: {frame: flap, at: [l/2, 0, l/4]}
constraints:
  geometric:
    height: 2*tip.z - l
inputs:
  u: {unit: N, joint: x}
  v: {unit: N*m, joint: psi}
  w: {unit: N*m, joint: phi}
"""

# A stirrer with its centre of mass on an oblique axis, on a turntable that is held: no weight does work.
STIRRER = """model: stirrer
coordinates: {turn: {unit: rad, range: [-3, 3]}, stir: {unit: rad, range: [-3, 3]}}
parameters: {m: {value: 3, unit: kg}, g: {value: 9.81, unit: m/s**2}, hold: {value: 0.4, unit: rad}}
gravity: [0, 0, -g]
joints:
  table: {type: revolute, axis: z, coordinate: turn}
  stirrer: {type: revolute, parent: table, at: [0.3, 0, 0.2], axis: [1, 2, 2], coordinate: stir}
bodies:
  table: {mass: 9, com: [0.1, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.2}}
  stirrer: {mass: m, com: COM, inertia: {xx: 0.04, yy: 0.041, zz: 0.06}}
constraints: {geometric: {brake: turn - hold}}
outputs: [forward_dynamics, multipliers]
"""


def compared(model: Model) -> float:
    """The largest relative difference of the two methods over a few states off and on the constraints."""
    generic = genericity(System(model))
    derived = articulated(model, generic)
    assert derived is not None
    seen, motion = derived
    mechanics = System(model)
    dense = schur_qr(Problem(mechanics, ()), mechanics.r)
    one = Evaluator([*motion.accelerations, *motion.multipliers])
    other = Evaluator([*dense.accelerations, *dense.multipliers])
    source = random.Random(model.name)
    worst = 0.0
    for _ in range(3):
        point = dict(parameter_values(mechanics))
        for c in model.coordinates:
            point[c.name] = source.uniform(float(c.range[0]), float(c.range[1]))
            point[c.rate] = source.uniform(-1, 1)
        point |= {control.name: source.uniform(-1, 1) for control in model.inputs}
        values, expected = one(point), other(point)
        size = max(map(abs, expected))
        worst = max(worst, *(abs(a - b) / size for a, b in zip(values, expected, strict=True)))
    assert seen.model is model
    return worst


@pytest.mark.campaign
@pytest.mark.parametrize("name", NAMES)
def test_shipped_mechanisms(name: str) -> None:
    assert compared(shipped.model(name)) < 1e-9


def test_joints_of_several_coordinates_gears_and_skates(tmp_path: Path) -> None:
    path = tmp_path / "joints.yaml"
    path.write_text(JOINTS, encoding="utf-8")
    assert compared(load_model(path)) < 1e-9


def test_a_free_body_that_is_driven_by_its_coordinates(tmp_path: Path) -> None:
    """Forces of the coordinates are brought to its axes, accelerations back; the pitch must stay off 90 degrees."""
    path = tmp_path / "free.yaml"
    path.write_text(FREE, encoding="utf-8")
    model = load_model(path)
    assert compared(model) < 1e-9
    derived = articulated(model, genericity(System(model)))
    assert derived is not None
    last = Evaluator([derived[1].guards[-1].denominator])
    assert abs(last({"theta": 1.2})[0]) == pytest.approx(math.cos(1.2))


@pytest.mark.parametrize(("com", "weighs"), [("[0, 0, 0]", False), ("[0.1, 0.2, 0.2]", False), ("[0, 0.1, 0]", True)])
def test_weights_that_do_no_work_leave_no_rounding(com: str, weighs: bool, tmp_path: Path) -> None:
    """Turned to the oblique axis and back, they would drown the torque of the brake near rest."""
    path = tmp_path / "stirrer.yaml"
    path.write_text(STIRRER.replace("COM", com), encoding="utf-8")
    model = load_model(path)
    assert compared(model) < 1e-9
    derived = articulated(model, genericity(System(model)))
    assert derived is not None
    outputs = (*derived[1].accelerations, *derived[1].multipliers)
    assert ("g" in {str(node.payload) for node in reached(outputs) if node.op == "symbol"}) is weighs


def test_a_loop_in_space_beside_other_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its rows are taken along other axes than the world's; those of the gear and the skate stay what they are."""
    chosen = []

    def best_axes(*given: Any) -> Any:
        chosen.append(along_best_axes(*given))
        return chosen[-1]

    along_best_axes = by_frames._along_best_axes
    monkeypatch.setattr(by_frames, "_along_best_axes", best_axes)
    path = tmp_path / "held.yaml"
    path.write_text(JOINTS.replace("height: tip.z - l", HELD), encoding="utf-8")
    assert compared(load_model(path)) < 1e-9
    assert [frame for frame, _ in chosen] == ["slide"]


def test_accelerations_joint_by_joint_in_a_plane(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Weights are an acceleration of the ramp, which rows whose weights do not add up to 0 must not see."""
    taken = []

    def by_joints(*given: Any) -> Any:
        taken.append(joint_accelerations.by_joints(*given))
        return taken[-1]

    monkeypatch.setattr(by_frames, "by_joints", by_joints)
    path = tmp_path / "plane.yaml"
    path.write_text(PLANE, encoding="utf-8")
    assert compared(load_model(path)) < 1e-9
    path.write_text(PLANE.replace("gear: b - 2*c", "far: (tip.x - toe.x)**2 - l**2"), encoding="utf-8")
    assert compared(load_model(path)) < 1e-9
    assert [made is not None for made in taken] == [True, False]


@pytest.mark.parametrize("text", [FREE, JOINTS])
def test_loops_in_space_by_accelerations_of_points(tmp_path: Path, text: str) -> None:
    """Those of q_ddot = 0 without gravity, which the recursion holds with gravity taken off."""
    path = tmp_path / "loop.yaml"
    path.write_text(text, encoding="utf-8")
    mechanics, plain = (System(load_model(path)) for _ in range(2))
    (loop,) = loop_points(mechanics)
    assert loop.rows == {2: 0}
    rest = (mechanics.graph.zero,) * mechanics.n
    motions = frame_motions(mechanics.bodies, mechanics.qd, rest, mechanics.bodies.gravity)
    expected = plain.constraint_acceleration_bias(plain.qd)[0]
    source = random.Random(7)
    point = parameter_values(plain) | {str(x.payload): source.uniform(-1, 1) for x in (*plain.q, *plain.qd)}
    for axes in (WORLD, *loop.frames):
        along = acceleration(mechanics, motions, loop, axes)
        component = applied(mechanics.bodies.kinematics.axes(axes), along)[2]
        assert Evaluator([component])(point)[0] == pytest.approx(Evaluator([expected])(point)[0], rel=1e-12)


@pytest.mark.parametrize("name", ["gough_stewart", "skate"])
def test_systems_without_that_method(name: str) -> None:
    """Coordinates that move no frame, an energy without frames."""
    model = shipped.model(name)
    assert articulated(model, genericity(System(model))) is None


def test_a_centre_of_mass_at_a_distance_of_1(tmp_path: Path) -> None:
    """What a slide passes on has an arm that is 1, as its own direction is."""
    path = tmp_path / "joints.yaml"
    path.write_text(JOINTS.replace("com: [0, 0, l]", "com: [-1, 1, 1]"), encoding="utf-8")
    assert compared(load_model(path)) < 1e-9
