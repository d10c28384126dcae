"""q_ddot, lambda and weighted projections refined by Newton and Euler's equations; rows that depend on each other."""

from __future__ import annotations

import math
import random
from functools import cache

import pytest

from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.motions import BY_FRAMES
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.model.quantities import MOTIONS
from symgen.quantities.alternatives import Alternatives
from symgen.quantities.select import Choice
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.expected import Expected
from symgen.verify.interpreted import measured

# Tables on cranks, derived and compared with the reference.
pytestmark = pytest.mark.slow
# a table on three equal cranks; in space it is free but for the three points
PLANE = """model: table
gravity: [0, -9.81, 0]
joints:
  crank_a: {type: revolute, axis: z, coordinate: a}
  crank_b: {type: revolute, axis: z, at: [1, 0.2, 0], coordinate: b}
  crank_d: {type: revolute, axis: z, at: [2, 0, 0], coordinate: d}
  table: {type: revolute, parent: crank_a, at: [0.5, 0, 0], axis: z, coordinate: p}
bodies:
  crank_a: {mass: 1, com: [0.2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  crank_b: {mass: 2, com: [0.3, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  crank_d: {mass: 1, com: [0.2, 0.1, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  table: {mass: 5, com: [1, 0.1, 0], inertia: {xx: 0.1, yy: 0.5, zz: 0.6}}
points:
  tip_a: {frame: crank_a, at: [0.5, 0, 0]}
  tip_b: {frame: crank_b, at: [0.5, 0, 0]}
  tip_d: {frame: crank_d, at: [0.5, 0, 0]}
  foot_a: {frame: table}
  foot_b: {frame: table, at: [1, 0.2, 0]}
  foot_d: {frame: table, at: [2, 0, 0]}
loops:
  at_b: {type: point, between: [tip_b, foot_b]}
  at_d: {type: point, between: [tip_d, foot_d]}
inputs: {u: {joint: a}, v: {joint: d}}
configuration: {a: 0.7, b: 0.7, d: 0.7, p: -0.7}
"""
SPACE = (
    PLANE.replace(
        "table: {type: revolute, parent: crank_a, at: [0.5, 0, 0], axis: z, coordinate: p}",
        "table: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}",
    )
    .replace("loops:", "loops:\n  at_a: {type: point, between: [tip_a, foot_a]}")
    .replace("p: -0.7", f"x: {0.5 * math.cos(0.7)!r}, y: {0.5 * math.sin(0.7)!r}")
)
LIGHT = """model: light
joints:
  a: {type: spherical, coordinates: [a_0, a_1, a_2, a_3]}
  b: {type: revolute, parent: a, at: [0.3, 0, 0.1], axis: [1, 0, -1], coordinate: b_1}
  c: {type: revolute, parent: b, at: [0, 0.4, 0], axis: [0, 1, 1], coordinate: c_1}
  d: {type: spherical, parent: c, at: [0.5, 0, 0], coordinates: [d_0, d_1, d_2, d_3]}
bodies:
  a: {mass: 0.5, com: [0.2, 0, 0], inertia: {xx: 0.001, yy: 0.002, zz: 0.002}}
  b: {mass: 0.1, com: [0, 0.3, 0], inertia: {xx: 0.001, yy: 0.0002, zz: 0.001}}
  c: {mass: 0.3, com: [0.3, 0, 0], inertia: {xx: 0.0001, yy: 0.003, zz: 0.003}}
  d: {mass: 2000, com: [0.6, 0, 0], inertia: {xx: 0.04, yy: 0.05, zz: 0.06}}
points: {tip: {frame: d, at: [0.6, 0, 0]}, wall: {at: [1, 0.4, 0.1]}}
loops: {held: {type: distance, between: [tip, wall], length: 1.1}}
inputs: {u: {joint: b_1}, v: {joint: c_1}}
"""
# a hinge at a place of the world: rows along the axes of a frame beside rows of the model
HUNG = """model: hung
gravity: [0, 0, -9.81]
frames:
  wall: {translation: [0.4, 0.1, 0.2], rotation: [[y, 0.6]]}
joints:
  base: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}
  arm: {type: cylindrical, parent: base, at: [0, 0.2, 0], axis: [1, 0, 1], coordinates: [s, a]}
bodies:
  base: {mass: 3, inertia: {xx: 0.04, yy: 0.02, zz: 0.05}}
  arm: {mass: 0.5, com: [0, 0, 0.3], inertia: {xx: 0.02, yy: 0.01, zz: 0.02}}
loops: {hinge: {type: revolute, between: [arm, wall]}}
inputs: {u: {torque_on: base, direction: [0, 0, 1]}}
"""
# a hinge that is held on its own axis: a row that no motion changes, beside a quaternion
ALWAYS = """model: always
gravity: [0, 0, -9.81]
parameters: {l: {value: 0.7}}
joints:
  base: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}
  lid: {type: revolute, parent: base, at: [0, l, 0], axis: y, coordinate: a}
frames: {pin: {parent: lid, translation: [0, -0.7, 0]}}
bodies:
  base: {mass: 3, inertia: {xx: 0.04, yy: 0.02, zz: 0.05}}
  lid: {mass: 0.5, com: [0.2, 0, 0.3], inertia: {xx: 0.02, yy: 0.01, zz: 0.02}}
loops: {held: {type: spherical, between: [base, pin]}}
inputs: {u: {joint: a}}
"""
QUANTITIES = ("weighted_pseudoinverse", "weighted_nullspace_projector")


