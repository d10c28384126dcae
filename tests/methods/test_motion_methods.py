"""Every method of q_ddot and lambda solves the same KKT system, also where rows of B depend on each other."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest
from shipped import model

from symgen.linear_algebra.minor_sums import elementary_symmetric
from symgen.linear_algebra.null_space.null_spaces import MinorSpace
from symgen.linear_algebra.null_space.pivoted import PivotedSpace, reflected
from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import AlongNullSpace, motions_along
from symgen.methods.table import method, methods
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten
from symgen.validity.definiteness import positive_definite

# Three equal cranks hold a beam (five of six rows are independent) on which two masses slide: delta = 3.
CRANKS = """
model: sliding_cranks
coordinates:
  a: {unit: rad}
  b: {unit: rad}
  d: {unit: rad}
  x: {unit: m}
  y: {unit: m}
  p: {unit: rad}
  z: {unit: m}
  w: {unit: m}
parameters: {l: 1, h: 1.5, m: 1, J: 0.1}
kinetic_energy: >-
  J*(a_dot**2 + b_dot**2 + d_dot**2)/2 + 3*m*(x_dot**2 + y_dot**2)/2 + m*h**2/2*p_dot**2
  + m*(z_dot**2 + w_dot**2/2 + x_dot*z_dot/4 + x_dot*w_dot/3) + m*l/5*cos(a)*a_dot*z_dot
constraints:
  geometric:
    a_x: l*cos(a) - h - x + h*cos(p)
    a_y: l*sin(a) - y + h*sin(p)
    b_x: l*cos(b) - x
    b_y: l*sin(b) - y
    d_x: l*cos(d) + h - x - h*cos(p)
    d_y: l*sin(d) - y - h*sin(p)
inputs: {T: {acts_on: {a: 1}}, F: {acts_on: {z: 1, w: 1/2}}, K: {acts_on: {w: 1, x: 1/3}}}
configuration: {a: 0.9, b: 0.9, d: 0.9, x: 0.62, y: 0.78, p: 0, z: 0, w: 0}
"""


def point(mechanics: System, q: dict[str, float] | None = None) -> dict[str, float]:
    """A configuration on V with random rates and inputs."""
    source = random.Random(7)
    values = dict(configurations(mechanics)[0]) | (q or {})
    for symbol in (*mechanics.qd, *mechanics.u):
        values[str(symbol.payload)] = source.uniform(-1, 1)
    return values


def numbers(scalars: Any, at: dict[str, float], *shape: int) -> Any:
    return np.array(Evaluator(list(scalars))(at)).reshape(shape)


def solution(mechanics: System, at: dict[str, float]) -> tuple[Any, Any]:
    """q_ddot and the shortest lambda."""
    problem = Problem(mechanics, ())
    n, r = mechanics.n, mechanics.r
    G, B = numbers(flatten(problem.mass_matrix), at, n, n), numbers(flatten(problem.rows), at, r, n)
    f, a = numbers(problem.force, at, n), numbers(problem.bias, at, r)
    system = np.block([[G, B.T], [B, np.zeros((r, r))]])
    qdd = np.linalg.lstsq(system, np.concatenate([f, -a]), rcond=1e-10)[0][:n]
    return qdd, np.linalg.pinv(B.T, rcond=1e-8) @ (f - G @ qdd)


def check(mechanics: System, motion: Motion, at: dict[str, float]) -> None:
    qdd, multipliers = solution(mechanics, at)
    assert numbers(motion.accelerations, at, mechanics.n) == pytest.approx(qdd, rel=1e-9, abs=1e-9)
    assert numbers(motion.multipliers, at, mechanics.r) == pytest.approx(multipliers, rel=1e-9, abs=1e-9)
    for guard in motion.guards:
        value, scale = Evaluator([guard.denominator, guard.denominator if guard.scale is None else guard.scale])(at)
        assert 1e-6 < abs(value) / abs(scale) <= 1 + 1e-12


NAMES = [row.name for row in methods("multipliers") if isinstance(row.load(), AlongNullSpace)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("system", ["skate", "front_car_wheelset", "slider_crank", "rapkm_2rrr_rr"])
def test_methods(system: str, name: str) -> None:
    mechanics = System(model(system))
    one = method("multipliers", name)
    assert isinstance(one, AlongNullSpace)
    make = reflected if one.orthonormal else MinorSpace
    space = make(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, mechanics.r)
    check(mechanics, one.solved(Derivation(mechanics, genericity(mechanics), space)), point(mechanics))


@pytest.mark.parametrize("system", ["front_car", "slider_crank"])
def test_only_methods_without_squared_condition_numbers_are_chosen(system: str) -> None:
    mechanics = System(model(system))
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, mechanics.r)
    assert [*motions_along(Derivation(mechanics, genericity(mechanics), space))] == ["minor", "schur_qr"]


# at 90 degrees the rows a_x, b_x and d_x have no other entries but those of x and p: a choice without one of them fails
@pytest.mark.slow
@pytest.mark.parametrize("crank", [0.9, math.pi / 2, 2.5, -math.pi / 2])
def test_dependent_rows_with_three_degrees_of_freedom(crank: float) -> None:
    mechanics = System(load_text(CRANKS, "sliding_cranks.yaml"))
    generic = genericity(mechanics)
    assert (generic.rank, generic.r, generic.delta) == (5, 6, 3)
    q = dict.fromkeys("abd", crank) | {"x": math.cos(crank), "y": math.sin(crank), "p": 0.0}
    at = point(mechanics, q)
    space = reflected(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    assert isinstance(space, PivotedSpace)
    derivation = Derivation(mechanics, generic, space)
    motions = motions_along(derivation)
    assert [*motions] == ["schur_qr", "nullspace"]
    for motion in motions.values():
        check(mechanics, motion, at)
    B = numbers(flatten(space.rows), at, 6, 8)
    assert numbers(flatten(space.pseudoinverse), at, 8, 6) == pytest.approx(np.linalg.pinv(B, rcond=1e-8), abs=1e-13)
    exact = np.eye(8) - np.linalg.pinv(B, rcond=1e-8) @ B
    assert numbers(flatten(space.projector), at, 8, 8) == pytest.approx(exact, abs=1e-13)
    singular = np.linalg.svd(B, compute_uv=False)
    assert numbers([space.square], at, 1)[0] == pytest.approx(np.prod(singular[:5] ** 2), rel=1e-12)


def test_a_coordinate_without_mass_is_found_out() -> None:
    massless = """
model: massless
coordinates: {x: {}, y: {}}
parameters: {m: 2}
kinetic_energy: m/2*(x_dot**2 + 2*x_dot*y_dot*coupling + y_dot**2)
constraints: {nonholonomic: {row: x_dot - y_dot}}
"""

    def definite(coupling: str) -> bool:
        return positive_definite(System(load_text(massless.replace("coupling", coupling), "massless.yaml")))

    assert not definite("1")
    assert not definite("sin(3*x)")  # at x = 30 degrees
    assert definite("sin(3*x)*9/10")


def test_elementary_symmetric_polynomials() -> None:
    graph = System(model("skate")).graph
    values = [graph.const(k) for k in (2, 3, 5)]
    assert [elementary_symmetric(graph, values, k).constant for k in range(4)] == [1, 10, 31, 30]
