"""Witness: Pinocchio reads the same robot descriptions; mass matrices and inverse dynamics agree."""

from __future__ import annotations

from pathlib import Path

import numpy
import pytest
import robot_packages
from robots import ARM, HEAD, LIMIT, balance, joint, link, load, mass_matrix, robot, state_of

from symgen.model.model import Model

pinocchio = robot_packages.pinocchio()

ROUND = '<origin xyz="0.1 0.2 -0.1" rpy="0.3 0.2 -0.4"/>'
ODD = robot(
    link("base", 0),
    link("one", 2, 0.02, ROUND).replace('ixy="0"', 'ixy="0.004"'),
    link("two", 1, 0.01, ROUND).replace('ixx="0.01"', 'ixx="0.012"'),
    link("weight", 0.7, 0.005, ROUND),
    link("three", 1.5, 0.03, ROUND),
    joint("a", "revolute", "base", "one", f'<origin xyz="0 0.1 0.2" rpy="1 2 3"/><axis xyz="0 0.6 0.8"/>{LIMIT}'),
    joint("b", "prismatic", "one", "two", f'<origin xyz="0.3 0 0" rpy="0 1.57079633 0"/><axis xyz="0 1 0"/>{LIMIT}'),
    joint("weld", "fixed", "two", "weight", '<origin xyz="0 0.2 0.1" rpy="-0.2 0.5 0.1"/>'),
    joint("c", "revolute", "weight", "three", f'<origin xyz="0.1 0.1 0" rpy="0 0 -0.7"/><axis xyz="1 0 0"/>{LIMIT}'),
)
# what their descriptions hold beside the mechanics, or say of limits and friction that Pinocchio's forces leave out
PUBLISHED = {
    "ur5_robot.urdf": "robot.urdf",
    "kinova.urdf": "robot.urdf",
    "panda.urdf": "{file: robot.urdf, leave_out: [D, K, mu_coulomb, mu_viscous]}",
    "xarm7.urdf": "{file: robot.urdf, friction_width: 0.01}",
    "z1.urdf": "{file: robot.urdf, friction_width: 0.01}",
}


def check_agreement(model: Model, path: Path, tolerance: float) -> None:
    """Mass matrix and inverse dynamics without friction, at three states in the coordinates of both."""
    other = pinocchio.buildModelFromUrdf(str(path))
    data = other.createData()
    names = [c.name for c in model.coordinates]
    assert sorted(names) == sorted(other.names[1:])
    for seed in range(3):
        state = state_of(model, seed)
        q, v, a = pinocchio.neutral(other), numpy.zeros(other.nv), numpy.zeros(other.nv)
        places = {}
        for index in range(1, other.njoints):
            name, first = other.names[index], other.joints[index].idx_v
            places[name] = first
            angle = state[name]
            start = other.joints[index].idx_q
            q[start : start + other.joints[index].nq] = (
                [angle] if other.joints[index].nq == 1 else [numpy.cos(angle), numpy.sin(angle)]
            )
            v[first], a[first] = state[f"{name}_dot"], state[f"{name}_ddot"]
        force = pinocchio.rnea(other, data, q, v, a)
        matrix = pinocchio.crba(other, data, q)
        matrix = numpy.triu(matrix) + numpy.triu(matrix, 1).T
        size = max(abs(force))
        forces = balance(frictionless(model), state)
        assert [forces[name] for name in names] == pytest.approx(
            [force[places[name]] for name in names], rel=0, abs=tolerance * size
        )
        expected = [matrix[places[row], places[column]] for row in names for column in names]
        assert mass_matrix(model, state) == pytest.approx(expected, rel=0, abs=tolerance * max(map(abs, expected)))


def frictionless(model: Model) -> Model:
    """The model without its force elements."""
    from dataclasses import replace

    return replace(model, forces=())


@pytest.mark.parametrize("text", [ARM, ODD], ids=["arm", "odd"])
def test_robots_written_by_hand(text: str, tmp_path: Path) -> None:
    check_agreement(load(tmp_path, text), tmp_path / "robot.urdf", 2e-8 if "1.57079633" in text else 1e-13)


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_robots(name: str, tmp_path: Path) -> None:
    text = robot_packages.robot_description(name).read_text(encoding="utf-8")
    model = load(tmp_path, text, HEAD.replace("robot.urdf", PUBLISHED[name]))
    # their quarter turns have eight to twelve digits, which symgen reads as exact ones
    check_agreement(model, tmp_path / "robot.urdf", 1e-7)
