"""Rows by what they hold: their derivatives are those of the rows as they stand, exactly, in a field."""

from __future__ import annotations

import pytest

from symgen.mechanics.absolute_angles import AbsoluteAngles
from symgen.mechanics.held_rows import HeldRows, acceleration_bias
from symgen.mechanics.system import System
from symgen.model.blocks.loops import JOINED
from symgen.model.load import load_text
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.matrix import flatten, matvec
from symgen.symbolic.traverse import cost

# A plate with a ball joint, and rods at three of its points.
PLATE = """
model: plate
parameters: {m: {value: 2}}
joints: {plate: {type: floating, coordinates: [x, y, z, e0, e1, e2, e3]}}
bodies: {plate: {mass: m, inertia: {xx: 1, yy: 2, zz: 3}}}
points:
  one: {frame: plate, at: [1, 0, 0.1]}
  two: {frame: plate, at: [0, 1, 0.2]}
  three: {frame: plate, at: [-1, -1, 0.3]}
constraints:
  geometric:
    rod_1: (one.x - 1)**2 + one.y**2 + (one.z + 2)**2 - 4
    rod_2: two.x**2 + (two.y - 1)**2 + (two.z + 2)**2 - 4
    rod_3: three.x*three.y - three.z - 1
configuration: {x: 0, y: 0, z: 0, e0: 1, e1: 0, e2: 0, e3: 0}
inputs: {push: {acts_on: {x: 1}}}
"""
# Two arms on a turning base, whose ends meet: what is seen from one moves with its own joints, too.
ARMS = """
model: arms
parameters: {{m: {{value: 2}}, l: {{value: 0.7}}}}
joints:
  base: {{type: revolute, axis: [1, 2, 2], coordinate: a_0}}
  left_1: {{type: revolute, parent: base, axis: y, at: [0.4, 0, 0.1], rotation: [[x, 0.3]], coordinate: a_1}}
  left_2: {{type: revolute, parent: left_1, axis: [1, 0, 1], at: [0, 0, l], coordinate: a_2}}
  left_3: {{type: prismatic, parent: left_2, axis: z, at: [0, 0.1, l], coordinate: s_3}}
  right_1: {{type: revolute, parent: base, axis: x, at: [-0.3, 0, 0], coordinate: b_1}}
  cross: {{type: revolute, parent: right_1, axis: y, at: [0, 0.2, l], coordinate: b_2}}
  right_2: {{type: revolute, parent: cross, axis: z, coordinate: b_3}}
  right_3: {{type: revolute, parent: right_2, axis: z, at: [0, 0, l], coordinate: b_4}}
bodies: {{base: {{mass: 1}}}}
rotor_inertias: {{a_0: m, a_1: m, a_2: m, s_3: m, b_1: m, b_2: m, b_3: m, b_4: m}}
points: {{tip: {{frame: left_3, at: [0.1, 0, l]}}}}
definitions: {{reach: tip.x - l*tip.y}}
{rows}
inputs: {{push: {{joint: a_1}}}}
"""
ROWS = {
    **{kind: f"loops: {{ends: {{type: {kind}, between: [left_3, right_3], axis: y}}}}" for kind in JOINED},
    "definitions, products, coordinates": "constraints: {geometric: {both: reach*tip.z - sin(a_1)*reach - left_2.z}}",
}


@pytest.mark.parametrize("still", [True, False])
def test_the_velocity_stands_still_whatever_it_is_made_of(still: bool) -> None:
    mechanics = System(load_text(PLATE, "plate.yaml"))
    graph = mechanics.graph
    velocity = mechanics.qd
    if not still:
        velocity = tuple(a * graph.trig("sin", b) + a for a, b in zip(mechanics.qd, mechanics.q, strict=True))
    plain = matvec(graph, mechanics.constraint_jacobian_dot(velocity), velocity)
    with every_identity_evaluated():
        same_values("rows by places", plain, mechanics.held_rows.bias(velocity))
        same_values("rows by places", plain, acceleration_bias(mechanics, velocity))


@pytest.mark.parametrize("rows", ROWS.values(), ids=ROWS)
@pytest.mark.parametrize("relative", [True, False])
def test_places_and_directions_seen_from_frames_that_move(rows: str, relative: bool) -> None:
    mechanics = System(load_text(ARMS.format(rows=rows), "arms.yaml"))
    if not relative:
        mechanics = System(mechanics.model, mechanics, AbsoluteAngles((None, 0, 1, None, 0, 4, 5, 6)))
    graph, held = mechanics.graph, HeldRows(mechanics)
    plain = [gradient(graph, row, mechanics.q) for row in mechanics.constraint_residual]
    with every_identity_evaluated():
        same_values("slopes of rows", flatten(plain), flatten(held.jacobian))
        rates = matvec(graph, mechanics.constraint_jacobian_dot(mechanics.qd), mechanics.qd)
        same_values("rows along rates", rates, held.bias(mechanics.qd))
    assert held.leaves


@pytest.mark.campaign
def test_long_loops_in_space_are_differentiated_joint_by_joint() -> None:
    """Ten oblique joints, closed by another one: a sweep through the whole loop for each row costs far more."""
    chain = "\n".join(
        f"  j_{k}: {{type: revolute, parent: {'world' if k == 0 else f'j_{k - 1}'}, at: [0.1, 0, l], "
        f"axis: {['[0, 1, 1]', 'x', '[1, 2, 3]'][k % 3]}, coordinate: a_{k}}}"
        for k in range(10)
    )
    text = f"""
model: loop
parameters: {{l: {{value: 0.4}}}}
frames: {{dock: {{translation: [0.3, 0.2, 0.9]}}}}
joints:
{chain}
bodies: {{j_0: {{mass: 1}}}}
rotor_inertias: {{{', '.join(f'a_{k}: 1' for k in range(10))}}}
loops: {{last: {{type: prismatic, between: [j_9, dock], axis: z}}}}
inputs: {{push: {{joint: a_0}}}}
"""
    mechanics = System(load_text(text, "loop.yaml"))
    graph = mechanics.graph
    swept = tuple(tuple(gradient(graph, row, mechanics.q)) for row in mechanics.constraint_residual)
    jacobian, bias = mechanics.constraint_jacobian, mechanics.constraint_acceleration_bias(mechanics.qd)
    motion = dict(zip(mechanics.q, mechanics.qd, strict=True))
    plain = derivative_along(graph, matvec(graph, swept, mechanics.qd), motion)
    with every_identity_evaluated():
        same_values("slopes of rows", flatten(swept), flatten(jacobian))
        same_values("rows along rates", plain, bias)
    assert cost(flatten(jacobian)).weight < 2 / 3 * cost(flatten(swept)).weight
    assert cost(bias).weight < 2 / 5 * cost(plain).weight
