"""Inputs that act on the machine itself: forces at points and along cables as arrows, torques on frames by their names.

The rate that an input works on is linear in velocities and turning rates; their coefficients are the force at each
place and the torque on each frame for an input of 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from symgen.drawing.pose import NEXT_TO_NOTHING, MachinePose, Place
from symgen.model.configurations.gradient import Gradients
from symgen.model.expressions.walk import names_in
from symgen.model.mechanism import Component, component, is_component
from symgen.model.model import Input


@dataclass(frozen=True, slots=True)
class DrawnForce:
    """An input at a place, and the direction of its force there in the axes of the world; none for a torque."""

    input: str
    place: Place
    direction: Place | None


def drawn_forces(pose: MachinePose) -> Iterator[DrawnForce]:
    """Those of all inputs that are given by the rate they work on, where they move something."""
    for one in pose.model.inputs:
        if one.velocity is not None:
            yield from _of_input(pose, one)


def _of_input(pose: MachinePose, one: Input) -> Iterator[DrawnForce]:
    assert one.velocity is not None
    names = (part.name for part in names_in(one.velocity) if is_component(part.name))
    rates = [rate for rate in map(component, dict.fromkeys(names)) if rate.is_rate]
    index = {rate.name: k for k, rate in enumerate(rates)}

    def known(name: str) -> tuple[float, dict[int, float]]:
        return (0.0, {index[name]: 1.0}) if name in index else (pose.component(component(name)), {})

    definitions = {definition.name: definition.value for definition in pose.model.definitions}
    _, coefficients = Gradients(pose.values, {}, definitions, known).of(one.velocity)
    for owner in dict.fromkeys(rate.owner for rate in rates):
        own = [(rate, coefficients.get(index[rate.name], 0.0)) for rate in rates if rate.owner == owner]
        force = _summed(pose, [(rate, factor) for rate, factor in own if rate.what[0] == "v"])
        torque = _summed(pose, [(rate, factor) for rate, factor in own if rate.what[0] == "w"])
        if (length := math.hypot(*force)) > NEXT_TO_NOTHING and not pose.is_still(owner):
            yield DrawnForce(one.name, pose.places[owner], (force[0] / length, force[1] / length, force[2] / length))
        elif math.hypot(*torque) > NEXT_TO_NOTHING:
            yield DrawnForce(one.name, pose.places[owner], None)


def _summed(pose: MachinePose, parts: list[tuple[Component, float]]) -> Place:
    """Components times their factors as a vector in the axes of the world."""
    x = y = z = 0.0
    for part, factor in parts:
        a, b, c = pose.axis(part.axes, part.index)
        x, y, z = x + factor * a, y + factor * b, z + factor * c
    return x, y, z
