"""MuJoCo reads the same files: its mass matrices, forces and rows in the coordinates of symgen."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import robot_packages
from row_spaces import projector

from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator

mujoco = robot_packages.mujoco()

class Witness:
    """A file in MuJoCo, without limits, contacts and dry friction, whose forces are those of its solver."""

    def __init__(self, text: str) -> None:
        self.model = mujoco.MjModel.from_xml_string(text)
        flags = mujoco.mjtDisableBit
        self.model.opt.disableflags |= int(flags.mjDSBL_LIMIT | flags.mjDSBL_CONTACT | flags.mjDSBL_FRICTIONLOSS)
        self.data = mujoco.MjData(self.model)

    def state(self, seed: int) -> tuple[Any, Any, Any]:
        """A random configuration (quaternions of length 1), velocity and acceleration."""
        source = random.Random(seed)
        q = np.array([source.uniform(-1, 1) for _ in range(self.model.nq)])
        for kind, start in zip(self.model.jnt_type, self.model.jnt_qposadr, strict=True):
            if kind in (mujoco.mjtJoint.mjJNT_BALL, mujoco.mjtJoint.mjJNT_FREE):
                first = start + (3 if kind == mujoco.mjtJoint.mjJNT_FREE else 0)
                q[first : first + 4] /= np.linalg.norm(q[first : first + 4])
        return q, *(np.array([source.uniform(-1, 1) for _ in range(self.model.nv)]) for _ in range(2))

    def rates(self, q: Any, v: Any, a: Any) -> tuple[Any, Any, Any]:
        """The rates and their derivatives that velocities stand for, and the matrix in q' = N v."""
        matrix, change = np.zeros((self.model.nq, self.model.nv)), np.zeros((self.model.nq, self.model.nv))
        for kind, start, first in zip(
            self.model.jnt_type, self.model.jnt_qposadr, self.model.jnt_dofadr, strict=True
        ):
            if kind == mujoco.mjtJoint.mjJNT_FREE:
                matrix[start : start + 3, first : first + 3] = np.eye(3)
                start, first = start + 3, first + 3
            elif kind != mujoco.mjtJoint.mjJNT_BALL:
                matrix[start, first] = 1
                continue
            matrix[start : start + 4, first : first + 3] = turning(q[start : start + 4])
            rate = turning(q[start : start + 4]) @ v[first : first + 3]
            change[start : start + 4, first : first + 3] = turning(rate)
        return matrix @ v, matrix @ a + change @ v, matrix

    def forces(self, q: Any, v: Any, a: Any) -> Any:
        """What a motion needs of motors and rows."""
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EQUALITY)
        self.data.qpos[:], self.data.qvel[:], self.data.qacc[:] = q, v, a
        mujoco.mj_forward(self.model, self.data)
        self.data.qacc[:] = a
        mujoco.mj_inverse(self.model, self.data)
        self.model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_EQUALITY)
        return self.data.qfrc_inverse.copy()

    def mass_matrix(self, q: Any) -> Any:
        """That of joints and rotors."""
        self.data.qpos[:], self.data.qvel[:] = q, 0
        mujoco.mj_forward(self.model, self.data)
        matrix = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, matrix)
        return matrix

    def rows(self, q: Any) -> tuple[Any, Any]:
        """How far equalities are open, and their Jacobian."""
        self.data.qpos[:], self.data.qvel[:] = q, 0
        mujoco.mj_forward(self.model, self.data)
        rows = self.data.efc_J.reshape(-1, self.model.nv)[: self.data.nefc]
        return self.data.efc_pos[: self.data.nefc].copy(), rows.copy()

    def velocities(self, body: str, at: Any) -> Any:
        """Rows (w, v) of the velocity of a point of a body where the machine is now, in the axes of the world."""
        along, turning_rows = np.zeros((3, self.model.nv)), np.zeros((3, self.model.nv))
        number = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, body)
        self.data.qpos[:] = self.model.qpos0
        mujoco.mj_forward(self.model, self.data)
        mujoco.mj_jac(self.model, self.data, along, turning_rows, np.array(at), number)
        return np.vstack([turning_rows, along])


def turning(e: Any) -> Any:
    """The matrix in e' = E w, w in the axes of the body."""
    w, x, y, z = e
    return np.array([[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]]) / 2


def named(model: Model, q: Any, rate: Any, acceleration: Any) -> dict[str, float]:
    """The state by names, where coordinates stand as in the file."""
    state: dict[str, float] = {}
    for c, values in zip(model.coordinates, zip(q, rate, acceleration, strict=True), strict=True):
        state |= dict(zip((c.name, c.rate, c.acceleration), map(float, values), strict=True))
    return state


def check_tree(model: Model, witness: Witness, within: float, seeds: int = 4) -> None:
    """Mass matrix and inverse dynamics at random states, relative to their largest entry."""
    system = System(model)
    balance = Evaluator(list(system.balance))
    masses = Evaluator([entry for row in system.mass_matrix for entry in row])
    for seed in range(seeds):
        q, v, a = witness.state(seed)
        rate, acceleration, matrix = witness.rates(q, v, a)
        state = named(model, q, rate, acceleration)
        forces = witness.forces(q, v, a)
        assert np.abs(matrix.T @ np.array(balance(state)) - forces).max() < within * np.abs(forces).max()
        expected = witness.mass_matrix(q)
        n = len(model.coordinates)
        mine = matrix.T @ np.array(masses(state)).reshape(n, n) @ matrix
        assert np.abs(mine - expected).max() < within * np.abs(expected).max()


def check_rows(model: Model, witness: Witness, within: float, q: Any = None) -> None:
    """The rows of both span the same space at configurations where the loops are closed."""
    system = System(model)
    given = [q] if q is not None else [np.array(witness.model.qpos0)]
    for configuration in given:
        rate, acceleration, matrix = witness.rates(
            configuration, np.zeros(witness.model.nv), np.zeros(witness.model.nv)
        )
        state = named(model, configuration, rate, acceleration)
        residual = Evaluator(list(system.constraint_residual))(state)
        assert np.abs(residual).max() < within
        jacobian = Evaluator([entry for row in system.constraint_jacobian for entry in row])(state)
        mine = np.array(jacobian).reshape(-1, len(model.coordinates)) @ matrix
        open_by, theirs = witness.rows(configuration)
        assert np.abs(open_by).max() < within
        assert np.abs(projector(mine) - projector(theirs)).max() < within
