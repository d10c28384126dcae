"""u asks nothing of rows that inputs do not load: of other coordinates, or of the length of a quaternion."""

from __future__ import annotations

import numpy as np
import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.ir.kernel import Status
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.driven_blocks import where_inputs_act
from symgen.model.load import load_text
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import State

# A board on two axles that turn against it, with a flywheel; no input works on what the rows hold.
BOARD = """
model: board
coordinates: {{x: {{unit: m}}, y: {{unit: m}}, a: {{unit: rad}}, w: {{unit: rad}}, f: {{unit: rad}}, h: {{unit: rad}}}}
parameters: {{m: {{value: 6}}, l: {{value: 0.2}}, J: {{value: 0.1}}}}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2) + J/2*a_dot**2 + 0.02/2*(a_dot + w_dot)**2
  + 0.002/2*((a_dot + f_dot)**2 + (a_dot + h_dot)**2)
constraints:
  nonholonomic:
    front: cos(a + f)*y_dot - sin(a + f)*x_dot + l*cos(f)*a_dot
    back: cos(a + h)*y_dot - sin(a + h)*x_dot - l*cos(h)*a_dot
inputs: {{flywheel: {{acts_on: {{w: 1}}}}, steer: {{acts_on: {{f: 1}}}}, {last}}}
outputs: [inverse_dynamics]
"""
# Two rods that close over a slide each: one is driven, the other follows a spring.
PAIR = """
model: pair
coordinates: {{a: {{unit: rad}}, x: {{unit: m}}, b: {{unit: rad}}, y: {{unit: m}}, s: {{unit: m}}}}
kinetic_energy: a_dot**2/2 + 3*x_dot**2/2 + b_dot**2/2 + 5*(y_dot + s_dot)**2/2 + s_dot**2/2
potential_energy: 20*(y - x - s)**2
constraints:
  geometric:
    first: x - 2*cos(a)
    second: y - 3*cos(b)
inputs: {{push: {{acts_on: {{{on}: 1}}}}}}
outputs: [inverse_dynamics]
configuration: {{a: 1, x: 1.0806046117362795, b: 0.7, y: 2.2945265618534655}}
"""


def statuses(text: str) -> set[Status]:
    model = load_text(text, "model.yaml")
    (kernel,) = draft_of(model, model.outputs, Options()).programs["float64"].kernels
    return {check.status for block in kernel.blocks for check in block.checks}