@cache
def table(text: str) -> Model:
    return load_text(text, "table.yaml")


@cache
def others(text: str) -> Alternatives:
    return Alternatives(table(text), genericity(System(table(text))), None)


@cache
def motions(text: str, name: str) -> Evaluator:
    """q_ddot and lambda by a method."""
    methods = Methods(table(text), genericity(System(table(text))))
    made = [methods.candidate(quantity, name) for quantity in MOTIONS]
    return Evaluator([x for candidate in made if isinstance(candidate, Candidate) for x in candidate.derived.outputs])


@cache
def expected(text: str) -> Expected:
    return Expected(table(text), MOTIONS, 8, lambda _: None)


def points(model: Model) -> list[dict[str, float]]:
    """States of the table on the constraint manifold."""
    source = random.Random(3)
    states = []
    for _ in range(3):
        turn, rate = source.uniform(0.3, 1.2), source.uniform(-2, 2)
        way = (0.5 * math.cos(turn), 0.5 * math.sin(turn))
        at = {"p": -turn, "x": way[0], "y": way[1], "z": 0.0, "e_0": 1.0, "e_1": 0.0, "e_2": 0.0, "e_3": 0.0}
        moving = {"p": -rate, "x": -way[1] * rate, "y": way[0] * rate}
        point = dict(parameter_values(System(model)))
        for c in model.coordinates:
            point |= {c.name: at.get(c.name, turn), c.rate: moving.get(c.name, 0.0 if c.name in at else rate)}
        states.append(point | {control.name: source.uniform(-1, 1) for control in model.inputs})
    return states


@pytest.mark.campaign
@pytest.mark.parametrize("method", ["articulated", "articulated_by_bodies"])
@pytest.mark.parametrize("text", [PLANE, SPACE], ids=["plane", "space"])
def test_rows_that_depend_on_each_other(text: str, method: str) -> None:
    """As along an orthonormal basis: the same accelerations, the same smallest multipliers."""
    generic = genericity(System(table(text)))
    assert generic.rank == generic.r - 1
    one, other = motions(text, method), motions(text, "nullspace")
    for point in points(table(text)):
        assert one(point) == pytest.approx(other(point), rel=1e-9, abs=1e-8)


@pytest.mark.campaign
@pytest.mark.parametrize("method", ["articulated", "articulated_by_bodies"])
@pytest.mark.parametrize("text", [HUNG, ALWAYS], ids=["hung", "always"])
def test_rows_of_loops_beside_quaternions(text: str, method: str) -> None:
    """As verification asks for, at its states."""
    for quantity in MOTIONS:
        made = others(text).named(quantity, method)
        assert made is not None
        program = schedule(made.mechanics, [made.derived], ("float64",))["float64"]
        assert measured(program.kernels[0], program.sincos, "float64", expected(text))[1] is None


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_weighted_projections_with_dependent_rows(quantity: str) -> None:
    one, other = others(PLANE).named(quantity, BY_FRAMES), others(PLANE).named(quantity, "householder")
    assert one is not None
    assert other is not None
    for point in points(table(PLANE)):
        entries, wanted = Evaluator(one.derived.outputs)(point), Evaluator(other.derived.outputs)(point)
        assert entries == pytest.approx(wanted, rel=1e-9, abs=1e-9)


@pytest.mark.campaign
def test_heavy_bodies_at_the_end_of_light_links() -> None:
    """A step of refinement gives back what articulated inertias lose by a thousand units, and dense methods by 1e5."""
    motion = "forward_dynamics"
    states = Expected(table(LIGHT), (motion, QUANTITIES[0]), 8, lambda _: None)

    def largest(quantity: str, name: str) -> float:
        made = others(LIGHT).named(quantity, name)
        assert made is not None
        program = schedule(made.mechanics, [made.derived], ("float64",))["float64"]
        return measured(program.kernels[0], program.sincos, "float64", states)[0].largest

    assert largest(motion, "articulated_by_bodies") < 8
    assert largest(motion, BY_FRAMES) > 100
    assert largest(QUANTITIES[0], BY_FRAMES) < 8


@pytest.mark.campaign
def test_what_was_rejected_under_its_title_is_not_tried_again_by_its_name() -> None:
    """Articulated inertias are a method of their own, and take as long to be rejected a second time."""
    choice = Choice(MOTIONS[0], "articulated inertias", (("articulated inertias", 2000),), "articulated")
    names = {one.choice.title for one in others(SPACE).of(MOTIONS[0], choice, 0)}
    assert names
    assert "articulated" not in names
