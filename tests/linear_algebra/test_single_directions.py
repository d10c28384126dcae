"""A status says that one direction is lost: many that are a little poor are not taken for one, one among them is."""

from __future__ import annotations

import json
import math
import random
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symgen.cli.main import main
from symgen.ir.kernel import UNIT_ROUNDOFF, Literal, Status
from symgen.linear_algebra.constrained_inverse import diagonal_sizes
from symgen.linear_algebra.guards import Guard, lost_only_at_zero, magnitude, multiplied
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, MinorSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix
from symgen.symbolic.scalar import Scalar
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import State

SINGLE = UNIT_ROUNDOFF["float32"]
SIZE = 8

# seven joints about oblique axes: bounds of inertias are thousands of times the inertias
ARM = """
model: carving_arm
gravity: [0, 0, -9.81]
joints:
  one: {type: revolute, coordinate: a, axis: [0, 1, 1], child: first}
  two: {type: revolute, coordinate: b, parent: first, at: [0.1, 0, 0.4], axis: [1, 1, 0], child: second}
  three: {type: revolute, coordinate: c, parent: second, at: [0, 0.1, 0.4], axis: [1, 0, 2], child: third}
  four: {type: revolute, coordinate: d, parent: third, at: [0.1, 0, 0.4], axis: [2, 1, 0], child: fourth}
  five: {type: revolute, coordinate: e, parent: fourth, at: [0, 0.1, 0.3], axis: [0, 1, -1], child: fifth}
  six: {type: revolute, coordinate: f, parent: fifth, at: [0.1, 0, 0.3], axis: [1, -1, 1], child: sixth}
  seven: {type: revolute, coordinate: h, parent: sixth, at: [0, 0.1, 0.2], axis: [1, 0, 1], child: seventh}
bodies:
  first: {mass: 3, com: [0.05, 0, 0.2], inertia: {xx: 0.05, yy: 0.04, zz: 0.02}}
  second: {mass: 3, com: [0.05, 0, 0.2], inertia: {xx: 0.05, yy: 0.04, zz: 0.02}}
  third: {mass: 2, com: [0.05, 0, 0.2], inertia: {xx: 0.04, yy: 0.03, zz: 0.02}}
  fourth: {mass: 2, com: [0, 0.05, 0.2], inertia: {xx: 0.03, yy: 0.03, zz: 0.01}}
  fifth: {mass: 1, com: [0.05, 0, 0.1], inertia: {xx: 0.02, yy: 0.02, zz: 0.01}}
  sixth: {mass: 1, com: [0.05, 0, 0.1], inertia: {xx: 0.01, yy: 0.01, zz: 0.005}}
  seventh: {mass: m_tool, com: [0, 0, 0.1], inertia: {xx: 0.005, yy: 0.005, zz: 0.002}}
parameters: {m_tool: 0.5}
points: {tip: {frame: seventh, at: [0, 0, 0.2]}}
constraints: {nonholonomic: {blade: tip.vx + 0.3*tip.vz}}
outputs: [weighted_nullspace_projector]
"""

# five inputs on a planar chain whose columns turn with it, each a little short of the others' directions
REACHES = """
model: reaching_chain
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + e_dot**2)/2
inputs:
  u_1: {acts_on: {a: sin(a), b: sin(a) + sin(a + b), c: sin(a) + sin(a + b) + sin(a + b + c)}}
  u_2: {acts_on: {a: cos(a), b: cos(a) + cos(a + b), c: cos(a) + cos(a + b) + cos(a + b + c)}}
  u_3: {acts_on: {b: sin(b), c: sin(b) + sin(b + c), d: sin(b) + sin(b + c) + sin(b + c + d)}}
  u_4: {acts_on: {c: cos(c), d: cos(c) + cos(c + d), e: cos(c) + cos(c + d) + cos(c + d + e)}}
  u_5: {acts_on: {d: sin(d), e: sin(d) + sin(d + e)}}
outputs: [inverse_dynamics]
"""


# a slide of a milligram that carries a tonne, on a tonne: nothing of its inertia comes from the others
LIGHT = """
model: light_slide
joints:
  base: {type: prismatic, axis: y, coordinate: s}
  light: {type: prismatic, parent: base, axis: y, coordinate: p}
  top: {type: prismatic, parent: light, axis: y, coordinate: w}
bodies: {base: {mass: 1000}, light: {mass: 1e-6}, top: {mass: 1000}}
inputs: {one: {joint: s}, two: {joint: p}, three: {joint: w}}
outputs: [forward_dynamics]
"""

