"""Columns of B that are the same up to a factor: N_B is constant across them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from symgen.ir.kernel import Status
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.linear_algebra.null_space.proportional_columns import FamilySpace, families
from symgen.mechanics.genericity import configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.method import solved_for_u
from symgen.methods.spaces import derivations
from symgen.methods.system import MethodInput
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, flatten

# Two slides on one line and two wheels of a gear, which move against each other, and a lever that they hold
LIFT = """model: lift
coordinates: {c: {}, s_1: {}, free: {}, s_2: {}, d: {}, b: {}}
kinetic_energy: 1/2*(3*s_1_dot**2 + 2*s_2_dot**2 + free_dot**2 + (1 + sin(c)**2)*c_dot**2 + d_dot**2/5 + b_dot**2)
potential_energy: 5000*sin(b) + 3*s_1 + 800*(c - 3/2*d)**2
constraints:
  geometric:
    along: (s_1 + s_2)*cos(b) + (c - 3/2*d)*sin(b) - cos(1)
    across: (s_1 + s_2)*sin(b) - 2*(c - 3/2*d)*cos(b) - sin(1)
    turned: (s_1 + s_2)*cos(2*b) - cos(2)
    again: (s_1 + s_2)*(cos(2*b) + 3*sin(b)) - 6*(c - 3/2*d)*cos(b) - cos(2) - 3*sin(1)
