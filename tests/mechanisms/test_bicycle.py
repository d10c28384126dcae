"""The bicycle against the published benchmark: the linear equations about upright straight motion.

J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer of a
bicycle: a benchmark and review, Proc. R. Soc. A 463 (2007), (6.1)-(6.4): M q_ddot + v C1 q_dot + (g K0 + v^2 K2) q = f
in the lean to the right and the steer to the right.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from flint import arb, arb_mat

from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.admission import LOST
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model
from symgen.validity.resolution import distinguishable
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.reference import REFERENCE_BITS, Reference, State

M = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
K0 = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
K2 = np.array([[0, 76.59734589573222], [0, 2.65431523794604]])
C1 = np.array([[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])
G, RADIUS, STEP = 9.81, Fraction(3, 10), Fraction(1, 10**20)
Number: TypeAlias = int | Fraction
Numbers: TypeAlias = tuple[Any, Any]  # balls
# steering and leaning torque, the only inputs of the benchmark
NONE = (0, 0)


@cache
def bicycle() -> Reference:
    return Reference(load_model(Path(__file__).with_name("bicycle.yaml")))


def accelerations(
    speed: int, q: Sequence[Number] = NONE, qd: Sequence[Number] = NONE, f: Sequence[Number] = NONE
) -> Numbers:
    """Of lean and steer to the right, at a state that satisfies the constraints to first order in q; 50 digits."""
    model = bicycle().model
    names = [c.name for c in model.coordinates]
    place = {"z": RADIUS, "lean": q[0], "steer": -q[1]}
    own = {"lean": qd[0], "steer": -qd[1], "rear": speed / RADIUS}
    parameters = tuple(default_values(model.parameters).values())
    still = (0,) * model.n
    at = tuple(place.get(name, 0) for name in names)
    rows = bicycle().matrices(State(at, still, still, (0, 0, 0), parameters), ["constraint_jacobian"])
    with precision(REFERENCE_BITS):
        columns = list(zip(*rows["constraint_jacobian"].tolist(), strict=True))
        free = [k for k, name in enumerate(names) if name in own]
        held = [k for k in range(model.n) if k not in free]
        rates = [ball(own.get(name, 0)) for name in names]
        right = [sum((-columns[k][i] * rates[k] for k in free), arb(0)) for i in range(model.r)]
        square = arb_mat([[columns[k][i] for k in held] for i in range(model.r)])
        for k, rate in zip(held, square.solve(arb_mat([[x] for x in right])).entries(), strict=True):
            rates[k] = rate
    state = State(at, tuple(rates), still, (0, -f[1], f[0]), parameters)
    qdd = bicycle().matrices(state, ["forward_dynamics"])["forward_dynamics"]
    by_name = dict(zip(names, qdd.entries(), strict=True))
    return by_name["lean"], -by_name["steer"]


def difference(one: Numbers, other: Numbers, over: Number) -> list[float]:
    with precision(REFERENCE_BITS):
        return [float((x - y) / ball(over)) for x, y in zip(one, other, strict=True)]


def slopes(speed: int, of: str) -> np.ndarray:
    """Derivatives of the accelerations by lean and steer, or by their rates, as columns: off by STEP squared."""
    columns = []
    for k in range(2):
        there, back = ([sign * STEP * (i == k) for i in range(2)] for sign in (1, -1))
        columns.append(difference(accelerations(speed, **{of: there}), accelerations(speed, **{of: back}), 2 * STEP))
    return np.array(columns).T


def test_mass_matrix() -> None:
    inverse = np.array([difference(accelerations(0, f=f), accelerations(0), 1) for f in ((1, 0), (0, 1))]).T
    assert np.linalg.inv(inverse) == pytest.approx(M, rel=1e-12)


@pytest.mark.parametrize("speed", [0, 5])
def test_stiffness(speed: int) -> None:
    assert -M @ slopes(speed, "q") == pytest.approx(G * K0 + speed**2 * K2, rel=1e-12, abs=1e-12)


def test_damping() -> None:
    assert -M @ slopes(5, "qd") == pytest.approx(5 * C1, rel=1e-12, abs=1e-12)


@pytest.mark.mechanisms
def test_methods_that_float32_would_refuse_everywhere_are_told_apart() -> None:
    """Eight turns follow each other up to the front contact: sums of absolute terms exceed a determinant by 1e10.

    Minors stand beside the lengths of rows, which exceed them by little.
    """
    mechanics = System(bicycle().model)
    methods, points = Methods(mechanics.model, genericity(mechanics)), configurations(mechanics)
    made = {name: methods.candidate(INPUTS, name) for name in ("elimination", "minor", "nullspace")}
    standing = {
        name: distinguishable(one.derived.guards, mechanics.n, points)
        for name, one in made.items()
        if isinstance(one, Candidate)
    }
    assert standing == {"elimination": True, "minor": True, "nullspace": False}
    nullspace = made["nullspace"]
    assert isinstance(nullspace, Candidate)
    assert methods.validity(nullspace).explanation == LOST
