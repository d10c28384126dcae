"""Masses on the axis that their frame turns about weigh on what carries that axis: nothing is turned and back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from symgen.generation.runnable import RunnableKernels, rounded_state
from symgen.ir.kernel import Scalar
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.symbolic.scalar import Scalar as Node
from symgen.symbolic.traverse import reached
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.regular import FEWEST_STATES
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

# A wheel in a fork whose swivel the wheel's centre is on, under a trolley on a level rail; the wheel's hub sticks out.
TROLLEY = """
model: trolley
parameters: {m: {value: 3}, g: {value: 9.81}}
gravity: [0, 0, -g]
joints:
  rail: {type: prismatic, axis: x, coordinate: s}
  fork: {type: revolute, parent: rail, axis: z, at: [0.2, 0, 0.1], coordinate: swivel}
  wheel: {type: revolute, parent: fork, axis: y, at: [0, 0, -0.3], coordinate: spin}
bodies:
  rail: {mass: 2}
  wheel: {mass: m, com: COM, inertia: {xx: 0.1, yy: 0.2, zz: 0.1}}
inputs: {drive: {joint: s}}
"""
# A sweeper on two wheels with a drive each, behind it a castor.
SWEEPER = """
model: sweeper
parameters: {R: {value: 0.25}, r: {value: 0.08}, g: {value: 9.81}}
coordinates:
  x: {unit: m}
  y: {unit: m}
  heading: {unit: rad}
  left: {unit: rad}
  right: {unit: rad}
  swivel: {unit: rad}
  spin: {unit: rad}
gravity: [0, 0, -g]
frames:
  deck: {translation: [x, y, R], rotation: [[z, heading]]}
  wheel_l: {parent: deck, translation: [0, 0.4, 0], rotation: [[y, left]]}
  wheel_r: {parent: deck, translation: [0, -0.4, 0], rotation: [[y, right]]}
  fork: {parent: deck, translation: [-0.7, 0, r - R], rotation: [[z, swivel]]}
  castor: {parent: fork, translation: [-0.05, 0, 0], rotation: [[y, spin]]}
bodies:
  deck: {mass: 40, com: [-0.2, 0, 0.1], inertia: {xx: 3, yy: 5, zz: 6}}
  wheel_l: {mass: 4, inertia: {xx: 0.07, yy: 0.13, zz: 0.07}}
  wheel_r: {mass: 4, inertia: {xx: 0.07, yy: 0.13, zz: 0.07}}
  castor: {mass: 1, inertia: {xx: 1.6e-3, yy: 3.2e-3, zz: 1.6e-3}}
points:
  under: {frame: deck, at: [0, -0.4, -R], moves_with: wheel_r}
rolling:
  ground: {frame: wheel_l, radius: R}
  track: {frame: castor, radius: r}
constraints:
  nonholonomic:
    grip: cos(heading)*under.vx + sin(heading)*under.vy
inputs:
  motor_l: {joint: left}
  motor_r: {joint: right}
outputs: [forward_dynamics, multipliers]
configuration: {x: 0, y: 0, heading: 0.1, left: 0, right: 0, swivel: 0.3, spin: 0}
"""


def _loaded(folder: Path, text: str) -> System:
    path = folder / "model.yaml"
    path.write_text(text, encoding="utf-8")
    return System(load_model(path))


def _named(outputs: tuple[Node, ...]) -> set[str]:
    return {str(node.payload) for node in reached(outputs) if node.op == "symbol"}


def test_what_a_balanced_wheel_weighs_does_not_load_a_level_rail(tmp_path: Path) -> None:
    system = _loaded(tmp_path, TROLLEY.replace("COM", "[0, 0, 0]"))
    along, about_swivel, about_axle = system.balance
    assert _named((along,)) == {"m", "s_ddot"}
    assert not _named((about_swivel, about_axle)) & {"g", "m", "s_ddot"}


def test_a_hub_that_sticks_out_turns_with_the_fork_alone(tmp_path: Path) -> None:
    system = _loaded(tmp_path, TROLLEY.replace("COM", "[0, 0.1, 0]"))
    named = _named(system.balance[:1])
    assert not named & {"g", "spin"}
    assert "swivel" in named


@pytest.mark.campaign
@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_a_sweeper_that_all_but_rests_is_answered_within_the_tolerance(scalar: Scalar, tmp_path: Path) -> None:
    path = tmp_path / "sweeper.yaml"
    path.write_text(SWEEPER, encoding="utf-8")
    model = load_model(path)
    reference, kernels = Reference(model), RunnableKernels(model, tmp_path, model.outputs)
    for sample in sample_states(reference, (), FEWEST_STATES):
        for pace in (1, 1e-4, 1e-8):
            slow = {part: tuple(float(x) * pace for x in getattr(sample.state, part)) for part in ("qd", "u")}
            state = rounded_state(replace(sample.state, **slow), scalar)
            expected = expectations(reference, state, model.outputs, scalar, "rest")
            for name, one in expected.items():
                outcome = kernels.run(name, state, scalar)
                assert outcome.status == 0
                assert one.in_units(one.distance(outcome.entries)) <= FACTOR, (name, pace)
