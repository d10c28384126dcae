"""The reference where constraint rows depend on each other: overconstrained linkages, in the plane and in space."""

from __future__ import annotations

import random
from itertools import combinations
from math import atan, pi, sin, tan

import pytest
from flint import arb, arb_mat
from linkages import cranks_on_one_coupler

from symgen.closedform.mechanics import ExactSystem, make_translator
from symgen.closedform.points import generic_points
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.linear import determinant, norm, right_pseudoinverse, rows_of, solve
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import closed
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states

LEVERS = """\
model: levers_that_hold_one_knob
coordinates: {x: {}, y: {}, a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
kinetic_energy: (x_dot**2 + y_dot**2)/2 + (a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2)/10
constraints:
  geometric:
    x_a: x - 2*cos(a)
    y_a: y - 2*sin(a)
    x_b: 1e3*(x - 2*cos(b))
    y_b: y - 2*sin(b)
    x_c: x - 2*cos(c)
    y_c: y - 2*sin(c)
    x_d: x - 2*cos(d)
    y_d: 1e-3*(y - 2*sin(d))
inputs: {push: {acts_on: {a: 1}}}
"""
TWIST, OTHER, SHORT = 0.7, 1.3, 0.4
FIRST = 1.1
SECOND = 2 * atan(sin((OTHER + TWIST) / 2) / sin((OTHER - TWIST) / 2) / tan(FIRST / 2))


def bennett(long: str) -> str:
    """A ring of four skew axes, which moves for lengths in the ratio of the sines of its twists only."""
    return f"""\
model: skew_ring
parameters: {{l: {{value: {SHORT}, unit: m}}, k: {{value: {long}, unit: m}}}}
gravity: [0, 0, -9.81]
frames:
  one: {{rotation: [[z, q_1]]}}
  two: {{parent: one, translation: [l, 0, 0], rotation: [[x, {TWIST}], [z, q_2]]}}
  three: {{parent: two, translation: [k, 0, 0], rotation: [[x, {OTHER}], [z, q_3]]}}
  four: {{parent: three, translation: [l, 0, 0], rotation: [[x, {TWIST}], [z, q_4]]}}
  last: {{parent: four, translation: [k, 0, 0], rotation: [[x, {OTHER}]]}}
coordinates: {{q_1: {{unit: rad}}, q_2: {{unit: rad}}, q_3: {{unit: rad}}, q_4: {{unit: rad}}}}
bodies: {{one: {{mass: 1, com: [l/2, 0, 0]}}, two: {{mass: 1, com: [k/2, 0, 0]}}}}
loops: {{ring: {{type: fixed, between: [last, world]}}}}
inputs: {{crank: {{unit: N*m, joint: q_1}}}}
configuration: {{q_1: {FIRST}, q_2: {SECOND}, q_3: {-FIRST}, q_4: {-SECOND}}}
"""


