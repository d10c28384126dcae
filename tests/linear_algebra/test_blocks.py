"""Blocks of B that share no coordinate are projected one by one: fewer operations, the same values and statuses."""

from __future__ import annotations

import pytest
from laws_harness import System

from symgen.ir.kernel import Status
from symgen.linear_algebra.blocks import components
from symgen.methods.derivation import Derivation
from symgen.methods.quantity import scalars
from symgen.methods.spaces import along_blocks, along_minors
from symgen.quantities.catalogue import BY_NAME, by_blocks, derive
from symgen.symbolic.traverse import cost
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

# Two skates, a pendulum whose length is held, a coordinate that is locked, one that nothing touches.
TWO_SKATES = """\
model: two_skates
coordinates:
  {x: {range: [-1, 1]}, a: {range: [-1, 1]}, u: {}, y: {}, v: {}, b: {}, p: {range: [0.5, 1]}, q: {range: [0.5, 1]},
   k: {}, free: {}}
parameters: {m: {value: 2, range: [1, 3]}, l: {value: 1, range: [0.9, 1.1]}}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2 + u_dot**2 + v_dot**2 + a_dot**2 + b_dot**2 + p_dot**2 + q_dot**2 + k_dot**2 + free_dot**2)
  + m/4*(a_dot*b_dot + p_dot*free_dot)*cos(x)
constraints:
  geometric: {rod: p**2 + q**2 - l**2, lock: k - l/2}
  nonholonomic:
    one: sin(a)*x_dot - cos(a)*y_dot
    two: sin(b)*u_dot - cos(b)*v_dot + l*b_dot
inputs: {f: {acts_on: {x: cos(a), y: sin(a)}}}
"""
NAMES = tuple(name for name, entry in BY_NAME.items() if by_blocks(entry))


@pytest.fixture(scope="module")
def skates() -> System:
    return System(TWO_SKATES, NAMES)


def test_the_components(skates: System) -> None:
    names = [c.name for c in skates.model.coordinates]
    parts = [[names[j] for j in part.columns] for part in components(skates.derivations.mechanics.constraint_jacobian)]
    assert parts == [["p", "q"], ["k"], ["x", "y"], ["u", "v", "b"]]


def test_values_are_those_of_the_reference(skates: System) -> None:
    assert {"nullspace_projector", "constraint_pseudoinverse", "admissible_acceleration"} <= set(skates.names)
    for sample in sample_states(skates.reference, skates.names, 8):
        expected = expectations(skates.reference, sample.state, skates.names, "float64", "blocks")
        for name in skates.names:
            status, entries = skates.run(name, sample.state)
            assert status is Status.OK, name
            assert expected[name].in_units(expected[name].distance(entries)) <= FACTOR, name


def test_blocks_are_chosen_and_cost_less(skates: System) -> None:
    chosen = {choice.quantity: choice for choice in skates.derivations.choices}
    for name in ("constraint_pseudoinverse", "nullspace_projector_dot", "admissible_acceleration"):
        costs = dict(chosen[name].costs)
        assert costs["blocks"] < min(cost for title, cost in costs.items() if title not in ("blocks", "factored"))


def test_along_blocks_alone() -> None:
    """A graph of its own, so that equal functions of another way do not stand in for these."""
    alone, together = (System(TWO_SKATES, ()).derivations for _ in range(2))
    ways = [along(one.mechanics, one.generic) for along, one in ((along_blocks, alone), (along_minors, together))]
    entry = BY_NAME["constraint_pseudoinverse"]
    first, second = (cost(scalars(derive(entry, way))).weight for way in ways if isinstance(way, Derivation))
    assert 5 * first < 3 * second


def test_a_drop_of_rank_in_one_block_is_named(skates: System) -> None:
    q = [0.3, 0.2, 0.1, 0.4, 0.2, 0.3, 0.0, 0.0, 0.5, 0.1]
    status, _ = skates.run("nullspace_projector", skates.state(q))
    assert status is Status.CONSTRAINT_RANK
    q[6] = 1.0
    assert skates.run("nullspace_projector", skates.state(q))[0] is Status.OK


def test_one_block_has_no_such_way() -> None:
    made = System(TWO_SKATES.replace("two: sin(b)*u_dot", "two: x_dot + p_dot + k_dot + sin(b)*u_dot"), ())
    assert along_blocks(made.derivations.mechanics, made.derivations.generic) == "B has one block"
