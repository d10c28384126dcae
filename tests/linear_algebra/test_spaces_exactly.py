"""Null spaces, solutions and sums of minors by one way are those by another, exactly: values in a field.

Reflections take roots: where the field has none of what is 0 < x in the reals, a point tells nothing.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

import pytest

from symgen.diagnostics import SymgenBug
from symgen.linear_algebra.exterior import square, unit, wedge_all
from symgen.linear_algebra.minor_sums import elementary_symmetric, squared_minors
from symgen.linear_algebra.null_space.block_space import BlockSpace
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, MinorSpace, NullSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.linear_algebra.null_space.proportional_columns import FamilySpace, families
from symgen.linear_algebra.square import by_rows
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.matrix import Matrix, Vector, flatten, identity, matmul, matvec, transpose
from symgen.symbolic.scalar import Scalar

SEEDS = range(6)


def _same(rule: str, before: Sequence[Scalar], after: Sequence[Scalar]) -> None:
    with every_identity_evaluated():
        same_values(rule, before, after, squares_roots=True)


def _rows(graph: Graph, draw: random.Random, r: int, n: int, zeros: float = 0.3) -> Matrix:
    """Rows of numbers, symbols, sines and products of these, none of them 0."""
    parts = [graph.one, graph.const(Fraction(-3, 2)), *(graph.symbol(name) for name in "klp")]
    parts += [graph.trig(op, graph.symbol("p")) for op in ("sin", "cos")]
    parts += [parts[2] * parts[5], parts[3] - parts[2]]
    rows = [[graph.zero if draw.random() < zeros else draw.choice(parts) for _ in range(n)] for _ in range(r)]
    for i, row in enumerate(rows):
        row[i] = draw.choice(parts)
    return tuple(map(tuple, rows))


def _proportional(graph: Graph, draw: random.Random) -> Matrix:
    """Two rows with three directions of columns."""
    columns = [*zip(*_rows(graph, draw, 2, 3, 0.0), strict=True)]
    factors = (Fraction(-2, 3), Fraction(1), Fraction(3))
    columns += [tuple(x * factors[j] for x in columns[j]) for j in range(2)]
    return tuple(zip(*columns, strict=True))


def _invariants(space: NullSpace, x: Vector, a: Vector) -> list[Scalar]:
    """What a null space tells, whatever basis it has."""
    vectors = (space.project(x), space.lift(a), space.lift_transposed(x))
    return [*flatten(space.projector), *flatten(space.pseudoinverse), *(entry for v in vectors for entry in v)]


def _vectors(graph: Graph, n: int, r: int) -> tuple[Vector, Vector]:
    return tuple(graph.symbol(f"x{j}") for j in range(n)), tuple(graph.symbol(f"a{i}") for i in range(r))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("shape", [(1, 3), (2, 3), (2, 4)])
def test_a_null_space_by_reflections_is_that_by_minors(shape: tuple[int, int], seed: int) -> None:
    (r, n), graph = shape, Graph()
    rows = _rows(graph, random.Random(seed), r, n)
    x, a = _vectors(graph, n, r)
    minors = MinorSpace(graph, rows, n, r)
    inverse = minors.pseudoinverse
    _same("B B^+", flatten(matmul(graph, rows, inverse, r)), flatten(identity(graph, r)))
    along = matmul(graph, inverse, rows, n)
    _same("B^+ B is symmetric", flatten(along), flatten(transpose(along, n)))
    kept = [one - other for one, other in zip(flatten(identity(graph, n)), flatten(along), strict=True)]
    _same("1 - B^+ B", kept, flatten(minors.projector))
    for space in (HouseholderSpace(graph, rows, n), reflected(graph, rows, n, r)):
        _same("reflections", _invariants(minors, x, a), _invariants(space, x, a))
        across = transpose(space.basis, n - r)
        square_of_basis = matmul(graph, across, space.basis, n - r)
        _same("an orthonormal basis", flatten(square_of_basis), flatten(identity(graph, n - r)))
        _same("det(B B^T)", [minors.forms.square], [space.square])


@pytest.mark.parametrize("seed", SEEDS)
def test_dependent_rows_by_minors_have_the_pseudoinverse(seed: int) -> None:
    """Penrose's four equations."""
    graph, draw = Graph(), random.Random(seed)
    (first, second) = _rows(graph, draw, 2, 4)
    rows = (first, second, tuple(2 * x - graph.symbol("k") * y for x, y in zip(first, second, strict=True)))
    space = MinorSpace(graph, rows, 4, 2)
    inverse = space.pseudoinverse
    one, other = matmul(graph, rows, inverse, 3), matmul(graph, inverse, rows, 4)
    _same("B B^+ B", flatten(rows), flatten(matmul(graph, one, rows, 4)))
    _same("B^+ B B^+", flatten(inverse), flatten(matmul(graph, other, inverse, 3)))
    _same("B B^+ is symmetric", flatten(one), flatten(transpose(one, 3)))
    _same("B^+ B is symmetric", flatten(other), flatten(transpose(other, 4)))
    x, a = _vectors(graph, 4, 3)
    vectors = (matvec(graph, inverse, a), matvec(graph, transpose(inverse, 3), x), matvec(graph, space.projector, x))
    _same("vectors", [y for v in vectors for y in v], [*space.lift(a), *space.lift_transposed(x), *space.project(x)])


