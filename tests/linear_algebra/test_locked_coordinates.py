"""Coordinates that rows without others lock: N_B is 0 there without a rounding."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.spaces import derivations
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import flatten

# a and b are locked, by two rows and by one more that follows from these; c and d move along, and with c what b drives
TRUSS = """model: truss
coordinates: {c: {unit: rad}, a: {unit: rad}, d: {unit: rad}, b: {unit: rad}, e: {unit: rad}}
parameters: {k: 2}
kinetic_energy: 1/2*(3*c_dot**2 + 2*d_dot**2 + a_dot**2 + (1 + sin(c)**2)*b_dot**2 + e_dot**2)
constraints:
  geometric:
    first: sin(a) + 2*cos(b) - 3/2
    second: cos(2*a) - sin(b)**2 + 1/4
    third: sin(a) + 2*cos(b) - 3/2 + 3*(cos(2*a) - sin(b)**2 + 1/4)*(2 + cos(a)){more}
    slide: d - sin(c) - cos(a + c)*b
friction: {a: {viscous: 0.5}, b: {viscous: 0.3, coulomb: 0.2, width: 0.01}}
inputs: {u: {acts_on: {c: 1, a: 1}}}
outputs: [projected_applied_force, inverse_dynamics, forward_dynamics]
configuration: {a: 0.5235987755982988, b: 1.0471975511965976, c: 0.4}
"""


@pytest.mark.parametrize("dependent", [True, False])
def test_projections_hold_locked_coordinates(dependent: bool) -> None:
    text = TRUSS.replace("{more}", "")
    if not dependent:
        text = "\n".join(line for line in text.splitlines() if "third:" not in line)
    mechanics = System(load_text(text, "truss.yaml"))
    generic = genericity(mechanics)
    assert (generic.rank, generic.locked) == (3, (1, 3))
    along = derivations(mechanics, generic)["householder"]
    projector = along.space.projector
    assert all(projector[i][j].is_zero for i in (1, 3) for j in range(5))
    assert all(x.is_zero for x in along.space.project(mechanics.applied_force_at(along.admissible)))
    values = Evaluator([*flatten(projector), *flatten(along.space.pseudoinverse), *flatten(along.space.rows)])
    for point in configurations(mechanics):
        numbers = np.array(values(point))
        r = generic.r
        rows = numbers[25 + 5 * r :].reshape(r, 5)
        inverse = np.linalg.pinv(rows, rcond=1e-9)
        assert numbers[:25].reshape(5, 5) == pytest.approx(np.eye(5) - inverse @ rows, abs=1e-12)
        assert numbers[25 : 25 + 5 * r].reshape(5, r) == pytest.approx(inverse, abs=1e-10)


def test_what_is_held_along_a_branch_alone_is_not_locked() -> None:
    """x y = 0 holds y along y = 0, and x along x = 0, with the same rank."""
    text = """model: cross
coordinates: {x: {unit: m}, y: {unit: m}, z: {unit: m}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints: {geometric: {cross: x*y}}
configuration: {x: 1, y: 0}
"""
    mechanics = System(load_text(text, "cross.yaml"))
    assert genericity(mechanics).locked == ()


def test_a_rank_that_moved_to_other_rows_is_a_status() -> None:
    """Where the rows of locked coordinates lose rank nothing says any more that these do not move."""
    graph = Graph()
    one, zero, s = graph.one, graph.zero, graph.symbol("s")
    rows = ((one, s, zero), (one, 2 * s, zero), (2 * one, 3 * s, zero), (one, one, one), (one, one, 3 * one))
    space = reflected(graph, rows, 3, 3, locked=(0, 1))
    pairs = [x for guard in space.guards for x in (guard.denominator, guard.scale) if x is not None]
    regular, lost = (Evaluator(pairs)({"s": s}) for s in (0.5, 0.0))
    assert all(a > 1e-3 * b for a, b in zip(regular[::2], regular[1::2], strict=True))
    assert any(abs(a) < 1e-12 * b for a, b in zip(lost[::2], lost[1::2], strict=True))


# A triangle of two bars, at whose joint a flap turns that nothing else moves; its own axes are turned against the bars.
FLAP = """
model: flap
parameters: {l: 0.7, c: 0.31, d: 0.17, e: 0.11}
joints:
  left: {type: revolute, axis: y, coordinate: a}
  right: {type: revolute, parent: left, at: [l, 0, 0], axis: y, coordinate: b}
  flap: {type: revolute, parent: left, at: [l, 0, 0], axis: AXIS, coordinate: f}
bodies:
  left: {mass: 2, com: [l/2, 0, 0], inertia: {yy: 0.1}}
  flap: {mass: 3, com: [c, e, d], inertia: {xx: 0.1, yy: 0.2, zz: 0.25, xy: 0.01, yz: -0.02}}
points:
  foot: {frame: right, at: [0.6, 0, 0]}
  pin: {at: [0.5, 0, 0]}
loops:
  triangle: {type: point, between: [foot, pin]}
inputs:
  motor: {joint: a}
outputs: [forward_dynamics]
configuration: {a: 1, b: -2.2}
"""


@pytest.mark.parametrize("axis", ["y", "[0, -1, 0]", "[1, 2, 3]"])
def test_a_body_on_what_cannot_move_is_turned_by_nothing(axis: str) -> None:
    """Its acceleration is exactly 0, of which no rounding may be left (draw 1115:186)."""
    mechanics = System(load_text(FLAP.replace("AXIS", axis), "flap.yaml"))
    assert mechanics.bodies.held == {0, 1}
    plain = System(replace(mechanics.model, assembly=None))
    evaluate, other = Evaluator(mechanics.applied_balance), Evaluator(plain.applied_balance)
    drawn = random.Random(axis)
    values = {"l": 0.7, "c": 0.31, "d": 0.17, "e": 0.11, "motor": 0.4}
    rests = []
    for _ in range(20):
        at = values | {name: drawn.uniform(-3, 3) for name in ("a", "b", "f", "a_dot", "b_dot", "f_dot")}
        assert evaluate(at) == pytest.approx(other(at), rel=1e-12, abs=1e-12)
        still = at | {"a_dot": 0.0, "b_dot": 0.0}
        assert evaluate(still)[2] == 0
        rests.append(other(still)[2])
    assert any(rests)