inputs: {u: {acts_on: {s_1: 1}}, v: {acts_on: {d: 1, b: 1}}}
outputs: [nullspace_projector, inverse_dynamics]
configuration: {s_1: 0.3, s_2: 0.7, b: 1}
"""


def _rows(graph: Graph) -> Matrix:
    """Six columns in three families, one of them of a column of its own, and one that is 0."""
    s, t, zero = graph.symbol("s"), graph.symbol("t"), graph.zero
    first = (graph.trig("sin", s), t, s * t)
    second = (s + t, graph.one, graph.trig("cos", t))
    third = (zero, t * t, s)
    columns = (first, second, tuple(x * Fraction(-2, 3) for x in first), (zero,) * 3, third, tuple(-x for x in first))
    columns = (*columns, tuple(3 * x for x in second))
    return tuple(zip(*columns, strict=True))


def test_columns_are_gathered_by_their_directions() -> None:
    rows = _rows(Graph())
    groups = families(rows, 7)
    assert [family.entries for family in groups] == [{0: 1, 2: Fraction(-2, 3), 5: -1}, {1: 1, 6: 3}, {4: 1}]


@pytest.mark.parametrize(("factor", "count"), [(Fraction(9973, 9967), 1), (Fraction(9967, 10007), 2)])
def test_factors_are_fractions_of_four_digits(factor: Fraction, count: int) -> None:
    graph = Graph()
    s, t = graph.symbol("s"), graph.symbol("t")
    assert len(families(((s, s * factor), (t, t * factor)), 2)) == count


def test_columns_that_are_proportional_here_and_there_stay_apart() -> None:
    graph = Graph()
    s, t = graph.symbol("s"), graph.symbol("t")
    rows = ((s, s * graph.function("sqrt", (graph.const(2),)), t), (t, t, s))
    nodes = len(graph)
    assert [family.members for family in families(rows, 3)] == [(0,), (1,), (2,)]
    assert len(graph) == nodes


@pytest.mark.parametrize(("kept", "rank"), [((0, 1), 2), ((0, 1, 2), 3), ((0, 1, 0), 2)])
def test_what_a_space_of_families_gives_is_what_columns_give(kept: tuple[int, ...], rank: int) -> None:
    graph = Graph()
    every = _rows(graph)
    rows = tuple(every[i] for i in kept)
    space, n, r = FamilySpace(graph, rows, 7, rank, families(rows, 7)), 7, len(rows)
    x, a = ([graph.symbol(f"{name}{j}") for j in range(count)] for name, count in (("x", n), ("a", r)))
    _, restriction = space.actuation([tuple(x)], 1)
    made = (rows, space.projector, space.basis, space.pseudoinverse)
    vectors = (restriction(tuple(x)), space.project(tuple(x)), space.lift(tuple(a)), space.lift_transposed(tuple(x)))
    spaces = (space, HouseholderSpace(graph, rows, n)) if rank == r else ()
    plain = [each.restriction.orientation(graph) for each in spaces]
    scalars = [entry for vector in (*map(flatten, made), *vectors) for entry in vector]
    drawn = np.random.default_rng(1)
    names = ("s", "t", *(f"x{j}" for j in range(n)), *(f"a{j}" for j in range(r)))
    point = {name: drawn.uniform(0.3, 1) for name in names}
    numbers = np.array(Evaluator([*scalars, *plain])(point))
    sizes = [r * n, n * n, n * (n - rank), n * r, n - rank, n, n, r]
    b, projector, basis, inverse, along, projected, lifted, multipliers = np.split(
        numbers[: sum(sizes)], np.cumsum(sizes)[:-1]
    )
    b, projector, basis, inverse = b.reshape(r, n), projector.reshape(n, n), basis.reshape(n, -1), inverse.reshape(n, r)
    right = np.linalg.pinv(b, rcond=1e-10)
    vector = np.array([point[f"x{j}"] for j in range(n)])
    assert inverse == pytest.approx(right, rel=1e-9, abs=1e-9)
    assert projector == pytest.approx(np.eye(n) - right @ b, rel=1e-9, abs=1e-9)
    assert basis.T @ basis == pytest.approx(np.eye(n - rank), rel=1e-9, abs=1e-9)
    assert basis @ basis.T == pytest.approx(projector, rel=1e-9, abs=1e-9)
    assert along == pytest.approx(basis.T @ vector, rel=1e-9, abs=1e-9)
    assert projected == pytest.approx(projector @ vector, rel=1e-9, abs=1e-9)
    assert lifted == pytest.approx(right @ [point[f"a{i}"] for i in range(r)], rel=1e-9, abs=1e-9)
    assert multipliers == pytest.approx(right.T @ vector, rel=1e-9, abs=1e-9)
    if rank == r:
        turned, usual = numbers[sum(sizes) :]
        reflections = HouseholderSpace(graph, rows, n)
        own = np.array(Evaluator(flatten(reflections.basis))(point)).reshape(n, -1)
        orders = [np.linalg.det(np.vstack([f.T, b])) for f in (basis, own)]
        assert turned * np.sign(orders[0]) == usual * np.sign(orders[1])


def test_the_null_space_is_constant_where_families_are_as_many_as_the_rank() -> None:
    mechanics = System(load_text(LIFT, "lift.yaml"))
    generic = genericity(mechanics)
    assert (generic.rank, generic.locked) == (3, (0, 1, 5))
    along = derivations(mechanics, generic)["householder"]
    half, gear = Fraction(1, 2), Fraction(4, 13)
    expected = {(1, 1): half, (1, 3): -half, (3, 1): -half, (3, 3): half, (2, 2): 1}
    expected |= {(0, 0): 9 * gear / 4, (0, 4): 3 * gear / 2, (4, 0): 3 * gear / 2, (4, 4): gear}
    for i, row in enumerate(along.space.projector):
        assert [entry.constant for entry in row] == [expected.get((i, j), 0) for j in range(6)]
    system = MethodInput(mechanics, generic)
    u = solved_for_u(system, along.inverse_dynamics, along.inverse_dynamics_guards).derived
    assert Status.CONSTRAINT_RANK in {guard.status for guard in u.guards}
    drawn = np.random.default_rng(2)
    rates = {f"{c.name}_{dots}": drawn.normal() for c in mechanics.model.coordinates for dots in ("dot", "ddot")}
    values = Evaluator([*u.outputs, *mechanics.balance])
    for point in configurations(mechanics):
        numbers = np.array(values(point | rates))
        across = np.array([1, 0, -1, 0]) / np.sqrt(2), np.array([0, 1.5, 0, 1]) / np.sqrt(3.25)
        balance = numbers[2:][[1, 0, 3, 4]]
        assert numbers[0] == pytest.approx(across[0] @ balance * np.sqrt(2), rel=1e-13)
        assert numbers[1] == pytest.approx(across[1] @ balance * np.sqrt(3.25), rel=1e-13)
