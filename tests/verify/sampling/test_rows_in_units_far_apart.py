"""Dependent rows and one in units of its own, drives on joints that cannot move: the reference keeps its digits."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import pytest
from flint import arb, arb_mat

from symgen.ir.kernel import Scalar
from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.linear import independent_rows, right_pseudoinverse
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.configurations.manifold import exceeds
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.states import rounded, sample_states
from symgen.verify.tolerance import expectations

# the shelf holds the tip of an arm, so that its joints stand still; the crank turns beside it
SHELF = """\
model: shelf_and_crank
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, d: {{unit: rad}}, e: {{unit: rad}}}}
kinetic_energy: 2*a_dot**2 + b_dot**2 + cos(a - b)*a_dot*b_dot/2 + c_dot**2/3 + d_dot**2/5 + e_dot**2/4
potential_energy: 7*sin(a) + 3*sin(b) + 5*sin(d)
constraints:
  geometric:
    tip_x: 0.7*cos(a) + 0.5*cos(b) - 0.9
    tip_y: 0.7*sin(a) + 0.5*sin(b) - 0.4
    both: 0.7*cos(a) + 0.5*cos(b) - 0.9 + 2*(0.7*sin(a) + 0.5*sin(b) - 0.4)
    ring_x: "{other}*(0.3*cos(c) + 1.1*cos(d) - 0.8*cos(e) - 0.9)"
    ring_y: "{unit}*(0.3*sin(c) + 1.1*sin(d) - 0.8*sin(e))"
inputs: {{shoulder: {{acts_on: {{a: 2}}}}, elbow: {{acts_on: {{b: 1, a: -1}}}}}}
"""


@pytest.mark.parametrize(("unit", "other"), [("1", "1"), ("1e6", "1"), ("1e-6", "1"), ("1e9", "1"), ("1e7", "1e-7")])
def test_states_are_found_where_all_driven_joints_are_held(unit: str, other: str) -> None:
    model = load_text(SHELF.format(unit=unit, other=other), "shelf.yaml")
    reference = Reference(model)
    assert (reference.ranks.constraints, reference.ranks.actuation) == (4, 0)
    samples = sample_states(reference, ("inverse_dynamics", "multipliers"), 16)
    assert len(samples) == 16
    shelf = {tuple(round(x, 9) for x in sample.state.q[:2]) for sample in samples}
    assert len(shelf) <= 2  # elbow up and down


@pytest.mark.parametrize("other", ["1", "1e-7"])
def test_a_row_counts_in_any_unit_beside_others(other: str) -> None:
    """Points of V have a greater rank than one less than the rank of V."""
    reference = Reference(load_text(SHELF.format(unit="1e7", other=other), "shelf.yaml"))
    assert reference.model.assembly is not None
    system, ranks = reference.system, reference.ranks
    with precision(128):
        q = [ball(x) for x in reference.model.assembly.places[0].q]
        lower = replace(ranks, constraints=3, geometric=3)
        assert not exceeds(system, ranks, q, [], reference.literals())
        assert exceeds(system, lower, q, [], reference.literals())


def test_sums_over_subsets_of_rows_say_when_they_have_no_digits_left() -> None:
    """Two rows that are one, and two of size 1e60."""
    rows = [[1, 2, 0, 0, 3], [2, 4, 0, 0, 6], [0, 10**60, 10**60, 0, 0], [0, 0, 3 * 10**60, 10**60, 1]]
    with precision(64), pytest.raises(ZeroDivisionError):
        right_pseudoinverse(arb_mat(rows), 3)
    with precision(1024):
        matrix = arb_mat(rows)
        product = matrix * right_pseudoinverse(matrix, 3) * matrix
        difference = [float(x - y) for x, y in zip(product.entries(), matrix.entries(), strict=True)]
    assert max(map(abs, difference)) < 1e-60


def test_rows_that_span_all_of_them() -> None:
    with precision(128):
        assert independent_rows(arb_mat([[1, 0, 2], [2, 0, 4], [0, 1, 0]])) == [1, 2]
        assert independent_rows(arb_mat([[0, 0], [1, 5]])) == [1]
        assert independent_rows(arb_mat([[1, 1], [1, 1 + 2**-80]])) is not None


def test_what_rounding_leaves_of_a_row_is_no_row_in_a_small_unit() -> None:
    """A slide that holds one joint still: of its other rows 1e-17 is left, of a gradient and of a value."""
    text = """\
