"""A wheel that all but lies flat: heading and spin turn about one axis, and the digits of u, q_ddot and lambda stay.

What differs between the two is the cosine of the lean.  It stands in the torques on the wheel, in what rolls and in the
inertias, and each of them has to bring it to its last digit.
"""

from __future__ import annotations

import math
from functools import cache

import pytest

from symgen.generation.draft import Draft, draft_of
from symgen.generation.results import Options
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.quantities import MOTIONS
from symgen.validity.definiteness import definite_beside_rows, indefinite_model
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.tolerance import FACTOR, expectations

# A coin whose rim is drawn by a torque about the vertical, with a weight on a bar of its own.
COIN = """
model: coin
coordinates: {x: {unit: m}, y: {unit: m}, z: {unit: m}, turn: {unit: rad}, tilt: {unit: rad}, roll: {unit: rad}}
parameters: {R: {value: 0.21}, m: {value: 1.7}, l: {value: 0.12}}
gravity: [0, 0, -9.81]
frames:
  yoke: {translation: [x, y, z], rotation: [[z, turn], [x, tilt]]}
  rim: {parent: yoke, rotation: [[y, roll]]}
joints:
  bar: {type: revolute, axis: y, parent: yoke, coordinate: swing}
bodies:
  rim: {mass: m, inertia: {xx: m*R**2/4, yy: m*R**2/2, zz: m*R**2/4}}
  bar: {mass: 0.4, com: [0, 0, -l], inertia: {xx: 0.004, yy: 0.004, zz: 0.004}}
rolling:
  floor: {frame: rim, radius: R}
inputs:
  push: {torque_on: rim, direction: [0, 1, 0], axes: yoke}
  steer: {torque_on: rim, direction: [0, 0, 1]}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
configuration: {z: 0.15}
"""
OUTPUTS = ("inverse_dynamics", "forward_dynamics", "multipliers")
PARAMETERS = (0.21, 1.7, 0.12)


@cache
def coin() -> tuple[Draft, Reference]:
    model = load_text(COIN, "coin.yaml")
    return draft_of(model, OUTPUTS, Options(methods=dict.fromkeys(MOTIONS, "articulated"))), Reference(model)


def leaning(off: float) -> State:
    """So many radians off the ground, rolling, in numbers that float64 holds."""
    tilt = math.pi / 2 - off
    q = (0.1, -0.2, PARAMETERS[0] * math.cos(tilt), 0.7, tilt, 0.4, -0.3)
    given = ((0.1, -0.3, 0.2, 0.5, -0.4, 0.8, 0.3), (0.4, 0.2, -0.1, -0.6, 0.3, 0.5, -0.2), (1.3, -0.8))
    return State(q, *given, PARAMETERS)


@pytest.mark.parametrize("quantity", OUTPUTS)
@pytest.mark.parametrize("decade", [2, 4, 6])
def test_digits_stay_beside_the_ground(quantity: str, decade: int) -> None:
    draft, reference = coin()
    program = draft.programs["float64"]
    kernel = next(one for one in program.kernels if one.name == quantity)
    state = leaning(10.0**-decade)
    (outcome,) = outcomes(kernel, program.sincos, "float64", [state])
    truth = expectations(reference, state, [quantity], "float64", f"coin {decade}", all_literals=True)[quantity]
    assert outcome.valid
    assert truth.in_units(truth.distance(outcome.entries)) <= FACTOR


def test_articulated_inertias_are_valid_where_nothing_holds_what_has_no_mass() -> None:
    model = load_text(COIN, "coin.yaml")
    assert indefinite_model(model) is not None
    assert definite_beside_rows(model)
    methods = Methods(model, genericity(System(model)))
    for quantity in MOTIONS:
        candidate = methods.candidate(quantity, "articulated")
        assert isinstance(candidate, Candidate)
        assert methods.validity(candidate).admitted


# A ring about a rod that turns: where it stands on the axis its own turn has no inertia, and a gear may hold it.
RING = """
model: ring
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}}}
kinetic_energy: a_dot**2/2 + sin(a)**2*b_dot**2/2 + c_dot**2/2
constraints:
  geometric: {{gear: {gear}}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
outputs: [forward_dynamics]
configuration: {{a: 0.7, b: 0.3, c: {c}}}
"""


@pytest.mark.parametrize(("gear", "c", "definite"), [("b - c - 0.2", 0.1, False), ("a - c - 0.2", 0.5, True)])
def test_rows_that_hold_what_has_no_mass(gear: str, c: float, definite: bool) -> None:
    """Geared to c the motion of b is determined on the axis, where G alone does not tell it."""
    assert definite_beside_rows(load_text(RING.format(gear=gear, c=c), "ring.yaml")) is definite
