"""Inertias that no single link can have, as identified values often are: told, and right where G is definite."""

from __future__ import annotations

import pytest
from laws_harness import System

from symgen.diagnostics import ModelError
from symgen.model.load import load_text
from symgen.verify.sampling.states import sample_states

ARM = """\
model: identified_arm
gravity: [0, 0, -9.81]
joints:
  waist: {type: revolute, axis: z, coordinate: a}
  shoulder: {type: revolute, parent: waist, axis: y, at: [0, 0, 0.4], coordinate: b}
  elbow: {type: revolute, parent: shoulder, axis: y, at: [0.5, 0.1, 0], coordinate: c}
bodies:
  waist: {mass: 20, inertia: {zz: 1.1}}
  shoulder: {mass: 15, com: [-0.3, 0, 0.1], inertia: {xx: 0.1, yy: 0.5, zz: 1.4}}
  elbow: {mass: 4, com: [0.1, 0, 0.2], inertia: {xx: 0.2, yy: 0.3, zz: NEGATIVE, xz: 0.05}}
inputs:
  t_a: {unit: N*m, joint: a}
  t_b: {unit: N*m, joint: b}
  t_c: {unit: N*m, joint: c}
"""
OUTPUTS = ("inverse_dynamics", "forward_dynamics")

# T is negative where x and y move against each other, which the row forbids
ACROSS = """\
model: negative_across_the_row
coordinates: {x: {}, y: {}, a: {unit: rad}}
kinetic_energy: x_dot**2 + y_dot**2 + 3*x_dot*y_dot + a_dot**2 + sin(a)/5*a_dot*x_dot
potential_energy: cos(a)*x
constraints: {geometric: {slide: x - y - sin(a)/20}}
inputs: {push: {acts_on: {x: 1}}, turn: {acts_on: {a: 1}}}
outputs: all
"""


def messages(text: str) -> list[str]:
    return [notice.message.split(":")[0] for notice in load_text(text, "arm.yaml").notices]


@pytest.mark.parametrize("moment", ["0.6", "-0.3"])
def test_an_identified_arm_is_generated_and_its_links_are_told(moment: str) -> None:
    text = ARM.replace("NEGATIVE", moment)
    expected = ["the inertia of `shoulder` violates the triangle inequality"]
    expected += ["the inertia of `elbow` has a negative principal moment, -0.304951"] if moment == "-0.3" else []
    notices = messages(text)
    assert notices[: len(expected)] == expected
    system = System(text, OUTPUTS)
    for sample in sample_states(system.reference, OUTPUTS, 8):
        system.assert_right(sample.state, OUTPUTS)


def test_an_arm_that_gains_speed_against_its_drives_is_refused_at_its_link() -> None:
    text = ARM.replace("yy: 0.3", "yy: -0.9").replace("NEGATIVE", "0.3")
    with pytest.raises(ModelError) as raised:
        load_text(text, "arm.yaml")
    (mistake,) = raised.value.mistakes
    assert "the negative principal moment of `elbow` is not made up for" in mistake.message
    assert mistake.span is not None
    assert (mistake.span.line, mistake.span.column) == (10, 54)


def test_energy_that_is_negative_only_for_what_constraints_forbid_is_a_notice() -> None:
    assert any(message.startswith("the kinetic energy is negative for some") for message in messages(ACROSS))
    system = System(ACROSS)
    for sample in sample_states(system.reference, system.names, 8):
        system.assert_right(sample.state)
