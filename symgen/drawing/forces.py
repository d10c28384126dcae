"""Inputs that act on the machine itself: forces at points and along cables as arrows, torques on frames by their names.

The rate that an input works on is linear in velocities and turning rates; their coefficients are the force at each
place and the torque on each frame for an input of 1.  An input that is given by what it does to several coordinates is
a force where a force of 1 does the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from symgen.drawing.pose import NEXT_TO_NOTHING, MachinePose, Place
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
        elif len(one.acts_on) > 1 and (force := _of_column(pose, one)) is not None:
            yield force


def _of_column(pose: MachinePose, one: Input) -> DrawnForce | None:
    """The force d of 1 at the first frame or point whose place moves by J q_dot, where J^T d is the column."""
    index = {coordinate.name: k for k, coordinate in enumerate(pose.model.coordinates)}
    gradients, column = pose.gradients({}), np.zeros(len(index))
    for coordinate, factor in one.acts_on:
        column[index[coordinate]] = gradients.of(factor)[0]
    for owner, place in pose.places.items():
        jacobian = np.array([[form.get(k, 0.0) for k in index.values()] for form in pose.place_rate(owner)])
        x, y, z = map(float, np.linalg.lstsq(jacobian.T, column, rcond=NEXT_TO_NOTHING)[0])
        left = float(np.abs(np.array([x, y, z]) @ jacobian - column).max())
        if abs(math.hypot(x, y, z) - 1) < NEXT_TO_NOTHING and left < NEXT_TO_NOTHING * float(np.abs(column).max()):
            return DrawnForce(one.name, place, (x, y, z))
    return None


def _of_input(pose: MachinePose, one: Input) -> Iterator[DrawnForce]:
    assert one.velocity is not None
    names = (part.name for part in names_in(one.velocity) if is_component(part.name))
    rates = [rate for rate in map(component, dict.fromkeys(names)) if rate.is_rate]
    index = {rate.name: k for k, rate in enumerate(rates)}
    _, coefficients = pose.gradients(index).of(one.velocity)
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
