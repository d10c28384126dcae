"""What rows that hold several points of a frame ask of accelerations, along any velocity: exactly, in a field."""

from __future__ import annotations

import pytest

from symgen.mechanics.places import acceleration_bias
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.matrix import matvec

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


@pytest.mark.parametrize("still", [True, False])
def test_the_velocity_stands_still_whatever_it_is_made_of(still: bool) -> None:
    mechanics = System(load_text(PLATE, "plate.yaml"))
    graph = mechanics.graph
    velocity = mechanics.qd
    if not still:
        velocity = tuple(a * graph.trig("sin", b) + a for a, b in zip(mechanics.qd, mechanics.q, strict=True))
    plain = matvec(graph, mechanics.constraint_jacobian_dot(velocity), velocity)
    with every_identity_evaluated():
        same_values("rows by places", plain, acceleration_bias(mechanics, velocity))