SLEDGE = """
model: sledge
parameters: {m: {value: 2}, J: {value: 0.3}}
coordinates: {heading: {unit: rad}, x: {unit: m}, y: {unit: m}}
kinetic_energy: J/2*heading_dot**2 + m/2*(x_dot**2 + y_dot**2)
constraints: {nonholonomic: {edge: sin(heading)*x_dot - cos(heading)*y_dot}}
inputs: {push: {unit: N, acts_on: {x: cos(heading), y: sin(heading)}}}
outputs: [forward_dynamics]
"""

# coupled by a parameter: beyond the root of the product of both inertias no energy is positive
COUPLED = """
model: coupled
parameters: {k: {value: 0.4, range: [0.1, 0.5]}}
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2)/2 + k*cos(b)*a_dot*b_dot + k*sin(b)*b_dot*c_dot
constraints: {nonholonomic: {belt: a_dot + cos(c)*c_dot}}
inputs: {u: {acts_on: {a: 1}}}
outputs: [forward_dynamics]
"""


def passes(guard: Guard, point: dict[str, float], size: int = SIZE, eps: Fraction = SINGLE) -> bool:
    """The test of a kernel, in double precision."""
    graph = guard.denominator.graph
    scale = magnitude(graph, [guard.denominator])[0] if guard.scale is None else guard.scale
    denominator, most = Evaluator([guard.denominator, scale])(point)
    return abs(denominator) > float(guard.threshold(size, eps)) * most


def leaning(graph: Graph, shares: list[float], together: int = SIZE) -> tuple[Matrix, dict[str, float]]:
    """Rows of length 1, of which each keeps a share beside the row before, as symbols with their values.

    The first of so many rows `together` leans on none.
    """
    values: dict[str, float] = {}
    rows = []
    for i, share in enumerate(shares):
        entries = dict.fromkeys(range(SIZE), 0.0) | {i: share}
        if i % together:
            entries[i - 1] = math.sqrt(1 - share**2)
        values |= {f"x_{i}_{j}": entry for j, entry in entries.items()}
        rows.append(tuple(graph.symbol(f"x_{i}_{j}") for j in entries))
    return tuple(rows), values


def test_many_poor_rows_are_no_lost_row() -> None:
    graph = Graph()
    for lost in (False, True):
        rows, values = leaning(graph, [1.0, 0.01] * 3 + [1.0, 1e-8 if lost else 0.01], together=2)
        guards = HouseholderSpace(graph, rows, SIZE).guards
        assert len(guards) == len(rows)
        assert all(passes(guard, values) for guard in guards) is not lost


def test_rows_that_lean_on_leaning_rows_are_as_near_to_a_loss_as_all_of_them_together() -> None:
    for shares, regular in (([1.0, 0.1, 0.1, 0.1], True), ([1.0, 0.01, 0.01, 0.01], False)):
        graph = Graph()
        rows, values = leaning(graph, shares)
        guards = HouseholderSpace(graph, rows, SIZE).guards
        assert all(passes(guard, values) for guard in guards) is regular
        # the smallest singular value, up to the root of the number of rows
        squares = [Evaluator([guard.denominator / guard.scale])(values)[0] for guard in guards if guard.scale]
        measure = math.sqrt(min(squares))
        smallest = np.linalg.svd([[values[f"x_{i}_{j}"] for j in range(SIZE)] for i in range(4)])[1][-1]
        assert smallest * (1 - 1e-6) <= measure <= smallest * 2


def test_what_rounding_leaves_of_a_dependent_row_beside_rows_that_are_nearly_parallel_is_no_direction() -> None:
    source = np.random.default_rng(7)
    for _ in range(20):
        # three rows in a plane, the first two a millionth of a radian apart, and a share of the last out of the plane
        axes = np.linalg.qr(source.normal(size=(SIZE, 3)))[0].T
        angles = source.uniform(-3, 3) + np.array([0, 1e-6, source.uniform(1, 2)])
        for share in (0.0, 0.01):
            graph = Graph()
            entries = np.stack([np.cos(angles), np.sin(angles), [0, 0, share]], axis=1) @ axes
            rows = tuple(tuple(graph.symbol(f"x_{i}_{j}") for j in range(SIZE)) for i in range(3))
            values = {f"x_{i}_{j}": float(entries[i, j]) for i in range(3) for j in range(SIZE)}
            guards = HouseholderSpace(graph, rows, SIZE).guards
            assert all(passes(guard, values, eps=UNIT_ROUNDOFF["float64"]) for guard in guards) is (share > 0)


