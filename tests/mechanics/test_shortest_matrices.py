"""G and C by composite bodies, by momenta and by Christoffel symbols are the same functions; the shortest is taken."""

from __future__ import annotations

import pytest

from symgen.mechanics.christoffel import by_christoffel_symbols, by_momenta
from symgen.mechanics.rigid_bodies.composite_bodies import composite_matrices
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator, inner_point
from symgen.symbolic.matrix import Matrix, Vector, flatten
from symgen.symbolic.traverse import cost, reached

# Rounding of numbers about 1, by some thousand operations.
CLOSE = 1e-12
PARAMETERS = "parameters: {g: {value: 9.81}, l: {value: 0.6}, m: {value: 2}, k: {value: 0.5}, J: {value: 0.01}}"
# Two balls in sockets, then a pin whose axis is along no frame's.
BALLS = f"""
model: two_balls
{PARAMETERS}
gravity: [0, g, 0]
joints:
  first: {{type: spherical, coordinates: [e0, e1, e2, e3]}}
  second: {{type: spherical, parent: first, at: [0, 0, l], coordinates: [f0, f1, f2, f3]}}
  third: {{type: revolute, parent: second, at: [0, 0.3, 0], axis: [1, 0, -1], coordinate: a}}
bodies:
  first: {{mass: m, com: [0, 0, l/2], inertia: {{xx: 0.06, yy: 0.08, zz: 0.05}}}}
  third: {{mass: k, com: [0.1, 0, 0.2], inertia: {{xx: 0.02, yy: 0.03, zz: 0.04, yz: 0.001}}}}
inputs:
  u: {{acts_on: {{a: 1}}}}
configuration: {{e0: 0.8, e1: 0.6, f0: 0.5, f1: 0.5, f2: 0.5, f3: 0.5}}
"""
# What turns and slides about tilted axes, a branch, a rotor, and a coordinate that moves two frames of one line.
TREE = f"""
model: tree
{PARAMETERS}
gravity: [0, g, 0]
coordinates: {{a: {{unit: rad}}, s: {{unit: m}}, c: {{unit: rad}}, d: {{unit: rad}}, z: {{unit: m}}}}
frames:
  base: {{rotation: [[[1, 1, 0], a]]}}
  slide: {{parent: base, translation: [s, 0.1, l + s/2], rotation: [[y, 0.3]]}}
  wrist: {{parent: slide, translation: [0, 0.3, 0], rotation: [[[1, 2, 3], c], [x, d]]}}
  geared: {{parent: wrist, translation: [0, l, 0.1], rotation: [[z, 2*a]]}}
  branch: {{parent: base, translation: [l, 0, z], rotation: [[z, d]]}}
bodies:
  base: {{mass: m, com: [0, 0, l/2], inertia: {{xx: 0.06, yy: 0.08, zz: 0.05, xy: 0.001}}}}
  slide: {{mass: k, com: [0.1, 0, l/2], inertia: {{xx: 0.06, yy: 0.08, zz: 0.05}}}}
  geared: {{mass: k, com: [0.1, 0.05, 0.2], inertia: {{xx: 0.02, yy: 0.03, zz: 0.04}}}}
  branch: {{mass: m, com: [0, 0.1, 0]}}
rotor_inertias: {{c: J}}
inputs:
  u: {{acts_on: {{a: 1}}}}
"""
# A wheel is the same however far it has turned.
WHEEL = f"""
model: wheel
{PARAMETERS}
coordinates: {{a: {{unit: rad}}, tilt: {{unit: rad}}, wheel_angle: {{unit: rad}}}}
frames:
  column: {{rotation: [[z, a]]}}
  fork: {{parent: column, translation: [l, 0, 0], rotation: [[x, tilt]]}}
  wheel: {{parent: fork, translation: [0, 0.1, 0], rotation: [[y, wheel_angle]]}}
bodies:
  column: {{mass: m, com: [l/2, 0, 0], inertia: {{xx: 0.01, yy: 0.02, zz: 0.03}}}}
  wheel: {{mass: k, com: [0, 0.05, 0], inertia: {{xx: J, yy: 0.03, zz: J}}}}
inputs:
  u: {{acts_on: {{a: 1}}}}
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


def chain(links: int) -> str:
    """Links in the plane, each turned against the one before."""
    joints = "".join(
        f"  link_{k}: {{type: revolute, axis: z, coordinate: q_{k}"
        + (f", parent: link_{k - 1}, at: [l, 0, 0]}}\n" if k else "}\n")
        for k in range(links)
    )
    bodies = "".join(f"  link_{k}: {{mass: m, com: [l/2, 0, 0], inertia: {{zz: J}}}}\n" for k in range(links))
    return f"model: chain\n{PARAMETERS}\njoints:\n{joints}bodies:\n{bodies}inputs:\n  u: {{acts_on: {{q_0: 1}}}}\n"


def system_of(text: str) -> System:
    return System(load_text(text, "model.yaml"))


def momenta(system: System) -> Matrix:
    return by_momenta(system.graph, system.q, system.qd, system.mass_matrix, system.momentum)


def symbols(system: System, velocity: Vector) -> Matrix:
    return by_christoffel_symbols(system.graph, system.mass_matrix_gradient, velocity)


def weight(matrix: Matrix) -> int:
    return cost(flatten(matrix)).weight


def near(system: System, one: Matrix, other: Matrix) -> bool:
    """At a point; square roots of axes are numbers that fingerprints know nothing of."""
    left, right = flatten(one), flatten(other)
    point = inner_point([*left, *right, *system.q, *system.qd, *system.parameters])
    a, b = Evaluator(left)(point), Evaluator(right)(point)
    return max(abs(x - y) for x, y in zip(a, b, strict=True)) < CLOSE * max(map(abs, b))


@pytest.mark.parametrize("in_world_axes", [False, True])
@pytest.mark.parametrize("text", [BALLS, TREE, WHEEL, chain(4)], ids=["balls", "tree", "wheel", "chain"])
def test_composite_bodies_have_what_energies_have(text: str, in_world_axes: bool) -> None:
    """G of the kinetic energy and C of Christoffel symbols, off constraints too."""
    system = system_of(text)
    mass_matrix, coriolis_matrix = composite_matrices(system.bodies, in_world_axes)
    assert near(system, mass_matrix, system.mass_matrix)
    assert near(system, coriolis_matrix, symbols(system, system.qd))


@pytest.mark.parametrize("text", [BALLS, TREE, chain(4), PLANE], ids=["balls", "tree", "chain", "plane"])
def test_what_is_taken_is_that_of_christoffel(text: str) -> None:
    """Along the rates and along another velocity."""
    system = system_of(text)
    other = tuple(2 * rate + q for q, rate in zip(system.q, system.qd, strict=True))
    for velocity in (system.qd, other):
        assert near(system, system.matrices.coriolis_matrix(velocity), symbols(system, velocity))
    assert near(system, system.matrices.mass_matrix, system.mass_matrix)
    assert near(system, momenta(system), symbols(system, system.qd))


@pytest.mark.parametrize("in_world_axes", [False, True])
def test_a_wheel_leaves_no_rounding_of_its_turns(in_world_axes: bool) -> None:
    """G and C hold its rate, which moves other axes, and not its angle."""
    system = system_of(WHEEL)
    for matrix in composite_matrices(system.bodies, in_world_axes):
        assert system.q[2] not in reached(flatten(matrix))
        assert system.q[1] in reached(flatten(matrix))


def test_what_moves_together_takes_momenta_where_there_are_no_bodies() -> None:
    """Half of what the symbols count, for energies that are a ball's."""
    text = PLANE.replace("cos(a - b)", "cos(a - b)*sin(a + 2*b)*exp(cos(a))*(1 + sin(b)**2)")
    system = system_of(text)
    shorter = min(weight(momenta(system.apart())), weight(symbols(system.apart(), system.apart().qd)))
    assert weight(system.matrices.coriolis_matrix(system.qd)) <= shorter


def test_long_chains_take_composite_bodies() -> None:
    """C of 12 links takes less than a quarter of what momenta take, and G less than what energies take."""
    system = system_of(chain(12))
    assert 4 * weight(system.matrices.coriolis_matrix(system.qd)) < weight(momenta(system.apart()))
    assert weight(system.matrices.mass_matrix) < weight(system.apart().mass_matrix)


def test_what_is_short_by_symbols_stays() -> None:
    """The scalars of the plane's C are those that the symbols have on a graph of their own."""
    plane = system_of(PLANE)
    made = flatten(plane.matrices.coriolis_matrix(plane.qd))
    apart = plane.apart()
    assert [repr(x) for x in made] == [repr(x) for x in flatten(symbols(apart, apart.qd))]
