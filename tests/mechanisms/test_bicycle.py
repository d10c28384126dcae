"""The bicycle against the published benchmark: the linear equations about upright straight motion.

J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer of a
bicycle: a benchmark and review, Proc. R. Soc. A 463 (2007), (6.1)-(6.4): M q_ddot + v C1 q_dot + (g K0 + v^2 K2) q = f
in the lean to the right and the steer to the right.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.admission import LOST
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model
from symgen.validity.resolution import distinguishable
from symgen.verify.reference.reference import Reference, State

M = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
K0 = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
K2 = np.array([[0, 76.59734589573222], [0, 2.65431523794604]])
C1 = np.array([[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])
G, RADIUS, STEP = 9.81, 0.3, 1e-6
# steering and leaning torque, the only inputs of the benchmark
NONE = (0.0, 0.0)


@cache
def bicycle() -> Reference:
    return Reference(load_model(Path(__file__).with_name("bicycle.yaml")))


def accelerations(
    speed: float, q: Sequence[float] = NONE, qd: Sequence[float] = NONE, f: Sequence[float] = NONE
) -> np.ndarray:
    """Of lean and steer to the right, at a state that satisfies the constraints to first order in q."""
    model = bicycle().model
    names = [c.name for c in model.coordinates]
    place = {"z": RADIUS, "lean": q[0], "steer": -q[1]}
    own = {"lean": qd[0], "steer": -qd[1], "rear": speed / RADIUS}
    parameters = tuple(default_values(model.parameters).values())
    still = (0.0,) * model.n
    at = tuple(place.get(name, 0.0) for name in names)
    rows = bicycle().matrices(State(at, still, still, (0, 0, 0), parameters), ["constraint_jacobian"])
    jacobian = np.array([[float(x) for x in row] for row in rows["constraint_jacobian"].tolist()])
    free = [k for k, name in enumerate(names) if name in own]
    held = [k for k in range(model.n) if k not in free]
    rates = np.zeros(model.n)
    rates[free] = [own[names[k]] for k in free]
    rates[held] = np.linalg.solve(jacobian[:, held], -jacobian[:, free] @ rates[free])
    state = State(at, tuple(rates.tolist()), still, (0, -f[1], f[0]), parameters)
    found = bicycle().matrices(state, ["forward_dynamics"])["forward_dynamics"]
    by_name = dict(zip(names, map(float, found.entries()), strict=True))
    return np.array([by_name["lean"], -by_name["steer"]])


def slopes(speed: float, of: str) -> np.ndarray:
    """Derivatives of the accelerations by lean and steer, or by their rates, as columns."""
    columns = []
    for k in range(2):
        small = [STEP * (k == 0), STEP * (k == 1)]
        large = [-x for x in small]
        if of == "q":
            columns.append((accelerations(speed, q=small) - accelerations(speed, q=large)) / (2 * STEP))
        else:
            columns.append((accelerations(speed, qd=small) - accelerations(speed, qd=large)) / (2 * STEP))
    return np.array(columns).T


def test_mass_matrix() -> None:
    inverse = np.array([accelerations(0, f=f) - accelerations(0) for f in ((1.0, 0.0), (0.0, 1.0))]).T
    assert np.linalg.inv(inverse) == pytest.approx(M, rel=1e-9)


@pytest.mark.parametrize("speed", [0.0, 5.0])
def test_stiffness(speed: float) -> None:
    assert -M @ slopes(speed, "q") == pytest.approx(G * K0 + speed**2 * K2, rel=1e-6, abs=1e-6)


def test_damping() -> None:
    assert -M @ slopes(5.0, "qd") == pytest.approx(5.0 * C1, rel=1e-6, abs=1e-6)


def test_forms_that_float32_would_refuse_everywhere_are_told_apart() -> None:
    """Eight turns follow each other up to the front contact: sums of absolute terms exceed a determinant by 1e10.

    Minors stand beside the lengths of rows, which exceed them by little.
    """
    mechanics = System(bicycle().model)
    methods, points = Methods(mechanics.model, genericity(mechanics)), configurations(mechanics, 2)
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
