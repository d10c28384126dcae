"""q_ddot and lambda of bodies that quaternions turn go from body to body, the lengths of the quaternions apart."""

from __future__ import annotations

import random

import pytest

from symgen.linear_algebra.constrained_inverse import BasisInertia
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor
from symgen.mechanics.rigid_bodies.quaternion_joints import quaternion_parts, turning_rate
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.along_spaces import nullspace
from symgen.methods.forward_dynamics.articulated import articulated
from symgen.methods.forward_dynamics.held_lengths import completed_multipliers
from symgen.methods.forward_dynamics.motion import Problem
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.model.quantities import MOTIONS
from symgen.quantities.select import derive_quantities
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import cost

SWING = """model: swing
parameters: {{m: 1.3, l: 0.4, g: 9.81}}
gravity: [0, -g, 0]
joints:
  shoulder: {{type: spherical, at: [0, l, 0], child: arm, coordinates: [a_0, a_1, a_2, a_3]}}
  elbow: {{type: revolute, parent: arm, at: [l, 0, 0.1], axis: [0, 0.6, 0.8], coordinate: b}}
  wrist: {{type: spherical, parent: elbow, at: [0, l, 0], rotation: [[x, 0.3]], child: hand,
          coordinates: [w_0, w_1, w_2, w_3]}}
bodies:
  arm: {{mass: m, com: [l/2, 0, 0.02], inertia: {{xx: 0.02, yy: 0.03, zz: 0.035, xy: 0.002}}}}
  elbow: {{mass: 2*m, com: [0, l/2, 0], inertia: {{xx: 0.03, yy: 0.01, zz: 0.03}}}}
  hand: {{mass: 0.5, com: [0.1, 0, 0.05], inertia: {{xx: 0.002, yy: 0.003, zz: 0.004}}}}
points: {{tip: {{frame: hand, at: [0.2, 0, 0.1]}}, hook: {{at: [1, 0.2, -1]}}}}
{constraints}
inputs:
  u: {{joint: b}}
  v: {{cable: [tip, hook]}}
{inputs}
outputs: [forward_dynamics, multipliers]
"""
HELD = "constraints: {geometric: {height: tip.y - 0.3}}"
# a row and a force that know a quaternion's length
FELT = "constraints: {geometric: {gear: w_0 - 0.4*b - 0.9*a_1}}"
DRIVEN = "  w: {acts_on: {w_0: 1, w_2: -0.3}}"

CRAFT = """model: craft
parameters: {m: 3, J: 0.1}
gravity: [0, 0, -9.81]
joints:
  hull: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}
  wheel: {type: revolute, parent: hull, axis: [0, 0.6, 0.8], at: [0.1, 0, 0.2], coordinate: a}
  pod: {type: spherical, parent: hull, at: [0, 0.3, 0], coordinates: [p_0, p_1, p_2, p_3]}
bodies:
  hull: {mass: m, com: [0.05, 0, 0.02], inertia: {xx: J, yy: 1.2*J, zz: 0.9*J, xy: 0.01}}
  wheel: {mass: 1, inertia: {xx: 0.01, yy: 0.01, zz: 0.015}}
  pod: {mass: 0.8, com: [0, 0, -0.1], inertia: {xx: 0.01, yy: 0.01, zz: 0.004}}
inputs:
  f: {point: hull, direction: [0, 0, 1], axes: hull}
  spin: {joint: a}
  s: {acts_on: {y: 1, e_3: 2}}
outputs: [forward_dynamics, multipliers]
"""


def swing(constraints: str = "", inputs: str = "") -> Model:
    """Two ball joints and a hinge between them."""
    return load_text(SWING.format(constraints=constraints, inputs=inputs), "swing.yaml")


def quaternions(model: Model) -> list[list[str]]:
    """The coordinates of each quaternion."""
    names = [c.name for c in model.coordinates]
    mechanics = System(model)
    return [[names[j] for j in joint.parts] for joint in ArticulatedFactor(mechanics.bodies).quaternions]


MODELS = {
    "free": swing(),
    "held": swing(HELD),
    "felt": swing(FELT, DRIVEN),
    "craft": load_text(CRAFT, "craft.yaml"),
}


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_as_along_an_orthonormal_basis(model: Model) -> None:
    """At random states, where no quaternion has length 1 and no row is 0."""
    generic = genericity(System(model))
    derived = articulated(model, generic)
    assert derived is not None
    methods, mechanics = Methods(model, generic), System(model)
    made = [methods.candidate(quantity, "nullspace") for quantity in MOTIONS]
    one = Evaluator([*derived[1].accelerations, *derived[1].multipliers])
    other = Evaluator([x for one in made if isinstance(one, Candidate) for x in one.derived.outputs])
    source = random.Random(5)
    for _ in range(4):
        point = dict(parameter_values(mechanics))
        for c in model.coordinates:
            point[c.name], point[c.rate] = source.uniform(-1, 1), source.uniform(-1, 1)
        for four in quaternions(model):
            point |= {name: source.choice([-1, 1]) * source.uniform(0.3, 0.9) for name in four}
        point |= {control.name: source.uniform(-1, 1) for control in model.inputs}
        assert one(point) == pytest.approx(other(point), rel=1e-9, abs=1e-9)


def test_what_holds_a_length_is_free_of_force() -> None:
    """Exactly 0 as long as nothing acts on the coordinates themselves; a cable acts on a body."""
    derived = articulated(swing(), genericity(System(swing())))
    driven = articulated(swing(inputs=DRIVEN), genericity(System(swing())))
    assert derived is not None
    assert driven is not None
    assert [x.is_zero for x in derived[1].multipliers] == [True, True]
    assert [x.is_zero for x in driven[1].multipliers] == [True, False]


