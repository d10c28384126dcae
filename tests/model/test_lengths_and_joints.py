"""Lengths without a sign, and coordinates that two joints claim: mistakes with a place and a remedy."""

from __future__ import annotations

import re

import pytest

from symgen.diagnostics import ModelError
from symgen.model.load import load_text

TROLLEY = """model: trolley
parameters:
  R: {value: RADIUS}
  rod: {value: LENGTH}
joints:
  slide: {type: prismatic, axis: x, coordinate: s}
  wheel: {type: revolute, parent: slide, axis: y, coordinate: ANGLE}
  arm: {type: revolute, parent: slide, axis: y, coordinate: b}
  tool: {type: revolute, parent: arm, at: [0, 0, 0.5], axis: y, coordinate: c}
bodies:
  slide: {mass: 3}
  wheel: {mass: 1, inertia: {yy: 0.1}}
  arm: {mass: 1, com: [0, 0, 0.3], inertia: {yy: 0.1}}
  tool: {mass: 1, com: [0, 0, 0.2], inertia: {yy: 0.1}}
gravity: [0, 0, -9.81]
points:
  tip: {frame: tool, at: [0, 0, 0.4]}
  post: {at: [0.6, 0, 0.6]}
rolling:
  ground: {frame: wheel, radius: R}
loops:
  rope: {type: distance, between: [tip, post], length: rod}
springs:
  soft: {between: [tip, post], stiffness: 100, length: REST}
inputs:
  u: {joint: s}
configuration: {b: 0.3, c: 0.5}
"""


def _said(radius: str = "0.2", length: str = "0.5", rest: str = "0.1", angle: str = "a") -> str:
    text = TROLLEY.replace("RADIUS", radius).replace("LENGTH", length).replace("REST", rest).replace("ANGLE", angle)
    with pytest.raises(ModelError) as caught:
        load_text(text, "trolley.yaml")
    return str(caught.value)


def test_lengths_without_a_sign_are_all_told_at_once() -> None:
    said = _said("-0.2", "-0.5", "-0.1")
    assert "trolley.yaml:20:34: the radius of the wheel `ground` is -0.2: it has no sign" in said
    assert "trolley.yaml:22:56: the length of the loop `rope` is -0.5: it has no sign" in said
    assert "trolley.yaml:24:56: the length of the spring `soft` is -0.1: it has no sign" in said
    assert len(re.findall("^  remedy: write its size", said, re.M)) == 3


def test_no_radius_and_no_rod_are_mistakes_and_a_slack_spring_is_none() -> None:
    said = _said("0", "0", "0")
    assert "the radius of the wheel `ground` is 0\n" in said
    assert "`type: point`" in said
    assert "soft" not in said.replace("soft: {", "")


def test_a_coordinate_of_two_joints_is_a_mistake() -> None:
    said = _said(angle="s")
    assert "trolley.yaml:7:63: `s` is a coordinate of the joint `slide` (line 6) already" in said
    assert "coupled by a row under `constraints`" in said
    assert said.count("remedy:") == 1
