"""The witness's own trees against Pinocchio."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import robot_packages
import yaml

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.run import run_command
from symgen.laboratory.zoo.witness import pinocchio_trees
from symgen.laboratory.zoo.witness.numbers.fields import Floats, precision
from symgen.laboratory.zoo.witness.pinocchio_answers import COMPARED, PinocchioAnswers
from symgen.laboratory.zoo.witness.pinocchio_trees import SAME, PinocchioTree, disagreement, tree_of
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.reading.urdf_file import exact_angles, expanded
from symgen.laboratory.zoo.witness.witness import Witness

robot_packages.pinocchio()


def apart(blocks: Mapping[str, Any], files: Mapping[str, str], seed: object) -> float | None:
    """The disagreement about G and all other forces, None where there is no tree."""
    system = SystemReader(expanded(blocks, files))
    values: dict[str, float] = {}
    for name, node in system.parameters.items():
        values[name] = system.tape.evaluate([node], values, Floats())[0]
    tree = tree_of(blocks, values, files)
    return None if tree is None else disagreement(*tree, values, Dice("test", seed))


def compared(index: int, family: str = "tree_bodies") -> float | None:
    """The disagreement on a drawn tree."""
    description = draw(21, index, family)
    return apart(yaml.load(description.text, Loader=yaml.BaseLoader), description.files, index)


@pytest.mark.parametrize(
    "family",
    [
        "tree_bodies",
        *(pytest.param(name, marks=pytest.mark.campaign) for name in ("spatial_bodies", "cable_robot", "robot_files")),
    ],
)
def test_trees_agree(family: str) -> None:
    """Of joints of every kind, with quaternions and without, of files and of robot descriptions."""
    differences = [each for each in (compared(index, family) for index in range(12)) if each is not None]
    assert len(differences) > 4
    assert max(differences) < SAME


def test_forces_that_are_nothing_but_rounding_agree() -> None:
    # nothing pulls, and every centre of mass lies on its axis
    text = """
joints:
  slide: {type: prismatic, axis: [1, 2, 0], coordinate: s}
  turn: {type: revolute, parent: slide, at: [0.3, 0, 0.7], axis: y, coordinate: a}
  other: {type: revolute, at: [0, 0.78, 0.25], axis: [0, 3, 4], coordinate: b}
bodies:
  slide: {mass: 1.3, com: [0, 0.2, 0.1]}
  turn: {mass: 2.1, inertia: {xx: 0.3, yy: 0.08, zz: 0.3}}
  other: {mass: 4.2, inertia: {xx: 0.2, yy: 0.2, zz: 0.2}}
"""
    difference = apart(yaml.load(text, Loader=yaml.BaseLoader), {}, 0)
    assert difference is not None
    assert difference < SAME


def test_another_mechanism_is_told(monkeypatch) -> None:
    axis = pinocchio_trees._Joints._axis
    monkeypatch.setattr(pinocchio_trees._Joints, "_axis", lambda self, given: -axis(self, given))
    # a joint or two may look the same either way
    differences = [each for each in map(compared, range(12)) if each is not None]
    assert max(differences) > 1e-3


# a crane on a ball joint: what it lifts with hangs on a bracket, its counterweight stands on another
CRANE = """
model: crane
parameters: {reach: 0.7, lean: 0.4}
joints:
  ball: {type: spherical, coordinates: [e_0, e_1, e_2, e_3]}
  slew: {type: revolute, parent: bracket, axis: [1, 2, 2], coordinate: a}
  hoist: {type: prismatic, parent: tip, axis: z, coordinate: s}
frames:
  bracket: {parent: ball, translation: [0.2, 0, 0.5], rotation: [[x, lean], [z, 0.3]]}
  tip: {parent: slew, translation: [reach, 0, 0], rotation: {quaternion: [0.6, 0, 0.8, 0]}}
  pan: {parent: bracket, translation: [-0.4, 0.1, 0]}
  sling: {parent: hoist, translation: [0, 0, -0.2]}
