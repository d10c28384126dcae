"""Generic ranks where lengths of very different sizes meet, and where points lie beside a singular configuration."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symgen.mechanics.genericity import at_configurations, genericity, rank
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities

TINY = """
model: tiny
coordinates: {{x: {{}}, a: {{}}, b: {{}}}}
parameters: {{l: {length}}}
kinetic_energy: x_dot**2 + a_dot**2 + b_dot**2
constraints: {{geometric: {{first: x - l*sin(a), second: x - l*cos(b)}}}}
inputs: {{push: {{acts_on: {{x: 1}}}}}}
"""
# Three parallel cranks on one coupler.  All of it in line is a singular configuration to which Newton's method likes to
# converge, slowly: the point it stops at is 1e-6 off V.
PARALLELOGRAM = """
model: parallelogram
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
parameters: {l: 0.3, w: 0.8, k: 1}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2
potential_energy: k*(sin(a) + sin(b) + sin(c))
constraints:
  geometric:
    right_x: l*cos(a) + w*cos(d) - w - l*cos(b)
    right_y: l*sin(a) + w*sin(d) - l*sin(b)
    middle_x: l*cos(a) + w/2*cos(d) - w/2 - l*cos(c)
    middle_y: l*sin(a) + w/2*sin(d) - l*sin(c)
inputs: {T: {acts_on: {a: 1}}}
independent_velocities: [a]
configuration: {a: 1, b: 1, c: 1, d: 0}
"""


def test_a_point_beside_a_singular_configuration_does_not_raise_the_rank() -> None:
    generic = genericity(System(load_text(PARALLELOGRAM, "parallelogram.yaml")))
    assert (generic.rank, generic.geometric_rank, generic.delta, generic.alpha) == (3, 3, 1, 1)


def test_minors_of_dependent_rows_are_not_multiplied_out() -> None:
    derivations = derive_quantities(load_text(PARALLELOGRAM, "parallelogram.yaml"), ["minimal_potential_force"])
    assert [choice.title for choice in derivations.choices] == ["minors"]


@pytest.mark.parametrize("length", ["1", "1e-3", "1e-6"])
def test_ranks_do_not_depend_on_the_size_of_a_mechanism(length: str) -> None:
    generic = genericity(System(load_text(TINY.format(length=length), "tiny.yaml")))
    assert (generic.rank, generic.geometric_rank, generic.delta, generic.alpha) == (2, 2, 1, 1)


def test_a_rank_is_given_only_where_it_is_clear() -> None:
    assert rank([[1.0, 0.0], [1.0, 1e-3]]) == 2
    assert rank([[1.0, 0.0], [1.0, 1e-12]]) == 1
    assert rank([[1.0, 0.0], [1.0, 1e-7]]) is None
    assert rank([[1.0, 0.0], [1.0, 1e-7]], plain=1e-9) == 2
    assert rank([[0.0, 0.0]]) == 0
    assert rank([[float("nan"), 0.0]]) is None
    assert rank([]) == 0


def test_rows_may_be_others_than_those_of_the_file() -> None:
    model = load_text(TINY.format(length="1"), "tiny.yaml")
    first, second = model.constraints
    for rows in ((first,), (first, second, replace(first, name="again"))):
        mechanics = System(replace(model, constraints=rows))
        places = at_configurations(mechanics, mechanics.constraint_jacobian)
        assert {len(at) for at in places} == {len(rows)}
        assert {rank(at) for at in places} == {min(2, len(rows))}


def test_a_row_that_vanishes_on_v_locks_nothing() -> None:
    # what is left of its gradient is a rounding, as long as itself; another row holds b, and touches a as well
    vanishing, slope = "0.25*cos(b) + sin(b) - sqrt(1.0625)", "(0.25*sin(b) - cos(b))"
    text = TINY.replace("second: x - l*cos(b)", f"second: {vanishing}, third: {slope}*(2 + cos(a))")
    generic = genericity(System(load_text(text.format(length="1"), "tiny.yaml")))
    assert (generic.rank, generic.locked) == (2, ())
    alone = text.replace("*(2 + cos(a))", "")
    assert genericity(System(load_text(alone.format(length="1"), "tiny.yaml"))).locked == (2,)
