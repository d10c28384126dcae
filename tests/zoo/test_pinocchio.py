"""The witness's own trees against Pinocchio."""

from __future__ import annotations

import pytest
import robot_packages
import yaml

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.witness import pinocchio_trees
from symgen.laboratory.zoo.witness.fields import Floats
from symgen.laboratory.zoo.witness.pinocchio_trees import SAME, disagreement
from symgen.laboratory.zoo.witness.reader import SystemReader
from symgen.laboratory.zoo.witness.urdf_file import expanded

robot_packages.pinocchio()


def compared(index: int, family: str = "tree_bodies") -> float | None:
    """The disagreement on a drawn tree."""
    description = draw(21, index, family)
    blocks = yaml.load(description.text, Loader=yaml.BaseLoader)
    system = SystemReader(expanded(blocks, description.files))
    values: dict[str, float] = {}
    for name, node in system.parameters.items():
        values[name] = system.tape.evaluate([node], values, Floats())[0]
    return disagreement(blocks, values, Dice("test", index), description.files)


@pytest.mark.parametrize(
    "family",
    [
        "tree_bodies",
        *(pytest.param(name, marks=pytest.mark.campaign) for name in ("spatial_bodies", "cable_robot", "robot_files")),
    ],
)
def test_trees_agree(family: str) -> None:
    """Of joints of every kind, with quaternions and without, of files and of robot descriptions."""
    found = [each for each in (compared(index, family) for index in range(12)) if each is not None]
    assert len(found) > 4
    assert max(found) < SAME


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
    told = disagreement(yaml.load(text, Loader=yaml.BaseLoader), {}, Dice("test", 0))
    assert told is not None
    assert told < SAME


def test_another_mechanism_is_told(monkeypatch) -> None:
    axis = pinocchio_trees._Joints._axis
    monkeypatch.setattr(pinocchio_trees._Joints, "_axis", lambda self, given: -axis(self, given))
    # a joint or two may look the same either way
    told = [each for each in map(compared, range(12)) if each is not None]
    assert max(told) > 1e-3
