"""Whole bodies as numbers of a model file: every other character stays, and the model has the estimates."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import ARM_WITH_FRICTION

from symgen.identification.bodies.entries import body_entry
from symgen.identification.combinations import inertial_values
from symgen.identification.estimates.parameter_file import WrittenBodies, with_values
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text

# Entries in blocks, with comments, on several lines, without some keys, and one of nothing at all.
BLOCKS = """
model: blocks
parameters:
  m: {value: 2, unit: kg}
gravity: [0, -9.81, 0]
joints:
  first: {type: revolute, axis: z, coordinate: a}
  second: {type: revolute, parent: first, at: [0.3, 0, 0], axis: z, coordinate: b}
  third: {type: revolute, parent: second, at: [0.3, 0, 0], axis: z, coordinate: c}
bodies:
  first:            # of steel
    inertia:
      zz: 0.3       # guessed
    mass: m         # weighed
  second:
    com:
      - 0.1
      - 0
      - 0           # of the drawing
    mass: 1
    # nothing is known of its inertia
  third: {mass: 0.5}
rotor_inertias: {a: 0.01, b: 2*0.005}
inputs:
  u: {joint: a}
"""
# What bodies become: ten parameters about the origin.
TENS = {
    "first": np.array([2.2, 0.22, 0.01, 0.02, 0.1, 0.35, 0.36, 0.001, -0.002, 0.003]),
    "second": np.array([1.3, 0.13, 0.0, 0.0, 0.02, 0.06, 0.06, 0.0, 0.0, 0.0]),
    "third": np.array([0.7, 0.0, 0.07, 0.0, 0.06, 0.02, 0.06, 0.0, 0.0, 0.0]),
}


def written(folder: Path, text: str, bodies: dict[str, np.ndarray], rotors: dict[str, str]) -> str:
    path = folder / "machine.yaml"
    path.write_text(text, encoding="utf-8")
    made = with_values(path, {}, WrittenBodies({name: body_entry(ten) for name, ten in bodies.items()}, rotors))
    assert made.text is not None, made.why
    return made.text


def inertial(text: str) -> np.ndarray:
    model = load_text(text, "machine.yaml")
    return inertial_values(model, default_values(model.parameters))


def test_bodies_in_blocks_in_braces_and_without_keys(tmp_path: Path) -> None:
    text = written(tmp_path, BLOCKS, TENS, {"a": "0.012", "b": "0.013"})
    assert np.allclose(inertial(text), [*np.concatenate([*TENS.values()]), 0.012, 0.013], rtol=1e-8, atol=1e-12)
    for comment in ("# of steel", "# weighed", "# nothing is known of its inertia"):
        assert comment in text
    kept = [line for line in BLOCKS.splitlines() if "mass" not in line and "rotor" not in line][:10]
    assert text.startswith("\n".join(kept))
    assert text.endswith(BLOCKS[BLOCKS.index("inputs:") :])


def test_some_bodies_alone(tmp_path: Path) -> None:
    text = written(tmp_path, ARM_WITH_FRICTION, {"elbow": TENS["second"]}, {})
    lines = zip(ARM_WITH_FRICTION.splitlines(), text.splitlines(), strict=True)
    changed = [new for old, new in lines if old != new]
    assert changed == [
        "  elbow: {mass: 1.3, com: [0.1, 0, 0], inertia: {xx: 0.02, yy: 0.047, zz: 0.047}}"
    ]
    assert np.allclose(inertial(text)[10:20], TENS["second"])
    assert np.allclose(inertial(text)[:10], inertial(ARM_WITH_FRICTION)[:10])


@pytest.mark.parametrize("ten", [*TENS.values()])
def test_an_entry_is_a_body_again(tmp_path: Path, ten: np.ndarray) -> None:
    assert np.allclose(inertial(written(tmp_path, ARM_WITH_FRICTION, {"elbow": ten}, {}))[10:20], ten, rtol=1e-8)


def test_bodies_of_another_file_are_left(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("model: other\nurdf: robot.urdf\n", encoding="utf-8")
    refused = with_values(path, {}, WrittenBodies({"link": body_entry(TENS["first"])}, {}))
    assert refused.text is None
    assert "`urdf` names, which is left as it is" in refused.why