def test_u_of_what_no_row_holds_has_no_rank_to_test() -> None:
    """The axles may be parallel, where the rows depend on each other: u is right there."""
    model = load_text(BOARD.format(last="other: {acts_on: {h: 1}}"), "board.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    (kernel,) = program.kernels
    assert not [check for block in kernel.blocks for check in block.checks]
    assert not any(statement.operation in ("sincos", "div") for statement in kernel.statements)
    quarter = 1.5707963267948966
    state = State((0.0, 0.0, 0.3, 0.1, quarter, quarter), (0.0,) * 6, (1.0, 2.0, 3.0, 4.0, 5.0, 6.0), (), (6, 0.2, 0.1))
    (outcome,) = outcomes(kernel, program.sincos, "float64", [state])
    assert outcome.status == Status.OK
    assert outcome.entries == pytest.approx([0.02 * 7, 0.002 * 8, 0.002 * 9], rel=1e-15)


def test_an_input_on_what_rows_hold_keeps_their_test() -> None:
    assert Status.ACTUATION_RANK in statuses(BOARD.format(last="push: {acts_on: {x: cos(a), y: sin(a)}}"))


@pytest.mark.parametrize(("on", "kept"), [("a", ("first",)), ("y", ("second",)), ("s", ())])
def test_rows_of_blocks_that_an_input_acts_in_are_kept(on: str, kept: tuple[str, ...]) -> None:
    model = load_text(PAIR.format(on=on), "pair.yaml")
    driven_part = where_inputs_act(model, genericity(System(model)))
    assert driven_part is not None
    smaller, generic = driven_part
    assert tuple(row.name for row in smaller.constraints) == kept
    assert (generic.r, generic.rank, generic.geometric_rank, generic.delta) == (len(kept),) * 3 + (5 - len(kept),)
    assert bool(statuses(PAIR.format(on=on))) == bool(kept)


def test_inputs_that_span_all_motions_keep_all_rows() -> None:
    """A crank that rows hold still, beside a driven one: methods for full actuation are shorter."""
    text = """
model: held
coordinates: {a: {unit: rad}, b: {unit: rad}}
kinetic_energy: a_dot**2/2 + b_dot**2/2
constraints: {geometric: {still: b - 0.5}}
inputs: {drive: {acts_on: {a: 1}}}
configuration: {b: 0.5}
"""
    model = load_text(text, "held.yaml")
    assert where_inputs_act(model, genericity(System(model))) is None


# A hull that flies, driven along and about its own axes.
HULL = """
model: hull
parameters: {{m: {{value: 2}}, J_x: {{value: 0.02}}, J_y: {{value: 0.03}}, J_z: {{value: 0.05}}}}
gravity: [0, 0, -9.81]
joints: {{hull: {{type: floating, coordinates: [x, y, z, e0, e1, e2, e3]}}}}
bodies: {{hull: {{mass: m, inertia: {{xx: J_x, yy: J_y, zz: J_z}}}}}}
points: {{c: {{frame: hull}}}}
inputs:
{forces}
  roll: {{torque_on: hull, direction: [1, 0, 0], axes: hull}}
  pitch: {{torque_on: hull, direction: [0, 1, 0], axes: hull}}
  yaw: {{torque_on: hull, direction: [0, 0, 1], axes: hull}}
outputs: [inverse_dynamics]
"""
THRUST = "  thrust: {point: c, direction: [0, 0, 1], axes: hull}"
ALL_FORCES = "\n".join(
    f"  {name}: {{point: c, direction: {axis}, axes: hull}}"
    for name, axis in (("surge", [1, 0, 0]), ("sway", [0, 1, 0]), ("heave", [0, 0, 1]))
)


@pytest.mark.parametrize(("forces", "most"), [(THRUST, 150), (ALL_FORCES, 175)])
def test_torques_on_a_flying_body_are_those_of_euler(forces: str, most: int) -> None:
    """By Newton's and Euler's equations in body axes, whether the inputs span all motions or not."""
    model = load_text(HULL.format(forces=forces), "hull.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    (kernel,) = program.kernels
    assert len(kernel.statements) < most
    dice = np.random.default_rng(3)
    e, spin, turned, place = (dice.uniform(-1, 1, size) for size in (4, 3, 3, 3))
    e /= np.linalg.norm(e)
    w, x, y, z = e
    to_rates = np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]]).T / 2
    rates = to_rates @ spin
    # e'' of a given angular acceleration: half of its product with e, and the length stays 1
    rates_dot = to_rates @ turned - (spin @ spin) / 4 * e
    axes = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])
    inertia = np.array([0.02, 0.03, 0.05])
    force = 2 * axes.T @ (place + np.array([0, 0, 9.81]))
    torque = inertia * turned + np.cross(spin, inertia * spin)
    state = State((0.1, 0.2, 0.3, *e), (0.4, 0.5, 0.6, *rates), (*place, *rates_dot), (), (2.0, *inertia))
    (outcome,) = outcomes(kernel, program.sincos, "float64", [state])
    assert outcome.status == Status.OK
    assert outcome.entries == pytest.approx([*(force if forces == ALL_FORCES else force[2:]), *torque], rel=1e-12)


def test_inputs_that_are_one_more_than_they_span_are_shared_by_their_norm() -> None:
    """Two thrusters in a line: the inputs are not independent, so that the rows stay."""
    text = HULL.format(forces=f"{THRUST}\n{THRUST.replace('thrust', 'booster')}")
    model = load_text(text, "hull.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    state = State((0.0,) * 3 + (1.0,) + (0.0,) * 3, (0.0,) * 7, (0.0,) * 7, (), (2.0, 0.02, 0.03, 0.05))
    (outcome,) = outcomes(program.kernels[0], program.sincos, "float64", [state])
    assert outcome.entries == pytest.approx([9.81, 9.81, 0, 0, 0], abs=1e-12)
