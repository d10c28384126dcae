"""q_ddot and lambda with dependent accelerations substituted: right, shorter, and divided by nothing that vanishes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from symgen.ir.kernel import Status
from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.partitioned import PARTITIONED, pivots
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.methods.workspace import Workspace
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten

# A platform in the plane on three legs whose lengths are coordinates.
TRIPOD = """
model: tripod
gravity: [0, -9.81, 0]
coordinates:
  x: {unit: m}
  y: {unit: m}
  a: {unit: rad}
  s_1: {unit: m, range: [0.5, 2]}
  s_2: {unit: m, range: [0.5, 2]}
  s_3: {unit: m, range: [0.5, 2]}
parameters: {m: {value: 3, range: [1, 5]}, J: {value: 0.2, range: [0.1, 1]}}
frames:
  platform: {translation: [x, y, 0], rotation: [[z, a]]}
bodies:
  platform: {mass: m, inertia: {zz: J}}
rotor_inertias: {s_1: 0.5, s_2: 0.7, s_3: 0.9}
points:
  head_1: {frame: platform, at: [-0.3, -0.1, 0]}
  head_2: {frame: platform, at: [0.3, -0.1, 0]}
  head_3: {frame: platform, at: [0.1, 0.4, 0]}
constraints:
  geometric:
    leg_1: (head_1.x + 0.8)**2 + head_1.y**2 - s_1**2
    leg_2: (head_2.x - 0.9)**2 + head_2.y**2 - s_2**2
    leg_3: head_3.x**2 + (head_3.y - 2)**2 - s_3**2
inputs: {f_1: {joint: s_1}, f_2: {joint: s_2}, f_3: {joint: s_3}}
configuration: {x: 0.1, y: 0.9, a: 0.2, s_1: 1, s_2: 1, s_3: 1}
outputs: [forward_dynamics, multipliers]
"""
# A slider whose place and a wheel whose turning are given by a crank, and a rod that closes a loop besides.
SLIDER = """
model: slider
coordinates: {a: {}, b: {}, w: {}, x: {}, y: {}, z: {}}
kinetic_energy: >-
  (0.3 + 0.1*cos(a - b))*a_dot**2 + 0.2*b_dot**2 + 0.05*w_dot**2 + x_dot**2 + 2*y_dot**2 + z_dot**2 + x_dot*w_dot/9
potential_energy: 3*y + 2*sin(b)
constraints:
  geometric:
    along: x - cos(a) - 2*cos(b)
    up: y - sin(a) - 2*sin(b)
    rod: (x - 1)**2 + y**2 - 4
  nonholonomic:
    gear: 3*w_dot + (2 + sin(a))*a_dot - z_dot
inputs: {T: {acts_on: {a: 1}}, F: {acts_on: {z: 1}}}
configuration: {a: 0.7, b: 0.4, w: 0, x: 2.6, y: 1.4, z: 0}
outputs: [forward_dynamics, multipliers]
"""
# A tip given relative to angles of which one is carried by the other.
TIP = """
model: tip
gravity: [0, -9.81, 0]
coordinates: {x: {unit: m}, y: {unit: m}}
joints:
  upper: {type: revolute, axis: z, coordinate: a}
  lower: {type: revolute, axis: z, parent: upper, at: [1, 0, 0], coordinate: b}
bodies:
  upper: {mass: 2, com: [0.5, 0, 0], inertia: {zz: 0.1}}
  load: {mass: 4}
  lower: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.05}}
frames:
  load: {translation: [x, y, 0]}
points:
  end: {frame: lower, at: [0.8, 0, 0]}
constraints:
  geometric: {across: x - end.x, up: end.y - y}
inputs: {T: {joint: a}, K: {joint: b}}
configuration: {a: 0.4, b: 0.9, x: 1, y: 1}
outputs: [forward_dynamics, multipliers]
"""


def made(text: str) -> tuple[System, Motion]:
    """q_ddot and lambda by substitution, on the system's graph."""
    model = load_text(text, "model.yaml")
    workspace = Workspace(model, genericity(System(model)))
    candidates = [PARTITIONED.build(workspace, quantity) for quantity in ("forward_dynamics", "multipliers")]
    q_ddot, multipliers = (one for one in candidates if isinstance(one, Candidate))
    motion = Motion(q_ddot.derived.outputs, multipliers.derived.outputs, q_ddot.derived.guards, q_ddot.divisors)
    return q_ddot.system.mechanics, motion


