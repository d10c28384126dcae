"""The witness's own trees against Pinocchio."""

from __future__ import annotations

import robot_packages
import yaml

from symgen.zoo import pinocchio_trees
from symgen.zoo.dice import Dice
from symgen.zoo.families import draw
from symgen.zoo.fields import Floats
from symgen.zoo.pinocchio_trees import SAME, disagreement
from symgen.zoo.reader import System

robot_packages.pinocchio()


def compared(index: int) -> float | None:
    """The disagreement on a drawn tree."""
    blocks = yaml.load(draw(21, index, "tree_bodies").text, Loader=yaml.BaseLoader)
    system = System(blocks)
    values: dict[str, float] = {}
    for name, node in system.parameters.items():
        values[name] = system.tape.evaluate([node], values, Floats())[0]
    return disagreement(blocks, values, Dice("test", index))


def test_trees_agree() -> None:
    found = [each for each in map(compared, range(25)) if each is not None]
    assert len(found) > 8
    assert max(found) < SAME


def test_another_mechanism_is_told(monkeypatch) -> None:
    index = next(index for index in range(25) if compared(index) is not None)
    axis = pinocchio_trees._Tree._axis
    monkeypatch.setattr(pinocchio_trees._Tree, "_axis", lambda self, given: -axis(self, given))
    told = compared(index)
    assert told is not None
    assert told > 1e-3