@pytest.mark.parametrize("seed", SEEDS)
def test_spaces_of_families_and_of_blocks_are_the_space(seed: int) -> None:
    graph, draw = Graph(), random.Random(seed)
    rows = _proportional(graph, draw)
    groups = families(rows, 5)
    assert len(groups) <= 3
    x, a = _vectors(graph, 5, 2)
    space = FamilySpace(graph, rows, 5, 2, groups)
    _same("families", _invariants(MinorSpace(graph, rows, 5, 2), x, a), _invariants(space, x, a))
    zero = (graph.zero,) * 2
    left, right = _rows(graph, draw, 1, 2, 0.0), _rows(graph, draw, 1, 2, 0.0)
    apart = (*((*row, *zero) for row in left), *((*zero, *row) for row in right))
    x, a = _vectors(graph, 4, 2)
    _same("blocks", _invariants(MinorSpace(graph, apart, 4, 2), x, a), _invariants(BlockSpace(graph, apart, 4), x, a))


@pytest.mark.parametrize("everywhere", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_solutions_of_square_systems_solve_them(seed: int, everywhere: bool) -> None:
    graph, n = Graph(), 4
    matrix = _rows(graph, random.Random(seed), n, n)
    (_, right) = _vectors(graph, 0, n)
    solution = by_rows(graph, matrix, right, everywhere)
    _same("A x", right, matvec(graph, matrix, solution.values))
    determinant = wedge_all(unit(graph), matrix).get((1 << n) - 1, graph.zero)
    _same("det A", [determinant * determinant], [graph.product(solution.squares)])


@pytest.mark.parametrize("seed", SEEDS)
def test_sums_of_squared_minors_are_those_of_all_minors(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    columns = _rows(graph, random.Random(seed), 3, 3, 0.4)
    listed = [
        graph.sum(square(graph, wedge_all(unit(graph), subset)) for subset in combinations(columns, degree))
        for degree in range(1, 4)
    ]
    monkeypatch.setattr("symgen.linear_algebra.minor_sums.small_family", lambda *_: False)
    _same("by blocks", listed, [squared_minors(graph, columns, degree) for degree in range(1, 4)])
    values = [graph.symbol(f"v{i}") for i in range(5)]
    products = [graph.sum(map(graph.product, combinations(values, degree))) for degree in range(6)]
    _same("symmetric", products, [elementary_symmetric(graph, values, degree) for degree in range(6)])


def test_what_is_no_null_space_is_noticed() -> None:
    graph = Graph()
    rows = _rows(graph, random.Random(1), 2, 4)
    space = HouseholderSpace(graph, rows, 4)
    wrong = [x if i != 3 else -x for i, x in enumerate(flatten(space.projector))]
    with pytest.raises(SymgenBug, match="that: changes the value of 1 of 16"):
        _same("that", flatten(MinorSpace(graph, rows, 4, 2).projector), wrong)