def test_rows_that_were_chosen_count_by_what_is_left_of_them() -> None:
    graph = Graph()
    for lost in (False, True):
        rows, values = leaning(graph, [1.0, 0.02, 0.02, 1e-8 if lost else 0.02])
        guards = reflected(graph, (*rows, rows[0]), SIZE, 4).guards
        assert all(passes(guard, values) for guard in guards) is not lost


def test_minors_tell_a_lost_row_from_poor_ones() -> None:
    graph = Graph()
    for shares, regular in (([1.0, 0.1, 0.1, 0.1, 0.01], True), ([1.0, 0.5, 0.5, 0.5, 1e-8], False)):
        rows, values = leaning(graph, shares)
        (guard,) = MinorSpace(graph, rows, SIZE, len(rows)).guards
        assert passes(guard, values) is regular


@pytest.mark.parametrize(
    ("squares", "regular"),
    [([0.03] * 12, True), ([0.03, 0.03, 1e-8, 0.03], True), ([1e-12], False), ([1e-8, 1e-7, 0.5], False)],
)
def test_losses_of_steps_multiply_where_they_are_no_ordinary_ones(squares: list[float], regular: bool) -> None:
    graph = Graph()
    symbols = [graph.symbol(f"s_{k}") for k in range(len(squares))]
    (guard,) = multiplied(Status.MASS_RANK, symbols, [graph.symbol(f"l_{k}") for k in range(len(squares))])
    lengths = {f"l_{k}": 2.0 for k in range(len(squares))}
    values = {f"s_{k}": 2 * x for k, x in enumerate(squares)}
    assert passes(guard, lengths | values) is regular


@pytest.mark.parametrize(("square", "count", "together", "regular"), [(1 / 6, 50, 2, True), (1 / 200, 9, 9, False)])
def test_rows_that_lean_are_regular_in_pairs_and_lost_in_a_chain(
    square: float, count: int, together: int, regular: bool
) -> None:
    """Pairs of rows at 24 degrees are as regular as one of them; nine that lean on each other are one row fewer."""
    rows = np.zeros((count, count))
    for i in range(count):
        rows[i, i] = math.sqrt(square) if i % together else 1
        if i % together:
            rows[i, i - 1] = math.sqrt(1 - square)
    smallest = np.linalg.svd(rows)[1][-1]
    assert smallest > 0.2 if regular else smallest < count * float(SINGLE)
    # what Gram and Schmidt's process leaves of each
    left = np.linalg.qr(rows.T)[1].diagonal() ** 2
    graph = Graph()
    symbols = [graph.symbol(f"s_{k}") for k in range(count)]
    (guard,) = multiplied(Status.MASS_RANK, symbols, [graph.symbol(f"l_{k}") for k in range(count)])
    lengths = {f"l_{k}": 1.0 for k in range(count)}
    values = {f"s_{k}": float(x) for k, x in enumerate(left)}
    assert passes(guard, lengths | values, size=count) is regular


def test_inertias_are_measured_by_themselves() -> None:
    mechanics = System(load_text(ARM, "arm.yaml"))
    entries = [row[i] for i, row in enumerate(mechanics.mass_matrix)]
    sizes = diagonal_sizes(mechanics.graph, mechanics.mass_matrix)
    bounds = magnitude(mechanics.graph, entries)
    source = random.Random(4)
    point = {c.name: source.uniform(-3, 3) for c in mechanics.model.coordinates} | {"m_tool": 0.5}
    own, measured, largest = (Evaluator(values)(point) for values in (entries, sizes, bounds))
    assert min(x / most for x, most in zip(own, largest, strict=True)) < 1e-3
    assert own == pytest.approx(measured, rel=1e-2)
    # a coordinate that moves nothing has no inertia, whatever it is measured by
    nothing = mechanics.graph.symbol("m_tool") * mechanics.graph.function("sin", (mechanics.graph.symbol("a"),))
    (size,) = diagonal_sizes(mechanics.graph, ((nothing * nothing,),))
    tiny = Evaluator([nothing * nothing / size])({"m_tool": 1.0, "a": 1e-12})
    assert tiny[0] < 8 * float(SINGLE)


