"""Systems with what the shipped models have not, every quantity against the 50-digit reference."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
import special_texts as texts
from laws_harness import System, system

from symgen.ir.kernel import Scalar, Status
from symgen.mechanics.structure import analyse
from symgen.verify.reference.reference import State
from symgen.verify.sampling.states import rounded, sample_states

SMALL = {
    "rank_one": texts.RANK_ONE,
    "massless": texts.MASSLESS,
    "bare": texts.BARE,
    "one_coordinate": texts.ONE_COORDINATE,
    "only_nonholonomic": texts.ONLY_NONHOLONOMIC,
    "only_geometric": texts.ONLY_GEOMETRIC,
    "three_freedoms": texts.THREE_FREEDOMS,
    "mixed": texts.MIXED,
    "inclined_skate": texts.INCLINED_SKATE,
    "arm_on_circle": texts.ARM_ON_CIRCLE,
    "equal_links": texts.EQUAL_LINKS,
}
CORE = ("inverse_dynamics", "inverse_dynamics_residual", "forward_dynamics", "multipliers", "nullspace_projector")


@pytest.mark.parametrize("name", SMALL)
def test_every_quantity_is_right(name: str) -> None:
    given = system(SMALL[name])
    sample = sample_states(given.reference, given.names, 8)
    for scalar in ("float64", "float32"):
        given.assert_right(rounded(sample[1], scalar).state, scalar=scalar)


def test_redundantly_underactuated_inputs_share_the_load() -> None:
    given = system(texts.RANK_ONE)
    generic = given.derivations.generic
    assert (generic.delta, generic.m, generic.alpha) == (3, 2, 1)
    assert analyse(given.derivations.mechanics, generic).actuation == "redundantly under-actuated"
    state = given.state([0.1, 0.2, 0.3])
    (left,), (right,) = given.matrix("inverse_dynamics", state)
    # the least norm: twice the effect, twice the share
    assert right == pytest.approx(2 * left, rel=1e-14)
    residual = [row[0] for row in given.matrix("inverse_dynamics_residual", state)]
    column = [row[0] for row in given.matrix("control_matrix", state)]
    assert abs(sum(a * b for a, b in zip(residual, column, strict=True))) < 1e-12
    assert max(map(abs, residual)) > 0.1


def _cranks_at(given: System, angle: float, scalar: Scalar) -> State:
    return given.state([angle] * 3 + [0.5 * cos(angle), 0.5 * sin(angle), 0.0], scalar=scalar)


@pytest.mark.parametrize("angle", [0.8, 1.3, pi / 2 - 1e-3, pi / 2 - 1e-9, pi / 2, pi / 2 + 1e-6, 2.2])
def test_parallel_cranks_turn_through_ninety_degrees(angle: float) -> None:
    given = system(texts.CRANKS, CORE)
    for scalar in ("float64", "float32"):
        given.assert_right(_cranks_at(given, angle, scalar), scalar=scalar)


def test_parallel_cranks_are_known_to_depend_on_each_other() -> None:
    given = system(texts.CRANKS, CORE)
    generic = given.derivations.generic
    assert (generic.r, generic.rank, generic.delta) == (6, 5, 1)
    structure = analyse(given.derivations.mechanics, generic)
    # away from 90 degrees each row is a combination of others: any one may be named, none is dropped
    assert set(structure.dependent_rows) == {"a_x", "a_y", "b_x", "b_y", "c_x", "c_y"}
    assert structure.actuation == "redundantly full-actuated"


def test_parallel_cranks_in_a_line_are_singular() -> None:
    given = system(texts.CRANKS, CORE)
    for name in CORE:
        if name != "inverse_dynamics_residual":  # fully actuated: constant
            status, _ = given.run(name, _cranks_at(given, 0.0, "float64"))
            assert status is Status.CONSTRAINT_RANK, name


def test_zero_sizes_have_the_quantities_that_exist() -> None:
    bare = system(texts.BARE)
    assert "inverse_dynamics" not in bare.names
    assert "multipliers" not in bare.names
    assert bare.matrix("nullspace_projector", bare.state([0.3])) == [[1.0]]
    assert bare.matrix("singularity", bare.state([0.3])) == [[1.0], [1.0]]
    assert "constraint_residual" not in system(texts.ONLY_NONHOLONOMIC).names


@pytest.mark.parametrize(("bars", "ways"), [(3, {"minors", "householder"}), (6, {"householder"})])
def test_many_rows_take_the_way_of_reflections(bars: int, ways: set[str]) -> None:
    outputs = ("inverse_dynamics", "forward_dynamics", "multipliers", "singularity", "nullspace_projector")
    given = system(texts.chain(bars), outputs)
    others = [choice for choice in given.derivations.choices if choice.quantity != "inverse_dynamics"]
    tried = {title for choice in others for title, _ in choice.costs}
    assert tried - {"factored"} == ways
    assert given.derivations.generic.delta == bars
    q = [0.45 * (i + 1) - 0.02 * i * i for i in range(bars)] + [-0.2 * (i + 1) + 0.03 * i * i for i in range(bars)]
    uneven = [((7 * i) % 11 - 5) / 5 for i in range(2 * bars)]
    for scalar in ("float64", "float32"):
        given.assert_right(given.state(q, uneven, uneven[::-1], [1.5, -0.5], scalar=scalar), scalar=scalar)
