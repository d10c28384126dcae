"""Loops on a frame that moves: their rows know nothing of how it does."""

from __future__ import annotations

import pytest

from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import expectations

# a boom on a turret that slews and travels, lifted by a jack; AXIS is that of its pins
CRANE = """\
model: crane
joints:
  travel: {type: prismatic, axis: x, coordinate: way}
  slew: {type: revolute, parent: travel, child: turret, axis: z, at: [0, 0, 1.1], coordinate: turn}
  foot: {type: revolute, parent: turret, child: boom, axis: y, at: [0.2, 0, 0.3], coordinate: a}
  trunnion: {type: revolute, parent: turret, child: tube, axis: AXIS, at: [0.9, 0, 0.1], coordinate: e}
  rod: {type: prismatic, parent: tube, axis: x, coordinate: s}
parameters:
  m: {value: 300, unit: kg}
bodies:
  travel: {mass: 900}
  turret: {mass: 500, com: [-0.3, 0, 0], inertia: {xx: 90, yy: 90, zz: 150}}
  boom: {mass: m, com: [1.4, 0, 0.1], inertia: {xx: 5, yy: 200, zz: 200}}
  tube: {mass: 40, com: [0.3, 0, 0], inertia: {xx: 1, yy: 4, zz: 4}}
  rod: {mass: 20, com: [-0.3, 0, 0], inertia: {yy: 2, zz: 2}}
gravity: [0, 0, -9.81]
points:
  ear: {frame: boom, at: [1.6, 0, -0.2]}
LOOP
inputs: {lift: {unit: N, joint: s}, slewing: {unit: N*m, joint: turn}}
configuration: {a: -0.5, e: -1.1, s: 1.1, way: 0.4, turn: 0.7}
ranges: {a: [-0.8, -0.2], e: [-1.6, 1.6], s: [0.5, 2]}
outputs: [inverse_dynamics, forward_dynamics]
"""
LOOPS = {
    "point": "loops: {eye: {type: point, between: [rod, ear]}}",
    "distance": "loops: {eye: {type: distance, between: [tube, ear], length: 1.2}}",
    "prismatic": "loops: {eye: {type: prismatic, between: [boom, rod], axis: x}}",
    "revolute": "loops: {eye: {type: revolute, between: [rod, boom], axis: y}}",
}
IN_WORLD = """\
constraints: {geometric: {eye_x: rod.x - ear.x, eye_y: rod.y - ear.y, eye_z: rod.z - ear.z}}
"""


def crane(loop: str, axis: str = "y") -> Model:
    return load_text(CRANE.replace("LOOP", loop).replace("AXIS", axis), "crane.yaml")


@pytest.mark.parametrize("axis", ["y", "[0, -1, 0]", "[0, 2, 0]"])
def test_rows_across_the_plane_and_of_the_carrier_are_left_out(axis: str) -> None:
    model = crane(LOOPS["point"], axis)
    assert [row.name for row in model.constraints] == ["eye_x", "eye_z"]
    (b,) = derive_quantities(model, ["constraint_jacobian"]).quantities
    names = [c.name for c in model.coordinates]
    assert all(b.outputs[i * model.n + names.index(name)].is_zero for i in range(2) for name in ("way", "turn"))


def test_motion_is_that_with_rows_of_the_world() -> None:
    plane, world = crane(LOOPS["point"]), crane(IN_WORLD)
    assert (plane.r, world.r) == (2, 3)
    references = Reference(plane), Reference(world)
    assert references[0].ranks == references[1].ranks
    admissible = [sample for sample in sample_states(references[0], plane.outputs, 16) if sample.admissible]
    assert len(admissible) >= 4
    for sample in admissible:
        one, other = (r.matrices(sample.state, ["forward_dynamics"])["forward_dynamics"] for r in references)
        assert all(float(x) == pytest.approx(float(y), rel=1e-12) for x, y in zip(one, other, strict=True))


def test_in_space_rows_know_nothing_of_the_carrier_either() -> None:
    wrist = "joints:\n  wrist: {type: revolute, parent: boom, axis: x, coordinate: tilt}"
    text = CRANE.replace("LOOP", LOOPS["point"]).replace("AXIS", "y").replace("joints:", wrist, 1)
    model = load_text(text.replace("ear: {frame: boom,", "ear: {frame: wrist,"), "crane.yaml")
    assert [row.name for row in model.constraints] == ["eye_x", "eye_y", "eye_z"]
    (b,) = derive_quantities(model, ["constraint_jacobian"]).quantities
    names = [c.name for c in model.coordinates]
    assert all(b.outputs[i * model.n + names.index(name)].is_zero for i in range(3) for name in ("way", "turn"))


# a ball joint and a slide on an arm: two rods and a pin hold them, so that the arm alone moves
HELD = """\
model: held
joints:
  arm: {type: revolute, axis: [0, 1, 1], coordinate: a}
  ball: {type: spherical, parent: arm, at: [0, 0.5, 0], coordinates: [e_0, e_1, e_2, e_3]}
  stem: {type: prismatic, parent: ball, at: [0, 0.9, 0], axis: [1, 2, 3], coordinate: s}
  slide: {type: prismatic, parent: arm, at: [0, 0.5, 0], axis: x, coordinate: w}
bodies:
  ball: {mass: 1, com: [0, 0.4, 0], inertia: {xx: 0.06, yy: 0.02, zz: 0.05}}
  slide: {mass: 4, com: [0, 0, 0.3], inertia: {xx: 0.1, yy: 0.05, zz: 0.05}}
points:
  tip: {frame: stem, at: [0.2, 0, 0]}
  pin: {frame: slide, at: [0.1, 0.4, 1.4]}
  end: {frame: ball, at: [0, 0.9, 0]}
  left: {frame: slide, at: [-0.6, 0.6, 0.3]}
  right: {frame: slide, at: [-0.6, -0.2, 1.5]}
loops:
  shut: {type: point, between: [tip, pin]}
  rod_1: {type: distance, between: [end, left], length: 1.1}
  rod_2: {type: distance, between: [end, right], length: 1.3}
outputs: [nullspace_projector_dot]
"""


def test_what_is_held_on_a_carrier_has_no_rate_of_its_projector() -> None:
    """N_B is that of the arm alone wherever the rows are independent: its rate is 0, not a rounding."""
    model = load_text(HELD, "held.yaml")
    (rate,) = derive_quantities(model, model.outputs).quantities
    assert all(entry.is_zero for entry in rate.outputs)


@pytest.mark.parametrize("loop", LOOPS)
def test_kernels_are_those_of_the_reference(loop: str) -> None:
    model = crane(LOOPS[loop])
    reference = Reference(model)
    derived = derive_quantities(model, model.outputs, {"forward_dynamics": "articulated_refined"}).quantities
    for sample in sample_states(reference, model.outputs, 8):
        state, coordinates = sample.state, model.coordinates
        values = dict(zip((c.name for c in coordinates), state.q, strict=True))
        values |= zip((c.rate for c in coordinates), state.qd, strict=True)
        values |= zip((c.acceleration for c in coordinates), state.qdd, strict=True)
        values |= zip((i.name for i in model.inputs), state.u, strict=True)
        values |= zip((p.name for p in model.parameters), state.parameters, strict=True)
        expected = expectations(reference, state, model.outputs, "float64", "carriers")
        for quantity in derived:
            entries = Evaluator(quantity.outputs)(values)
            one = expected[quantity.name]
            assert one.in_units(one.distance(list(entries))) <= 16
