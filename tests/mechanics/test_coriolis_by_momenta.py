"""C from what momenta change by is C from Christoffel symbols, and is taken where it counts less."""

from __future__ import annotations

import pytest

from symgen.mechanics.christoffel import by_christoffel_symbols
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.matrix import Vector, flatten
from symgen.symbolic.traverse import cost

# Two balls in sockets, then a pin whose axis is along no frame's.
BALLS = """
model: two_balls
parameters: {g: {value: 9.81}, l: {value: 0.6}, m: {value: 2}, k: {value: 0.5}}
gravity: [0, g, 0]
joints:
  first: {type: spherical, coordinates: [e0, e1, e2, e3]}
  second: {type: spherical, parent: first, at: [0, 0, l], coordinates: [f0, f1, f2, f3]}
  third: {type: revolute, parent: second, at: [0, 0.3, 0], axis: [1, 0, -1], coordinate: a}
bodies:
  first: {mass: m, com: [0, 0, l/2], inertia: {xx: 0.06, yy: 0.08, zz: 0.05}}
  third: {mass: k, com: [0.1, 0, 0.2], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
inputs:
  u: {acts_on: {a: 1}}
configuration: {e0: 0.8, e1: 0.6, f0: 0.5, f1: 0.5, f2: 0.5, f3: 0.5}
"""
# In one plane most slopes of G vanish or are alike.
PLANE = """
model: two_arms
parameters: {l: {value: 0.6}, m: {value: 2}, k: {value: 0.5}}
coordinates: {a: {unit: rad}, b: {unit: rad}}
kinetic_energy: m*l**2*(a_dot**2 + a_dot*b_dot*cos(a - b) + k*b_dot**2)
inputs:
  u: {acts_on: {a: 1}}
"""


def system_of(text: str) -> System:
    return System(load_text(text, "model.yaml"))


def by_symbols(system: System, velocity: Vector) -> Vector:
    return flatten(by_christoffel_symbols(system.graph, system.mass_matrix_gradient, velocity))


@pytest.mark.parametrize("text", [BALLS, PLANE], ids=["balls", "plane"])
def test_both_are_the_same_function(text: str) -> None:
    """In the field of fingerprints, along the rates and along another velocity."""
    system = system_of(text)
    other = tuple(2 * rate + q for q, rate in zip(system.q, system.qd, strict=True))
    for velocity in (system.qd, other):
        made = flatten(system.coriolis_matrix(velocity))
        assert [x.value for x in made] == [x.value for x in by_symbols(system, velocity)]


def test_what_moves_together_takes_momenta() -> None:
    """Half of what the symbols count, and no more than these in the plane."""
    balls = system_of(BALLS)
    made, symbols = balls.coriolis_matrix(balls.qd), by_symbols(balls.apart(), balls.qd)
    assert cost(flatten(made)).weight < 0.6 * cost(symbols).weight


def test_what_is_short_by_symbols_stays() -> None:
    """The scalars of the plane's C are those that the symbols have on a graph of their own."""
    plane = system_of(PLANE)
    made = flatten(plane.coriolis_matrix(plane.qd))
    apart = plane.apart()
    assert [repr(x) for x in made] == [repr(x) for x in by_symbols(apart, apart.qd)]