bodies:
  ball: {mass: 6, com: [0, 0, 0.2], inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.02}}
  pan: {mass: 2.5, com: [0.05, 0, 0], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
  slew: {mass: 1.5, com: [0.3, 0, 0], inertia: {xx: 0.01, yy: 0.1, zz: 0.1}}
  sling: {mass: 0.8, com: [0, 0.02, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.01}}
gravity: [0, 0, -9.81]
rotor_inertias: {a: 0.3, s: 1.2}
springs: {soft: {joint: s, stiffness: 40, damping: 3}}
friction: {a: {viscous: 0.2}}
points: {hook: {frame: sling, at: [0, 0, -0.1]}}
inputs:
  lean_over: {torque_on: ball, direction: [1, 0, 0]}
  turn: {joint: a}
  lift: {joint: s}
  help: {point: hook, direction: [0, 1, 0]}
configuration: {e_0: 0.8, e_1: 0.36, e_2: 0, e_3: 0.48, a: 0.5, s: 0.2}
"""


def results(text: str, away: float = 0.0) -> Iterator[tuple[str, float | None]]:
    """How far exact results that are moved away by this share are from Pinocchio's."""
    witness = Witness(text)
    defaults = witness.defaults()
    states, ranks = witness.walker().states(defaults, 4)
    assert len(states) == 4
    tree = tree_of(yaml.load(text, Loader=yaml.BaseLoader), defaults, {})
    assert tree is not None
    answers = PinocchioAnswers(tree[0], witness._system.blocks, ranks)
    names = (*witness._system.coordinates, *witness._system.rate_names)
    for state in states:
        values = {**defaults, **dict(zip(names, (*state.q, *state.qd), strict=True))}
        for quantity in COMPARED:
            with precision():
                truth = witness._truth(quantity, state, ranks)
                assert truth is not None
                given = [float(x.mid()) * (1 + away) for x in truth.value]
            yield quantity, answers.apart(quantity, state, values, given)


def test_bodies_and_joints_on_fixed_frames_are_compared() -> None:
    difference = apart(yaml.load(CRANE, Loader=yaml.BaseLoader), {}, 0)
    assert difference is not None
    assert difference < SAME


def test_what_moves_by_an_expression_is_no_tree() -> None:
    text = CRANE.replace("translation: [reach, 0, 0]", "translation: [reach + s, 0, 0]")
    assert apart(yaml.load(text, Loader=yaml.BaseLoader), {}, 0) is None


def test_results_of_a_tree_are_those_of_pinocchio() -> None:
    """With rotors, springs and friction, and inputs that share the work."""
    assert all(difference is not None and difference < SAME for _, difference in results(CRANE))
    assert all(difference is not None and difference > 100 * SAME for _, difference in results(CRANE, 1e-6))


def test_u_of_shared_inputs_is_that_of_pinocchio() -> None:
    """A boom with a drive too many: weights, a preload and a limit decide on u."""
    boom = """
model: boom
joints: {lift: {type: revolute, axis: y, coordinate: a}, reach: {type: prismatic, parent: lift, axis: x, coordinate: s}}
bodies: {lift: {mass: 9, com: [0.4, 0, 0], inertia: {yy: 0.7}}, reach: {mass: 3, com: [0.6, 0, 0], inertia: {yy: 0.2}}}
gravity: [0, 0, -9.81]
points: {anchor: {at: [-0.5, 0, 1]}, head: {frame: reach, at: [0.8, 0, 0]}}
inputs: {motor: {joint: a}, rope: {cable: [head, anchor]}, push: {joint: s}}
configuration: {a: -0.3, s: 0.4}
"""
    shared = boom + "allocation: {weights: {rope: 3}, preload: 5, limits: {motor: [-30, 20]}}\n"
    for text in (boom, shared):
        for quantity, difference in results(text):
            assert difference is not None
            assert difference < SAME, quantity


@pytest.mark.parametrize(("seed", "index"), [(21001, 269), (21001, 321), (41001, 258)])
def test_u_is_that_of_pinocchio_as_far_as_doubles_hold_what_it_is_made_of(seed: int, index: int) -> None:
    """Inputs that hardly reach a direction, and weights that these do not hold, near rest: rounding is what is left.

    So it is of inputs beyond their limits that take no part in the internal force.
    """
    description = draw(seed, index, None)
    witness = Witness(description.text, description.start, description.text, description.files)
    defaults = witness.defaults()
    states, ranks = witness.walker().states(defaults, 20)
    tree = tree_of(yaml.load(description.text, Loader=yaml.BaseLoader), defaults, description.files)
    assert tree is not None
    answers = PinocchioAnswers(tree[0], witness._system.blocks, ranks)
    names = (*witness._system.coordinates, *witness._system.rate_names)
    gaps = {0.0: list[float](), 1e-6: list[float]()}
    for state in states:
        values = {**defaults, **dict(zip(names, (*state.q, *state.qd), strict=True))}
        with precision():
            truth = witness._known("inverse_dynamics", state, ranks)
        for share, own in gaps.items():
            given = [] if truth is None else [float(x.mid()) * (1 + share) for x in truth.value]
            gap = answers.apart("inverse_dynamics", state, values, given) if given else None
            own += [] if gap is None else [gap]
    assert len(gaps[0.0]) > 10
    assert max(gaps[0.0]) < SAME
    assert np.median(gaps[1e-6]) > 10 * SAME


def test_a_tree_that_a_loop_closes_is_compared_by_its_u() -> None:
    """Pinocchio has the bodies, the zoo what the loop leaves free; accelerations of a tree are none of its own."""
    press = """
model: press
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  rod: {type: revolute, axis: z, parent: crank, at: [0.3, 0, 0], coordinate: b}
  ram: {type: prismatic, axis: x, coordinate: s}
frames: {head: {parent: ram, translation: [0.1, 0.05, 0], rotation: [[z, 0.2]]}}
bodies:
  crank: {mass: 4, com: [0.1, 0, 0], inertia: {zz: 0.1}}
  rod: {mass: 1, com: [0.4, 0, 0], inertia: {zz: 0.2}}
  head: {mass: 7}
gravity: [0, -9.81, 0]
points: {end: {frame: rod, at: [0.9, 0, 0]}, pin: {frame: ram}}
loops: {pinned: {type: point, between: [end, pin]}}
inputs: {drive: {joint: a}}
configuration: {a: 0.7, b: -0.9, s: 1.1}
"""
    gaps = list(results(press))
    assert all(gap is None for quantity, gap in gaps if quantity == "forward_dynamics")
    assert all(gap is not None and gap < SAME for quantity, gap in gaps if quantity == "inverse_dynamics")


def test_rounded_quarter_turns_of_a_robot_file_are_whole_ones() -> None:
    text = '<origin xyz="1.57079633 0 0" rpy="1.57079633 -1.5708 0.3"/>'
    assert exact_angles(text) == f'<origin xyz="1.57079633 0 0" rpy="{np.pi / 2!r} -1.5708 0.3"/>'


@pytest.mark.campaign
def test_a_false_result_of_a_tree_is_found_beside_pinocchio(tmp_path: Path, monkeypatch) -> None:
    """The whole check, of files that are right, beside accelerations of Pinocchio's that are not."""
    model = tmp_path / "crane.yaml"
    model.write_text(CRANE + "outputs: [inverse_dynamics, forward_dynamics]\n")
    run = run_command(model, tmp_path / "out")
    assert run.code == 0, run.err
    checked = Witness(CRANE).check(tmp_path / "out" / "crane", count=5)
    assert checked.findings == ()
    # u and accelerations of Python and C in double
    assert checked.coverage.pinocchio == 5 * 2 * 2
    right = PinocchioTree.accelerations
    monkeypatch.setattr(PinocchioTree, "accelerations", lambda self, *given: right(self, *given) * (1 + 1e-6))
    (finding,) = Witness(CRANE).check(tmp_path / "out" / "crane", count=5).findings
    assert finding.kind == "witness: Pinocchio"
    assert "forward_dynamics" in finding.text
