"""Loads that a drive bears alone: they stay out of what is projected."""

from __future__ import annotations

import numpy as np
import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.spaces import derivations
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten

# Three rates in one row, two of them driven, one of these through a gear; a heavy weight loads the first alone.
HOIST = """model: hoist
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
parameters: {m: {value: 1000}, g: {value: 9.81, unit: 1/s**2}}
kinetic_energy: 1/2*(m*a_dot**2 + 2*b_dot**2 + 3*c_dot**2 + d_dot**2)
potential_energy: g*(m*sin(a) + 1/5*cos(b + c) + d**2)
constraints: {geometric: {link: 'sin(a) + cos(b)*sin(c) + 1/2*d - 1/3'}}
inputs: {u: {acts_on: {a: 1}}, v: {acts_on: {c: -3}}}
outputs: [inverse_dynamics, inverse_dynamics_residual]
"""


def test_a_large_load_of_a_drive_leaves_the_other_inputs_alone() -> None:
    mechanics = System(load_text(HOIST, "hoist.yaml"))
    generic = genericity(mechanics)
    assert (generic.delta, generic.alpha) == (3, 2)
    drawn = np.random.default_rng(4)
    for derivation in derivations(mechanics, generic).values():
        wanted = (*derivation.inverse_dynamics, *derivation.inverse_dynamics_residual())
        parts = (*flatten(mechanics.constraint_jacobian), *mechanics.balance)
        evaluate = Evaluator([*wanted, *parts])
        for _ in range(20):
            names = [f"{q}{rate}" for q in "abcd" for rate in ("", "_dot", "_ddot")]
            point = {"m": 1000.0, "g": 9.81} | dict(zip(names, drawn.uniform(-1, 1, len(names)), strict=True))
            values = np.array(evaluate(point))
            u, residual, row, force = values[:2], values[2:6], values[6:10], values[10:]
            # independent of what is loaded: the same with the load of the first drive taken off
            projector = np.eye(4) - np.outer(row, row) / (row @ row)
            control = np.array([[1.0, 0], [0, 0], [0, -3], [0, 0]])
            rest = force - force[0] * control[:, 0]
            others = np.linalg.pinv(projector @ control) @ (projector @ rest)
            assert u == pytest.approx(np.add(others, (force[0], 0)), rel=1e-13, abs=1e-12)
            # about 1e4 is what loads the first drive, and nothing is left of its rounding here
            assert abs(u[1] - others[1]) < 1e-14 * max(1, abs(others[1])) * 30
            assert residual == pytest.approx(projector @ (rest - control @ others), rel=1e-12, abs=1e-13)