def test_levers_that_hold_one_knob_have_the_rank_of_one_turn() -> None:
    reference = Reference(load_text(LEVERS, "levers.yaml"))
    assert (reference.ranks.constraints, reference.ranks.geometric, reference.ranks.actuation) == (5, 5, 1)
    for sample in sample_states(reference, ["inverse_dynamics"], 8):
        angles = sample.state.q[2:]
        turns = [(angle - angles[0]) / pi for angle in angles]
        assert all(abs(turn - round(turn)) < 1e-12 and round(turn) % 2 == 0 for turn in turns)
        # half the mass of a turn: 4 for the knob at radius 2, 0.2 for each lever
        (u,) = reference.evaluate(sample.state, ["inverse_dynamics"])["inverse_dynamics"]
        if sample.admissible:
            assert float(u) == pytest.approx((4 + 4 * 0.2) * sample.state.qdd[2], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("long", [f"l*sin({OTHER})/sin({TWIST})", repr(SHORT * sin(OTHER) / sin(TWIST))])
def test_a_ring_of_skew_axes_moves_for_exact_and_for_rounded_lengths(long: str) -> None:
    reference = Reference(load_text(bennett(long), "ring.yaml"))
    assert reference.ranks.constraints == 3
    assert reference.ranks.actuation == 1
    samples = sample_states(reference, ["inverse_dynamics"], 8)
    assert len(samples) == 8
    for sample in samples:
        residual = reference.matrices(sample.state, ["constraint_residual"])["constraint_residual"]
        assert norm(residual) < 1e-14


def test_the_mean_over_subsets_of_rows_is_found_without_them() -> None:
    source = random.Random(3)
    with precision(256):
        factors = [arb_mat(a, b, [source.uniform(-1, 1) for _ in range(a * b)]) for a, b in ((6, 3), (3, 5))]
        noise = arb_mat(6, 5, [source.uniform(-1e-9, 1e-9) for _ in range(30)])
        matrix = factors[0] * factors[1] + noise
        total, mean = arb(0), arb_mat(5, 6)
        for subset in combinations(range(6), 3):
            part = rows_of(matrix, subset)
            gram = part * part.transpose()
            weight = determinant(gram)
            total += weight
            entries = [[arb(0)] * 6 for _ in range(5)]
            for i, row in enumerate((solve(gram, part).transpose() * weight).tolist()):
                for j, entry in zip(subset, row, strict=True):
                    entries[i][j] = entry
            mean += arb_mat(5, 6, [entry for row in entries for entry in row])
        assert norm(right_pseudoinverse(matrix, 3) - mean * (1 / total)) < 1e-40


GUIDES = """\
model: drawer_on_two_rails
joints: {drawer: {type: planar, coordinates: [x, y, tilt]}}
bodies: {drawer: {mass: 4, com: [0.1, 0, 0], inertia: {zz: 0.3}}}
gravity: [0, -9.81, 0]
frames:
  left: {parent: drawer, translation: [0.1, 0.2, 0]}
  right: {parent: drawer, translation: [0.1, -0.2, 0]}
  left_rail: {translation: [0, 0.2, 0]}
  right_rail: {translation: [0, -0.2, 0]}
loops:
  one: {type: prismatic, axis: x, between: [left, left_rail]}
  two: {type: prismatic, axis: x, between: [right, right_rail]}
inputs: {pull: {unit: N, joint: x}}
configuration: {tilt: 0.01}
"""


def test_what_a_search_leaves_of_coordinates_and_rates_that_are_held_is_nothing() -> None:
    reference = Reference(load_text(GUIDES, "drawer.yaml"))
    assert reference.ranks.constraints == 2
    for sample in sample_states(reference, ["forward_dynamics"], 8):
        _, y, tilt = sample.state.q
        assert y == tilt == 0
        if sample.admissible:
            assert sample.state.qd[1:] == sample.state.qdd[1:] == (0, 0)


@pytest.mark.parametrize("count", [5, 6])
def test_loops_close_to_all_digits_however_many_rows_depend_on_others(count: int) -> None:
    """The bounds of a step held no digit of it, and loops of exact lengths closed up to rounding only."""
    model = load_text(cranks_on_one_coupler(count), "cranks.yaml")
    reference = Reference(model)
    assert model.assembly is not None
    standing = [place.q for place in model.assembly.places if abs(sin(place.q[0])) > 0.2]
    assert len(standing) > 8
    with precision(128):
        for place in standing:
            start = [x + 1e-3 * (j + 1) for j, x in enumerate(place)]
            q, still_open = closed(reference.system, start, default_parameters(model), reference.literals(), 1e-35)
            assert not still_open
            assert all(abs(x - q[0]) < 1e-30 for x in q[:count])


def table_on_posts(count: int) -> str:
    """Equal posts a0, a1, ... that turn about the floor and carry one board, which turns by b on the first."""
    posts = range(count)
    others = posts[1:]
    return "\n".join(
        [
            "model: table_on_posts",
            "parameters: {w: 0.3}",
            "gravity: [0, -9.81, 0]",
            "joints:",
            *(f"  p{k}: {{type: revolute, axis: z, at: [{k}*w, 0, 0], coordinate: a{k}}}" for k in posts),
            "  board: {type: revolute, axis: z, parent: p0, at: [0.7, 0, 0], coordinate: b}",
            "bodies:",
            "  board: {mass: 2, com: [w, 0.05, 0], inertia: {zz: 0.08}}",
            "points:",
            *(f"  top{k}: {{frame: p{k}, at: [0.7, 0, 0]}}" for k in others),
            *(f"  pin{k}: {{frame: board, at: [{k}*w, 0, 0]}}" for k in others),
            "loops:",
            *(f"  loop{k}: {{type: point, between: [pin{k}, top{k}]}}" for k in others),
            "inputs: {drive: {joint: a0}}",
        ]
    )


def test_exact_lengths_are_no_rounded_ones_however_many_rows_depend_on_others() -> None:
    model = load_text(table_on_posts(5), "table.yaml")
    assert not Reference(model).ranks.rounded
    written = energy_form(model)
    assert len(generic_points(written, ExactSystem(written, make_translator(written, ())), 3)) == 3


def test_what_rounded_axes_leave_of_a_direction_is_none() -> None:
    """A body that slides along x in a frame turned by 120 degrees: its axis is 1e-16 off, and y does not move."""
    turn = f"[[{', '.join(['0.5773502691896258'] * 3)}], 2.0943951023931957]"
    text = f"""\
model: slide
frames:
  dock: {{translation: [-0.6, 0.22, -0.55], rotation: [[{turn[1:-1]}]]}}
joints:
  base: {{type: floating, coordinates: [x, y, z, e0, e1, e2, e3]}}
bodies:
  base: {{mass: 6.2, inertia: {{xx: 0.004, yy: 0.003, zz: 0.003}}}}
loops:
  guide: {{type: cylindrical, between: [base, dock]}}
inputs:
  across: {{acts_on: {{y: 1}}}}
  along: {{acts_on: {{x: 1}}}}
configuration: {{x: -0.6, y: 0.22, z: -0.55, e0: 0.5, e1: 0.5, e2: 0.5, e3: 0.5}}
"""
    reference = Reference(load_text(text, "slide.yaml"))
    assert reference.ranks.actuation == 1
