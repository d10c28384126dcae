"""The five-bar robot: Pinocchio reads the URDF by itself; its recursions and the Jacobians of both rods' ends against
the generated Python."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import robot_packages
from generated_python import generated_python
from shipped import ROOT

pinocchio = robot_packages.pinocchio()

NAMES = ["left_motor", "right_motor", "left_elbow", "right_elbow"]  # the order of models/five_bar.yaml
START = np.array([2.2, 0.94, -1.2, 1.2])
ROTORS = np.diag([4e-4, 4e-4, 0, 0])
WIDTH = 0.05  # of the smooth dry friction
WITHIN = 1e-10


class FiveBar:
    """The robot of models/five_bar.urdf in the order of `NAMES`."""

    def __init__(self) -> None:
        self.robot = pinocchio.buildModelFromUrdf(str(ROOT / "models" / "five_bar.urdf"))
        self.data = self.robot.createData()
        self.order = np.array([self.robot.joints[self.robot.getJointId(name)].idx_v for name in NAMES])
        self.damping, self.dry = np.zeros(4), np.zeros(4)
        for i, name in enumerate(NAMES):
            self.damping[i] = 0.02 if "motor" in name else 0.002
            self.dry[i] = 0.05 if "motor" in name else 0.0

    def ordered(self, values: Any) -> Any:
        """Pinocchio's order."""
        permuted = np.zeros(4)
        permuted[self.order] = values
        return permuted

    def load(self, q: Any, qd: Any, qdd: Any) -> Any:
        """What the inputs and the spindle must supply (4): RNEA, rotors, friction."""
        tau = pinocchio.rnea(self.robot, self.data, *map(self.ordered, (q, qd, qdd)))[self.order]
        return tau + ROTORS @ qdd + self.damping * qd + self.dry * np.tanh(qd / WIDTH)

    def mass_matrix(self, q: Any) -> Any:
        """CRBA with the rotors (4, 4)."""
        upper = np.triu(pinocchio.crba(self.robot, self.data, self.ordered(q)))
        full = upper + np.triu(upper, 1).T
        return full[np.ix_(self.order, self.order)] + ROTORS

    def loop(self, q: Any, qd: Any) -> tuple[Any, Any, Any]:
        """The gap of the spindle in the plane (2), B (2, 4) and B-dot qd (2)."""
        q, qd = self.ordered(q), self.ordered(qd)
        pinocchio.forwardKinematics(self.robot, self.data, q, qd, np.zeros(4))
        pinocchio.updateFramePlacements(self.robot, self.data)
        pinocchio.computeJointJacobians(self.robot, self.data, q)
        seen = pinocchio.LOCAL_WORLD_ALIGNED
        gap, rows, bias = np.zeros(2), np.zeros((2, 4)), np.zeros(2)
        for sign, name in ((1, "left_end"), (-1, "right_end")):
            frame = self.robot.getFrameId(name)
            gap += sign * self.data.oMf[frame].translation[:2]
            rows += sign * pinocchio.getFrameJacobian(self.robot, self.data, frame, seen)[:2][:, self.order]
            bias += sign * pinocchio.getFrameClassicalAcceleration(self.robot, self.data, frame, seen).linear[:2]
        return gap, rows, bias

    def closed(self, q: Any) -> Any:
        """The nearest configuration in which the spindle holds both rods."""
        for _ in range(20):
            gap, rows, _ = self.loop(q, np.zeros(4))
            q = q - np.linalg.pinv(rows) @ gap
        return q


@cache
def robot() -> FiveBar:
    return FiveBar()


def states() -> list[tuple[Any, Any, Any, Any]]:
    source = np.random.default_rng(7)
    return [
        (robot().closed(START + 0.3 * source.normal(size=4)), *source.normal(size=(2, 4)), source.normal(size=2))
        for _ in range(6)
    ]


def close(computed: Any, expected: Any) -> bool:
    return bool(np.abs(computed - expected).max() <= WITHIN * np.abs(expected).max())


@pytest.mark.mechanisms
def test_torques_of_the_drives() -> None:
    for q, qd, qdd, _ in states():
        _, B, _ = robot().loop(q, qd)
        N = np.eye(4) - np.linalg.pinv(B) @ B
        expected = np.linalg.lstsq(N[:, :2], N @ robot().load(q, qd, qdd), 1e-9)[0]
        assert close(generated_python("five_bar").inverse_dynamics(q, qd, qdd), expected)


def test_accelerations_and_the_force_in_the_spindle() -> None:
    module = generated_python("five_bar")
    for q, qd, _, u in states():
        _, B, bias = robot().loop(q, qd)
        force = np.append(u, [0, 0]) - robot().load(q, qd, np.zeros(4))
        kkt = np.block([[robot().mass_matrix(q), B.T], [B, np.zeros((2, 2))]])
        expected = np.linalg.solve(kkt, np.concatenate([force, -bias]))
        assert close(module.forward_dynamics(q, qd, u), expected[:4])
        assert close(module.multipliers(q, qd, u), expected[4:])
