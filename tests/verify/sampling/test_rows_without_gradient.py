"""Rows that have no gradient anywhere on V, where others hold what they say."""

from __future__ import annotations

from symgen.model.load import load_text
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states

# a body on a ball joint whose second point is held as well: along the line of both points nothing is left to hold
DOOR = """
model: door
joints:
  hinge: {type: spherical, coordinates: [e_0, e_1, e_2, e_3]}
bodies:
  hinge: {mass: 4, com: [0.1, 0.3, 0], inertia: {xx: 0.2, yy: 0.1, zz: 0.3}}
points:
  top: {frame: hinge, at: [0, 0, 0.8]}
  bolt: {at: [0, 0, 0.8]}
loops:
  second: {type: point, between: [top, bolt]}
inputs:
  closer: {torque_on: hinge, direction: [0, 0, 1]}
"""


def test_states_of_a_door_on_two_points_are_found() -> None:
    reference = Reference(load_text(DOOR, "door.yaml"))
    assert (reference.ranks.constraints, reference.model.r) == (3, 4)
    samples = sample_states(reference, ("inverse_dynamics",), 8)
    assert len(samples) == 8
    for sample in samples:
        assert abs(sample.state.q[1]) < 1e-15
        assert abs(sample.state.q[2]) < 1e-15
