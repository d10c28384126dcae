"""Square systems by reflections of the unknowns."""

from __future__ import annotations

import math
import random
from itertools import permutations

import pytest

from symgen.linear_algebra.square import by_rows
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.traverse import topological


def determinant(matrix: list[list[float]]) -> float:
    """By Leibniz' sum."""
    n = len(matrix)
    return math.fsum(
        (-1) ** sum(p[i] > p[j] for i in range(n) for j in range(i + 1, n))
        * math.prod(matrix[i][p[i]] for i in range(n))
        for p in permutations(range(n))
    )


def solved(matrix: list[list[float]], right: list[float]) -> tuple[list[float], float, float]:
    """x, the product of the factors and that of the lengths, with every entry that is not 0 a symbol."""
    graph, at = Graph(), dict[str, float]()
    rows = []
    for i, row in enumerate(matrix):
        at |= {f"a{i}{j}": x for j, x in enumerate(row)}
        rows.append(tuple(graph.symbol(f"a{i}{j}") if x else graph.zero for j, x in enumerate(row)))
    at |= {f"b{i}": x for i, x in enumerate(right)}
    solution = by_rows(graph, tuple(rows), tuple(graph.symbol(f"b{i}") for i in range(len(right))))
    *values, product, bound = Evaluator(
        [*solution.values, graph.product(solution.squares), graph.product(solution.lengths)]
    )(at)
    return values, product, bound


def residual(matrix: list[list[float]], x: list[float], right: list[float]) -> float:
    return max(abs(sum(a * y for a, y in zip(row, x, strict=True)) - b) for row, b in zip(matrix, right, strict=True))


@pytest.mark.parametrize("size", [5, 6])
@pytest.mark.parametrize("zeros", [0.0, 0.3, 0.5])
def test_solution_and_squared_determinant(size: int, zeros: float) -> None:
    source = random.Random(f"{size} {zeros}")
    for _ in range(6):
        while True:
            matrix = [[source.uniform(-2, 2) * (source.random() >= zeros) for _ in range(size)] for _ in range(size)]
            size_of = determinant(matrix)
            if abs(size_of) > 0.05:
                break
        right = [source.uniform(-2, 2) for _ in range(size)]
        x, product, bound = solved(matrix, right)
        assert residual(matrix, x, right) < 1e-11
        assert product == pytest.approx(size_of**2, rel=1e-10)
        # Hadamard's bound
        assert product <= bound * (1 + 1e-12)


def test_pivots_that_vanish_are_no_matter() -> None:
    # elimination without exchange of rows divides by 0 at each step: the entries are symbols with the value 0
    n = 6
    graph = Graph()
    rows = tuple(tuple(graph.symbol(f"a{i}{j}") for j in range(n)) for i in range(n))
    at = {f"a{i}{j}": float(i + j == n - 1) * (i + 1) for i in range(n) for j in range(n)} | {
        f"b{i}": 1.0 for i in range(n)
    }
    solution = by_rows(graph, rows, tuple(graph.symbol(f"b{i}") for i in range(n)))
    assert Evaluator(solution.values)(at) == pytest.approx([1 / (n - j) for j in range(n)], rel=1e-14)


def test_a_row_with_one_entry_takes_no_root() -> None:
    source = random.Random(5)
    matrix = [[source.uniform(1, 2) for _ in range(4)] for _ in range(4)]
    matrix[1] = [0.0, 0.0, 1.5, 0.0]
    right = [1.0, -1.0, 2.0, 0.5]
    x, product, bound = solved(matrix, right)
    assert residual(matrix, x, right) < 1e-11
    assert product == pytest.approx(determinant(matrix) ** 2)
    assert product <= bound
    graph = Graph()
    rows = tuple(
        tuple(graph.symbol(f"a{i}{j}") if x else graph.zero for j, x in enumerate(row)) for i, row in enumerate(matrix)
    )
    solution = by_rows(graph, rows, tuple(map(graph.const, (1, 2, 3, 4))))
    assert all(node.op != "sqrt" for node in topological(solution.values))


def test_small_rows_keep_their_digits() -> None:
    # equations of very different size, each known to its own digits
    source = random.Random(11)
    matrix = [[source.uniform(-2, 2) for _ in range(6)] for _ in range(6)]
    x = [source.uniform(-2, 2) for _ in range(6)]
    scaled = [[entry * 2.0 ** (-9 * i) for entry in row] for i, row in enumerate(matrix)]
    right = [math.fsum(a * b for a, b in zip(row, x, strict=True)) for row in scaled]
    solution, _, _ = solved(scaled, right)
    assert solution == pytest.approx(x, rel=1e-11)


def test_a_row_of_zeros_divides_nothing_by_zero_where_it_must_not() -> None:
    graph, source = Graph(), random.Random(3)
    names = [[f"a{i}{j}" for j in range(6)] for i in range(6)]
    at = {name: source.uniform(1, 2) * (i > 0) for i, row in enumerate(names) for name in row}
    matrix, right = tuple(tuple(map(graph.symbol, row)) for row in names), (graph.one,) * 6
    solution = by_rows(graph, matrix, right, everywhere=True)
    assert Evaluator([graph.product(solution.squares)])(at) == [0]
    assert math.isnan(Evaluator([graph.product(by_rows(graph, matrix, right).squares)])(at)[0])
