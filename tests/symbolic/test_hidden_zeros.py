"""Scalars that are 0 everywhere because of what roots of numbers are."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.graph import Graph
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.scalar import Scalar


def _turned(graph: Graph, axis: tuple[Scalar, ...], angle: Scalar) -> list[Scalar]:
    """R e - e of a turn about a unit vector e."""
    x, y, z = axis
    c, s = graph.trig("cos", angle), graph.trig("sin", angle)
    cross = ((graph.zero, -z, y), (z, graph.zero, -x), (-y, x, graph.zero))
    zeros = []
    for i, e in enumerate(axis):
        row = [(1 - c) * e * other + s * cross[i][j] + (c if i == j else 0) for j, other in enumerate(axis)]
        zeros.append(graph.sum(a * b for a, b in zip(row, axis, strict=True)) - e)
    return zeros


@pytest.mark.parametrize("axis", [("2", "3", "0"), ("0.3", "0.7", "0.9"), ("0.9104909891213981", "-0.337", "0.24")])
def test_an_axis_stays_where_it_is(axis: tuple[str, ...]) -> None:
    graph = Graph()
    parts = [graph.const(Fraction(x)) for x in axis]
    length = graph.function("sqrt", (graph.sum(x * x for x in parts),))
    unit = (parts[0] / length, parts[1] / length, parts[2] / length)
    left = _turned(graph, unit, graph.symbol("a"))
    assert not all(x.is_zero for x in left)
    assert all(x.is_zero for x in without_hidden_zeros(left))


def test_what_is_small_or_almost_0_stays() -> None:
    graph = Graph()
    root = [graph.function("sqrt", (graph.const(number),)) for number in (3, 5, 15, 53, 59, 53 * 59)]
    x = graph.symbol("x")
    tiny = x * graph.const(Fraction(1, 10**12))
    almost = root[0] * root[1] * x - root[2] * x + tiny
    opposite = root[3] * root[4] * x + root[5] * x
    nothing = root[0] * root[1] * x - root[2] * x
    scalars = (tiny, almost, opposite, nothing, x, graph.one)
    assert without_hidden_zeros(scalars) == (tiny, almost, opposite, graph.zero, x, graph.one)


@pytest.mark.parametrize("number", range(20))
def test_what_is_0_on_one_side_only_stays(number: int) -> None:
    """sqrt(x^2) - x is 0 where x > 0; at a point of a field it is by chance, for each pair of names another one."""
    graph = Graph()
    x, y = graph.symbol(f"x{number}"), graph.symbol(f"y{number}")
    root = graph.function("sqrt", (x * x + 2 * x * y + y * y,))
    angle = graph.function("sqrt", (1 - graph.raw("sub", (graph.one, graph.trig("sin", x) * graph.trig("sin", x))),))
    penalties = (root - (x + y), (x + y) / root - 1, graph.function("abs", (x,)) - x, angle - graph.trig("sin", x))
    assert without_hidden_zeros(penalties) == penalties
    length = graph.function("sqrt", (x * x + y * y,))
    nothing = (x / length) * (x / length) + (y / length) * (y / length) - 1
    assert without_hidden_zeros((nothing, root * root - (x + y) * (x + y))) == (graph.zero, graph.zero)


@pytest.mark.parametrize("seed", range(40))
def test_only_zeros_are_taken_for_zeros(seed: int) -> None:
    """Sums of what is 0, what is not and what is on one side only, in which zeros cancel or do not."""
    graph, draw = Graph(), random.Random(seed)
    x, y = graph.symbol(f"x{seed}"), graph.symbol(f"y{seed}")
    roots = [graph.function("sqrt", (graph.const(number),)) for number in (2, 7, 14)]
    square = graph.function("sqrt", (x * x - 2 * x * y + y * y,))
    parts = [
        roots[0] * roots[1] * x - roots[2] * x,
        graph.function("sqrt", (x * x + 2 * x * y + y * y,)) - x - y,
        square * square - (x - y) * (x - y),
        square + y - x,
        x * y,
    ]
    scalars = []
    for _ in range(8):
        total = graph.zero
        for part in draw.sample(parts, draw.randrange(1, 3)):
            total = total + draw.choice((1, -1, 3)) * part * draw.choice((graph.one, x, y))
        scalars.append(total)
    simplified = without_hidden_zeros(scalars)
    with every_identity_evaluated():
        same_values("hidden zeros", scalars, simplified)


STOP = """model: stop
parameters: {m: {value: 2}, k: {value: 30}}
coordinates: {x: {unit: m}, y: {unit: m}}
kinetic_energy: m*(x_dot**2 + y_dot**2)/2
applied_forces:
  x: k*(sqrt(x**2 - 2*x*y + y**2) + x - y)
  y: k*(sqrt(x**2 + 2*x*y + y**2) - x - y)
inputs: {push: {acts_on: {x: 1}}}
outputs: [applied_force]
"""


def test_a_force_on_one_side_of_a_stop_is_not_lost() -> None:
    (force,) = derive_quantities(load_text(STOP, "stop.yaml"), ["applied_force"]).quantities
    assert not any(entry.is_zero for entry in force.outputs)


SCREWS = """model: screws
joints:
  one: {type: cylindrical, axis: [0.3, 0.7, 0.9], coordinates: [s, a]}
  other: {type: cylindrical, at: [0.5, 0.2, 0], axis: [2, 3, 0], coordinates: [h, b]}
bodies:
  one: {mass: m, inertia: {xx: 0.1, yy: 0.2, zz: 0.25, xy: 0.01}}
  other: {mass: 4, com: [0, 0.3, 0.1], inertia: {xx: 0.1, yy: 0.05, zz: 0.12}}
parameters: {m: 2.5}
gravity: [0, 0, -9.81]
outputs: [coriolis_matrix, coriolis_force, forward_dynamics]
"""


def test_bodies_on_fixed_axes_have_no_coriolis_forces() -> None:
    """Rounding errors in place of 0 are no digits: verification rejected every method of C."""
    model = load_text(SCREWS, "screws.yaml")
    assert all(x.is_zero for slope in System(model).mass_matrix_gradient for row in slope for x in row)
    made = draft_of(model, ["coriolis_matrix"], Options())
    (kernel,) = made.program.kernels
    assert not kernel.statements