def test_a_product_of_masses_is_lost_only_where_one_is_0() -> None:
    """It is as large as its factors are, so that there is no sum to hold it against."""
    asked = "forward_dynamics"
    selection = derive_quantities(load_text(SLEDGE, "sledge.yaml"), [asked], {asked: "minor"})
    program = schedule(selection.mechanics, selection.quantities, ("float64",))["float64"]
    (kernel,) = (one for one in program.kernels if one.name == asked)
    checks = [check for block in kernel.blocks for check in block.checks if check.status is Status.MASS_RANK]
    assert [check.limit for check in checks] == [Literal(Fraction(0))]
    masses = [(2.0, 0.3), (1e-9, 1e9), (-2.0, 0.3), (0.0, 0.3), (2.0, 0.0)]
    states = [State((0.1, 0.7, 0.2), (0.3, 0.2, 0.1), (), (1.0,), given) for given in masses]
    statuses = [one.status for one in outcomes(kernel, program.sincos, "float64", states)]
    assert statuses == [Status.OK] * 3 + [Status.MASS_RANK] * 2


def test_what_cancels_somewhere_is_held_against_its_scale() -> None:
    """A pivot over a small difference, or of a function of one, is not right to all its digits."""
    graph = Graph()
    x, y, z = (graph.symbol(name) for name in "xyz")

    def lost_at_zero(pivot: Scalar) -> bool:
        return lost_only_at_zero(Guard(Status.MASS_RANK, pivot, 1, scale=graph.one, positive=True))

    assert all(map(lost_at_zero, (x, x * y / z, x * x + y * y / (z * z), x / (y * y + z * z))))
    cancelling = (x - y, x + y, x / (y - z), graph.function("exp", (x - y,)), x * graph.trig("sin", y), x * x * (y + z))
    assert not any(map(lost_at_zero, cancelling))


def test_a_light_body_between_heavy_ones_is_no_lost_direction() -> None:
    """Its pivot is its mass, to all digits, and with the threshold of float32 it had a status everywhere."""
    asked = "forward_dynamics"
    selection = derive_quantities(load_text(LIGHT, "light.yaml"), [asked], {asked: "articulated"})
    program = schedule(selection.mechanics, selection.quantities, ("float32",))["float32"]
    (kernel,) = (one for one in program.kernels if one.name == asked)
    state = State((0.1, 0.2, 0.3), (0.0,) * 3, (), (3.0, 1.0, 5.0), ())
    (outcome,) = outcomes(kernel, program.sincos, "float32", [state])
    # of each body alone: m_1 a_1 = u_1 - u_2, m_2 a_2 = u_2 - u_3, m_3 a_3 = u_3
    first, second, third = (3 - 1) / 1000, (1 - 5) / 1e-6, 5 / 1000
    assert outcome.status == Status.OK
    assert outcome.entries == pytest.approx([first, second - first, third - second], rel=4 * float(SINGLE))


def test_pivots_of_a_mass_matrix_below_0_are_lost() -> None:
    asked = "forward_dynamics"
    selection = derive_quantities(load_text(COUPLED, "coupled.yaml"), [asked], {asked: "schur_qr"})
    program = schedule(selection.mechanics, selection.quantities, ("float64",))["float64"]
    (kernel,) = (one for one in program.kernels if one.name == asked)
    states = [State((0.1, 0.7, 0.2), (0.3, 0.2, 0.1), (), (1.0,), (k,)) for k in (0.4, 4.0)]
    results = outcomes(kernel, program.sincos, "float64", states)
    assert [one.status for one in results] == [Status.OK, Status.MASS_RANK]


@pytest.mark.campaign
def test_single_precision_is_kept_where_bounds_are_far_above_inertias(tmp_path: Path) -> None:
    file = tmp_path / "arm.yaml"
    file.write_text(ARM)
    given = ("--only", "c", "--states", "8", "--scalar", "float32", "--quiet", "--out", str(tmp_path))
    assert main([str(file), *given]) == 0
    derivation = json.loads((tmp_path / "carving_arm" / "derivation.json").read_text())
    assert "left_out" not in derivation
    assert "weighted_nullspace_projector" in derivation["kernels"]


def test_inputs_that_are_a_little_poor_together_are_kept() -> None:
    mechanics = System(load_text(REACHES, "reaches.yaml"))
    generic = genericity(mechanics)
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    guards = Derivation(mechanics, generic, space).actuation_guards
    source = random.Random(1)
    points = [{c.name: source.uniform(-3, 3) for c in mechanics.model.coordinates} for _ in range(40)]
    assert all(passes(guard, point, mechanics.n) for guard in guards for point in points)
    folded = points[0] | {"d": 0.0, "e": 0.0}  # u_5 has no effect
    assert not all(passes(guard, folded, mechanics.n) for guard in guards)
    short = points[0] | {"d": 1e-9, "e": 1e-9}
    assert not all(passes(guard, short, mechanics.n) for guard in guards)