# the coordinate of the rail moves two frames, so that there are no articulated inertias
RAIL = """model: rail
parameters: {{k: 30, J: 0.02}}
gravity: [0, 0, -9.81]
coordinates: {{s: , e_0: , e_1: , e_2: , e_3: }}
frames:
  cart: {{translation: [s, {away}, 0]}}
  wheel: {{translation: [0, 0.3, 0], rotation: [[y, s/0.2]]}}
  pod: {{parent: cart, rotation: {{quaternion: [e_0, e_1, e_2, e_3]}}}}
bodies:
  cart: {{mass: 3}}
  wheel: {{mass: 1, inertia: {{yy: J}}}}
  pod: {{mass: 2, com: [0, 0.1, -0.4], inertia: {{xx: 0.03, yy: 0.04, zz: 0.02}}}}
points: {{nose: {{frame: pod, at: [0.2, 0, 0]}}}}
constraints: {{geometric: {{unit: e_0**2 + e_1**2 + e_2**2 + e_3**2 - 1{row}}}}}
inputs:
  drive: {{joint: s}}
  push: {{point: nose, direction: [0, 1, 0]}}
forces:
  wind: {{point: nose, direction: [1, 0, 0], magnitude: "-k*nose.vx"}}
{more}
outputs: [forward_dynamics, multipliers]
"""
ODD = "applied_forces: {e_2: -0.3*e_1_dot}"
FOLLOWED = ", follows: s - 0.5*e_3 + 0.2*e_1"


def rail(row: str = "", more: str = "", away: str = "0") -> Model:
    """A pod in a ball joint on a cart."""
    return load_text(RAIL.format(row=row, more=more, away=away), "rail.yaml")


@pytest.mark.parametrize("model", [rail(), rail(more=ODD), rail(FOLLOWED, ODD), MODELS["felt"], MODELS["craft"]])
def test_lengths_are_completed_as_the_equations_have_it(model: Model) -> None:
    """Beside the multipliers of a null space, in which forces of bodies cancel."""
    mechanics = System(model)
    graph, rows = mechanics.graph, mechanics.constraint_jacobian
    space = reflected(graph, rows, mechanics.n, len(rows))
    plain = nullspace(Problem(mechanics, space.guards), space, BasisInertia(space, mechanics.mass_matrix))
    completed = completed_multipliers(mechanics)
    values = Evaluator([*plain.multipliers, *completed(plain.multipliers)])
    source = random.Random(7)
    for _ in range(4):
        point = dict(parameter_values(mechanics))
        for name in (x for c in model.coordinates for x in (c.name, c.rate)):
            point[name] = source.uniform(0.2, 0.9)
        point |= {control.name: source.uniform(-1, 1) for control in model.inputs}
        numbers = values(point)
        assert numbers[: len(rows)] == pytest.approx(numbers[len(rows) :], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", ["nullspace", "shifted", "kkt"])
def test_every_method_knows_that_no_force_stretches_a_quaternion(name: str) -> None:
    def unit(model: Model) -> bool:
        made = Methods(model, genericity(System(model))).candidate("multipliers", name)
        assert isinstance(made, Candidate)
        return made.derived.outputs[0].is_zero

    assert unit(rail())
    assert not unit(rail(more=ODD))


def test_a_quaternion_that_moves_more_than_an_attitude_is_no_attitude() -> None:
    """A mass feels its length then, be it by a place or by a rotor."""
    defined, rotor = rail(more="definitions: {d: e_0/2}", away="d"), rail(more="rotor_inertias: {e_1: J}")
    for model in (rail(away="e_0"), defined, rotor):
        symbol = System(model).graph.symbol("x")
        assert completed_multipliers(System(model))((symbol,)) == (symbol,)


def test_chains_of_ball_joints_go_from_body_to_body() -> None:
    choices = derive_quantities(swing(HELD), ["forward_dynamics", "multipliers"]).choices
    assert [choice.title for choice in choices] == ["articulated inertias"] * 2


def test_turning_rates_are_those_of_the_angular_velocity() -> None:
    """Term by term the rate of E times e' would be worked out, which is 0."""
    bodies = System(load_text(SWING.format(constraints="", inputs=""), "swing.yaml")).bodies
    graph, names = bodies.graph, [str(x.payload) for x in bodies.q]
    assert quaternion_parts(bodies, "elbow") == ()
    for frame, first in (("arm", "a_0"), ("hand", "w_0")):
        parts = quaternion_parts(bodies, frame)
        assert parts == tuple(range(names.index(first), names.index(first) + 4))
        e, e_dot = ([given[j] for j in parts] for given in (bodies.q, bodies.qd))
        e_ddot = [graph.symbol(f"{names[j]}_ddot") for j in parts]
        turning = bodies.kinematics.joint(frame).turning
        moved = derivative_along(graph, turning, dict(zip((*e, *e_dot), (*e_dot, *e_ddot), strict=True)))
        rates = turning_rate(e, e_dot, e_ddot, turning)
        assert [one.value for one in rates] == [other.value for other in moved]
        assert cost(rates).weight < cost(moved).weight


def test_a_rotor_resists_a_coordinate_and_no_turn() -> None:
    text = SWING.replace("type: spherical, at", "type: revolute, at").replace("[a_0, a_1, a_2, a_3]", "[a_0]")
    plain, rotor = (
        load_text(text.format(constraints=held, inputs=""), "swing.yaml")
        for held in ("", "rotor_inertias: {w_1: 0.01}")
    )
    assert quaternions(plain) == [["w_0", "w_1", "w_2", "w_3"]]
    assert quaternions(rotor) == []
