"""Rates that turn no null space leave nothing behind in N_B_dot, not even rounding."""

from __future__ import annotations

import random

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.coordinates.idle_coordinates import idle_coordinates
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# A rail is held level by two angles together, and a carriage on it at a height: its place on the rail does not matter.
RAIL = """\
model: rail
coordinates:
  a: {description: slope of the rail's post}
  b: {description: slope of the rail on its post}
  s: {description: place of the carriage on the rail}
  z: {description: what nothing holds}
kinetic_energy: a_dot**2 + b_dot**2 + s_dot**2 + z_dot**2
definitions: {slope: sin(a) + 0.3*sin(b)}
constraints:
  geometric:
    level: slope*WAY
    height: cos(a) - 0.4*cos(b) + s*slope - 0.6386
configuration: {a: 0.144, b: -0.5, s: 0.4, z: 0}
outputs: [nullspace_projector_dot]
"""
CRANK = """\
model: crank
coordinates: {a: {}, b: {}, s: {}}
kinetic_energy: a_dot**2 + b_dot**2 + s_dot**2
constraints:
  geometric:
    along: cos(a) + 2*cos(b) - s
    across: sin(a) - 2*sin(b)
configuration: {a: 0.4, b: 0.196, s: 2.88}
outputs: [nullspace_projector_dot]
"""


def idle(text: str) -> set[str]:
    mechanics = System(load_text(text, "model.yaml"))
    return {mechanics.model.coordinates[j].name for j in idle_coordinates(mechanics, genericity(mechanics))}


# a root of 2 has no place among the residues
@pytest.mark.parametrize("way", ["1", "sqrt(2)", "(sqrt(2) + sqrt(3)*slope)"])
def test_places_on_what_is_held_do_not_count(way: str) -> None:
    assert idle(RAIL.replace("WAY", way)) == {"s"}


@pytest.mark.parametrize("way", ["(1 + s/3)", "(sqrt(2) + sqrt(3)*s)"])
def test_places_count_off_the_constraints_where_they_do_there(way: str) -> None:
    assert idle(RAIL.replace("WAY", way)) == set()


def test_what_turns_the_null_space_counts() -> None:
    assert idle(CRANK) == set()


def test_idle_rates_leave_nothing() -> None:
    model = load_text(RAIL.replace("WAY", "1"), "rail.yaml")
    (derived,) = derive_quantities(model, ("nullspace_projector_dot",)).quantities
    evaluate = Evaluator(list(derived.outputs))
    for seed in range(20):
        dice = random.Random(seed)
        point = {name: dice.uniform(-0.5, 0.5) for name in ("a", "b", "s", "z", "a_dot", "b_dot", "s_dot", "z_dot")}
        assert any(evaluate(point))
        assert not any(evaluate(point | {"a_dot": 0.0, "b_dot": 0.0}))