@pytest.mark.parametrize("text", [TRIPOD, SLIDER, TIP], ids=["tripod", "slider", "tip"])
def test_they_solve_the_equations_of_motion(text: str) -> None:
    mechanics, motion = made(text)
    source = np.random.default_rng(5)
    # the reference stands on a graph of its own: beside each other equal functions are one node
    own = System(mechanics.model)
    problem, n, r = Problem(own, ()), own.n, own.r
    for configuration in configurations(own):
        at = dict(configuration)
        at |= {str(symbol.payload): source.uniform(-1, 1) for symbol in (*own.qd, *own.u)}
        given = Evaluator([*flatten(problem.mass_matrix), *flatten(problem.rows), *problem.force, *problem.bias])(at)
        mass, rows, force, bias = np.split(np.array(given), np.cumsum([n * n, r * n, n]))
        mass, rows = mass.reshape(n, n), rows.reshape(r, n)
        whole = np.block([[mass, rows.T], [rows, np.zeros((r, r))]])
        expected = np.linalg.solve(whole, np.concatenate([force, -bias]))
        values = Evaluator([*motion.accelerations, *motion.multipliers])(at)
        assert values == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_what_is_substituted_is_told_by_its_row_and_column() -> None:
    def names(text: str) -> list[str]:
        mechanics = System(load_text(text, "model.yaml"))
        return [mechanics.model.coordinates[pivot.column].name for pivot in pivots(mechanics)]

    assert names(TRIPOD) == ["s_1", "s_2", "s_3"]
    assert sorted(names(SLIDER)) == ["x", "y", "z"]
    assert sorted(names(TIP)) == ["x", "y"]


def test_a_length_that_may_be_0_is_not_divided_by() -> None:
    free = load_text(TRIPOD.replace(", range: [0.5, 2]", ""), "model.yaml")
    assert pivots(System(free)) == []
    workspace = Workspace(free, genericity(System(free)))
    assert "no row gives a coordinate" in str(PARTITIONED.build(workspace, "forward_dynamics"))


def test_a_leg_of_no_length_has_a_status() -> None:
    """Its row vanishes there: what is divided by is compared with the length of the row."""
    _, motion = made(TRIPOD)
    (first, *_) = (guard for guard in motion.guards if guard.status is Status.CONSTRAINT_RANK)
    at = {"x": 0.0, "y": 0.9, "a": 0.2, "s_1": 0.0, "s_2": 1.0, "s_3": 1.0}
    assert first.scale is not None
    denominator, scale = Evaluator([first.denominator, first.scale])(at)
    assert denominator == 0 < scale


def test_pivots_that_are_no_numbers_are_searched_for_zeros() -> None:
    model = load_text(TRIPOD, "model.yaml")
    methods = Methods(model, genericity(System(model)))
    candidate = methods.candidate("forward_dynamics", "partitioned")
    assert isinstance(candidate, Candidate)
    validity = methods.validity(candidate)
    assert validity.admitted
    assert validity.proved + validity.searched == 3
    # one that vanishes at regular states, as a sine does, is seen
    angle = candidate.system.mechanics.graph.symbol("a")
    sine = candidate.system.mechanics.graph.trig("sin", angle)
    assert not methods.validity(replace(candidate, divisors=(sine,))).admitted


FOURTH_LEG = {
    "s_3: {unit: m, range: [0.5, 2]}": "s_3: {unit: m, range: [0.5, 2]}\n  s_4: {unit: m, range: [0.5, 2]}",
    "s_3: 0.9": "s_3: 0.9, s_4: 0.6",
    "at: [0.1, 0.4, 0]}": "at: [0.1, 0.4, 0]}\n  head_4: {frame: platform, at: [-0.2, 0.3, 0]}",
    "- s_3**2": "- s_3**2\n    leg_4: (head_4.x + 1)**2 + (head_4.y - 1.7)**2 - s_4**2",
    "s_3: 1}": "s_3: 1, s_4: 1}",
}


@pytest.mark.campaign
def test_rows_that_give_coordinates_cost_little() -> None:
    """Legs leave the three accelerations of the platform; every other method carries those of the legs, and the rows.

    So one leg more adds less than half of what it adds there, and with three this is already the cheapest.
    """
    four = TRIPOD
    for old, new in FOURTH_LEG.items():
        assert old in four
        four = four.replace(old, new)
    weights: dict[str, list[int]] = {}
    for text in (TRIPOD, four):
        model = load_text(text, "model.yaml")
        methods = Methods(model, genericity(System(model)))
        for name in ("partitioned", "schur_qr", "nullspace"):
            one = methods.candidate("forward_dynamics", name)
            assert isinstance(one, Candidate)
            weights.setdefault(name, []).append(one.weight)
    assert weights["partitioned"][0] < min(weights["schur_qr"][0], weights["nullspace"][0])
    added = {name: more - three for name, (three, more) in weights.items()}
    assert added["partitioned"] < min(added["schur_qr"], added["nullspace"]) / 2
