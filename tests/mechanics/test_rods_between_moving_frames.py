"""Rods, in space too, know nothing of how what carries both of their ends moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.mechanics.system import System
from symgen.model.load import load_model

# A crane that swings and lifts a platform, on which a rod couples two arms in tilted planes.
CRANE = """
model: crane
parameters: {h: {value: 0.6}, rod: {value: 0.5}}
gravity: [0, 0, -9.81]
joints:
  mast: {type: revolute, axis: z, coordinate: swing}
  boom: {type: revolute, parent: mast, axis: [1, 1, 0], at: [0, 0, h], coordinate: lift}
  left: {type: revolute, parent: boom, axis: [1, 0, 2], at: [0.2, 0, 0.1], coordinate: a}
  right: {type: revolute, parent: boom, axis: [0, 1, 1], at: [0, 0.3, 0], coordinate: b}
bodies:
  left: {mass: 2, com: [0.2, 0, 0], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
  right: {mass: 1, com: [0, 0, 0.3], inertia: {xx: 0.04, yy: 0.03, zz: 0.01}}
  boom: {mass: 3, inertia: {xx: 0.1, yy: 0.2, zz: 0.1}}
points:
  tip: {frame: left, at: [0.4, 0, 0]}
  end: {frame: right, at: [0, 0, 0.5]}
loops: {coupler: {type: distance, between: [tip, end], length: rod}}
inputs: {drive: {joint: swing}}
"""


@pytest.mark.parametrize("joint", ["revolute", "spherical"])
def test_rods_on_what_moves_hold_what_moves_there_alone(joint: str, tmp_path: Path) -> None:
    path = tmp_path / "crane.yaml"
    turned = "mast: {type: spherical, coordinates: [e0, e1, e2, e3]}\n"
    swing = "  mast: {type: revolute, axis: z, coordinate: swing}\n"
    text = CRANE if joint == "revolute" else CRANE.replace(swing, "  " + turned).replace("joint: swing", "joint: lift")
    path.write_text(text, encoding="utf-8")
    model = load_model(path)
    system = System(model)
    (row,) = (
        entries
        for given, entries in zip(model.constraints, system.constraint_jacobian, strict=True)
        if given.name == "coupler_length"
    )
    held = [c.name for c, entry in zip(model.coordinates, row, strict=True) if not entry.is_zero]
    assert held == ["a", "b"]
