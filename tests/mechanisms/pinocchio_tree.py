"""A model's frames and bodies as Pinocchio's tree: its own kinematics and recursions, from numbers read off the file.

Every frame must move by turns and ways in single coordinates, each at unit rate; a coordinate moves one frame only.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import robot_packages

from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import evaluate
from symgen.model.mechanism import WORLD, Quaternion
from symgen.model.model import Model

pinocchio = robot_packages.pinocchio()


class Tree:
    """Positions, Jacobians, mass matrix and inverse dynamics in the order of the model's coordinates."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.parameters = default_values(model.parameters)
        self.names = [c.name for c in model.coordinates]
        self.tree = pinocchio.Model()
        gravity = self._vector(model.mechanism.gravity)
        self.tree.gravity = pinocchio.Motion(gravity, np.zeros(3))
        self.moved: list[int] = []  # coordinates in the order of the joints
        self.places: dict[str, tuple[int, Any]] = {WORLD: (0, pinocchio.SE3.Identity())}
        self._children(WORLD)
        for body in model.mechanism.bodies:
            self._body(body)
        self.points = {p.name: (p.frame, self._vector(p.at)) for p in model.mechanism.points}
        rotors = {r.coordinate: self._number(r.inertia) for r in model.mechanism.rotor_inertias}
        self.rotors = np.diag([rotors.get(name, 0.0) for name in self.names])
        self.data = self.tree.createData()

    def _number(self, expression: Expression, **coordinates: float) -> float:
        at_rest = dict.fromkeys(self.names, 0.0)
        return evaluate(expression, {**self.parameters, **at_rest, **coordinates})

    def _vector(self, triple: Any, **coordinates: float) -> Any:
        return np.array([self._number(x, **coordinates) for x in triple])

    def _children(self, parent: str) -> None:
        """Branch by branch: CRBA takes the joints beyond a joint to be numbered right after it."""
        for frame in self.model.mechanism.frames:
            if frame.parent == parent:
                self._frame(frame)
                self._children(frame.name)

    def _frame(self, frame: Any) -> None:
        joint, place = self.places[frame.parent]
        start = self._vector(frame.translation)
        place = place * pinocchio.SE3(np.eye(3), start)
        for i, name in enumerate(self.names):
            way = self._vector(frame.translation, **{name: 1.0}) - start
            if way.any():
                joint = self._joint(joint, pinocchio.JointModelPrismaticUnaligned(way), place, i)
                place = pinocchio.SE3.Identity()
        assert not isinstance(frame.rotation, Quaternion)
        for turn in frame.rotation:
            axis = self._vector(turn.axis)
            axis /= np.linalg.norm(axis)
            fixed = self._number(turn.angle)
            place = place * pinocchio.SE3(pinocchio.exp3(axis * fixed), np.zeros(3))
            for i, name in enumerate(self.names):
                rate = self._number(turn.angle, **{name: 1.0}) - fixed
                if rate:
                    joint = self._joint(joint, pinocchio.JointModelRevoluteUnaligned(rate * axis), place, i)
                    place = pinocchio.SE3.Identity()
        self.places[frame.name] = (joint, place)

    def _joint(self, parent: int, kind: Any, place: Any, coordinate: int) -> int:
        assert coordinate not in self.moved
        self.moved.append(coordinate)
        return int(self.tree.addJoint(parent, kind, place, self.names[coordinate]))

    def _body(self, body: Any) -> None:
        joint, place = self.places[body.frame]
        inertia = {name: self._number(getattr(body.inertia, name)) for name in ("xx", "yy", "zz", "xy", "xz", "yz")}
        tensor = np.array([[inertia["".join(sorted(a + b))] for b in "xyz"] for a in "xyz"])
        mass, com = self._number(body.mass), self._vector(body.com)
        self.tree.appendBodyToJoint(joint, pinocchio.Inertia(mass, com, tensor), place)

    def _ordered(self, values: Any) -> Any:
        return np.array([values[i] for i in self.moved])

    def _sorted(self, values: Any) -> Any:
        """Rows in the model's order."""
        ordered = np.zeros((self.model.n, *np.shape(values)[1:]))
        ordered[self.moved] = values
        return ordered

    def balance(self, q: Any, qd: Any, qdd: Any) -> Any:
        """tau of RNEA with the rotors (n)."""
        tau = pinocchio.rnea(self.tree, self.data, *(self._ordered(x) for x in (q, qd, qdd)))
        return self._sorted(tau) + self.rotors @ qdd

    def mass_matrix(self, q: Any) -> Any:
        """CRBA with the rotors (n, n)."""
        upper = np.triu(pinocchio.crba(self.tree, self.data, self._ordered(q)))
        full = upper + np.triu(upper, 1).T
        return self._sorted(self._sorted(full).T) + self.rotors

    def point(self, name: str, q: Any, qd: Any) -> tuple[Any, Any, Any]:
        """Position (3), Jacobian (3, n) and J-dot qd (3) of a point in world axes."""
        frame, at = self.points[name]
        joint, place = self.places[frame]
        local = place.act(at)
        ordered = self._ordered(q), self._ordered(qd)
        zero = np.zeros(self.tree.nv)
        pinocchio.forwardKinematics(self.tree, self.data, *ordered, zero)
        pinocchio.computeJointJacobians(self.tree, self.data, ordered[0])
        pose = self.data.oMi[joint]
        if joint == 0:
            return local, np.zeros((3, self.model.n)), np.zeros(3)
        jacobian = pinocchio.getJointJacobian(self.tree, self.data, joint, pinocchio.LOCAL_WORLD_ALIGNED)
        arm = pose.rotation @ local
        linear = jacobian[:3] - pinocchio.skew(arm) @ jacobian[3:]
        velocity = pinocchio.getVelocity(self.tree, self.data, joint, pinocchio.LOCAL_WORLD_ALIGNED)
        acceleration = pinocchio.getClassicalAcceleration(self.tree, self.data, joint, pinocchio.LOCAL_WORLD_ALIGNED)
        turning = velocity.angular
        bias = acceleration.linear + np.cross(acceleration.angular, arm) + np.cross(turning, np.cross(turning, arm))
        return pose.act(local), self._sorted(linear.T).T, bias