model: slide_that_holds
parameters: {l: {value: 1.1, range: [0.77, 1.54]}}
gravity: [0, -9.81, 0]
joints:
  stand: {type: revolute, axis: [1, 2, 3], coordinate: a}
  lever: {type: revolute, parent: stand, at: [0, 0.64, 0], axis: x, coordinate: b}
  tip: {type: revolute, parent: lever, at: [l, -0.32, 0], axis: x, coordinate: c}
frames:
  dock:
    parent: tip
    translation: [-1.1000000000000003, 0.1248485389786337, 0.29464019127556335]
    rotation: [[[1.0, -6.782514753583869e-17, 0.0], 1.1699999999999997]]
bodies:
  stand: {mass: 2, com: [0, 0.3, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.2}}
  lever: {mass: 1, com: [0.5, 0, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.2}}
  tip: {mass: 1, com: [0.2, 0, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.2}}
loops: {slide: {type: prismatic, between: [lever, dock]}}
inputs: {turn: {joint: b}}
configuration: {c: -1.17}
"""
    reference = Reference(load_text(text, "slide.yaml"))
    assert (reference.ranks.constraints, reference.ranks.actuation) == (1, 1)
    assert len(sample_states(reference, ("inverse_dynamics",), 12)) == 12


# of two rows that say the same one is in other units, and a third says nothing at all
TWICE = """\
model: twice_in_other_units
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, w: {{}}}}
kinetic_energy: 2*a_dot**2 + b_dot**2 + cos(a - b)*a_dot*b_dot/2 + c_dot**2/3 + w_dot**2/7
constraints:
  geometric:
    level: 0.6*sin(a) + 0.8*sin(b) + 0.3*sin(c) - 0.9
    reach: "1e-3*(0.6*cos(a) + 0.8*cos(b) + 0.3*cos(c) - w)"
    again: "{unit}*(0.6*sin(a) + 0.8*sin(b) + 0.3*sin(c) - 0.9)"
inputs: {{shoulder: {{acts_on: {{a: 1}}}}}}
configuration: {{a: 0.3, b: 0.9, c: 0.4, w: 1.3}}
"""


@pytest.mark.parametrize("scalar", ["float32", "float64"])
@pytest.mark.parametrize("unit", ["1e7", "1e-7", "3e11"])
def test_a_step_towards_closed_loops_is_known_at_states_that_are_rounded(unit: str, scalar: Scalar) -> None:
    """Sums over subsets of rows that belong to a second Newton step start from what the first leaves open."""
    reference = Reference(load_text(TWICE.format(unit=unit), "twice.yaml"))
    assert reference.ranks.geometric == 2
    wanted = ("projected_configuration", "nullspace_projector")
    for index, sample in enumerate(sample_states(reference, wanted, 8)):
        state = rounded(sample, scalar).state
        made = expectations(reference, state, wanted, scalar, f"{index}")
        moved = max(abs(float(x) - y) for x, y in zip(made[wanted[0]].value.entries(), state.q, strict=True))
        assert moved < 0.02
        assert 0 < made[wanted[0]].unit < 1e-4


def test_a_rank_that_drops_is_told_with_a_remedy() -> None:
    reference = Reference(load_text(TWICE.format(unit="1e7"), "twice.yaml"))
    upright = State((0.5 * pi,) * 3 + (0.0,), (0.0,) * 4, (0.0,) * 4, (0.0,), ())
    singular = replace(upright, q=(arb.pi() / 2,) * 3 + (arb(0),))
    assert reference.matrices(upright, ["nullspace_projector"])  # the rounding of pi/2 is told from nothing
    with pytest.raises(ReferenceValueError, match="a rank drops at this state; give"):
        reference.matrices(singular, ["nullspace_projector"])
