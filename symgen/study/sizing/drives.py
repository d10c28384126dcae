"""Drives that a motor can sit at: inputs that act along one coordinate in a constant ratio."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.study.sizing.catalogue import Motor
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate


@dataclass(frozen=True, slots=True)
class MotorDrive:
    """An input u along a coordinate q: its column of M(q) is `share` at the place of q and 0 elsewhere, so that it
    moves at share q'.  `rotor` is the inertia that the model has at q already."""

    name: str
    input: int
    coordinate: int
    share: float
    rotor: Scalar


def drives_of(model: Model) -> tuple[MotorDrive, ...]:
    """The drives of a model in the order of its inputs."""
    system = System(model)
    names = [c.name for c in model.coordinates]
    made = []
    for k, one in enumerate(model.inputs):
        column = [row[k] for row in system.control_matrix]
        acting = [(j, entry.constant) for j, entry in enumerate(column) if entry.constant != 0]
        place, share = acting[0] if len(acting) == 1 else (0, None)
        if share is None:
            continue
        rotors = (rotor for rotor in model.mechanism.rotor_inertias if rotor.coordinate == names[place])
        inertia = sum((translate(system.graph, one.inertia, system.names) for one in rotors), system.graph.zero)
        made.append(MotorDrive(one.name, k, place, float(share), inertia))
    return tuple(made)


def rotors_at(model: Model, drives: tuple[MotorDrive, ...], p: Array) -> Array:
    """The inertias that the model has at the coordinates of drives (points x drives), at parameters p (points x
    parameters)."""
    names = [one.name for one in model.parameters]
    evaluate = Evaluator([drive.rotor for drive in drives])
    return np.array([evaluate(dict(zip(names, map(float, row), strict=False))) for row in p])


def motor_torques(
    drives: tuple[MotorDrive, ...], motors: tuple[Motor, ...], u: Array, qdd: Array, rotors: Array
) -> Array:
    """Torques of the shafts of motors (points x drives * motors x states), each motor at each drive by itself.

    u (points x m x states) are the inputs of the model, whose own `rotors` I (points x drives) are taken out.  Of a
    motor with inertia J and ratio n: tau = (u - I q'' / share) / n + J n share q''.
    """
    made = []
    for k, drive in enumerate(drives):
        acceleration = qdd[:, drive.coordinate]
        load = u[:, drive.input] - rotors[:, k, None] * acceleration / drive.share
        made += [load / one.ratio + one.inertia * one.ratio * drive.share * acceleration for one in motors]
    return np.stack(made, axis=1)
