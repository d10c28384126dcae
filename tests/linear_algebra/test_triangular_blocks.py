"""Square systems in blocks, rows of numbers, turned and added to each other: against plain numbers, exactly."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from symgen.ir.kernel import Status
from symgen.linear_algebra.rows.constant_rows import ConstantRows
from symgen.linear_algebra.rows.sparser_rows import SparserRows
from symgen.linear_algebra.rows.turned_rows import TurnedRows
from symgen.linear_algebra.triangular_blocks import BlockwiseSolution, triangular_blocks
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix
from symgen.symbolic.traverse import reached


def numbered(graph: Graph, pattern: list[str]) -> Matrix:
    """A symbol for every mark of a pattern."""
    return tuple(
        tuple(graph.symbol(f"a{i}{j}") if mark == "x" else graph.zero for j, mark in enumerate(row))
        for i, row in enumerate(pattern)
    )


@pytest.mark.parametrize(
    ("pattern", "sizes"),
    [
        (["x..", "xx.", ".xx"], [1, 1, 1]),
        (["xx.", "xx.", "xxx"], [2, 1]),
        (["..x", "xx.", "xxx"], [1, 2]),
        ([".x", "x."], [1, 1]),
        (["x.x.", ".x.x", "xx..", "..xx"], [4]),
        (["xx..", "xx..", "xxxx", "xxxx"], [2, 2]),
    ],
)
def test_blocks_are_as_small_as_they_can_be(pattern: list[str], sizes: list[int]) -> None:
    blocks = triangular_blocks([[mark == "x" for mark in row] for row in pattern])
    assert blocks is not None
    assert [len(block.rows) for block in blocks] == sizes
    known: set[int] = set()
    for block in blocks:
        for row in block.rows:
            assert {j for j, mark in enumerate(pattern[row]) if mark == "x"} <= known | set(block.columns)
        known |= set(block.columns)


def test_a_pattern_that_no_values_make_regular_has_none() -> None:
    assert triangular_blocks([[True, True, False], [True, True, False], [True, True, False]]) is None
    assert triangular_blocks([[False]]) is None
    assert triangular_blocks([]) == ()


@pytest.mark.parametrize("seed", range(8))
def test_what_is_solved_is_the_system(seed: int) -> None:
    dice, size = random.Random(seed), 5 + seed % 3
    pattern = ["".join("x" if i == j or dice.random() < 0.3 else "." for j in range(size)) for i in range(size)]
    dice.shuffle(pattern)
    graph = Graph()
    matrix, right = numbered(graph, pattern), [graph.symbol(f"b{i}") for i in range(size)]
    blocks = triangular_blocks([[not x.is_zero for x in row] for row in matrix])
    assert blocks is not None
    solution = BlockwiseSolution(graph, matrix, blocks, lambda x: x)
    names = {f"a{i}{j}" for i in range(size) for j in range(size)} | {f"b{i}" for i in range(size)}
    values = {name: dice.uniform(0.5, 2) * dice.choice((-1, 1)) for name in sorted(names)}
    marks = [[(f"a{i}{j}", mark) for j, mark in enumerate(row)] for i, row in enumerate(pattern)]
    a = np.array([[values[name] if mark == "x" else 0.0 for name, mark in row] for row in marks])
    exact = np.linalg.solve(a, [values[f"b{i}"] for i in range(size)])
    computed = Evaluator(solution.solve(right))(values)
    assert np.allclose(computed, exact, rtol=1e-9, atol=1e-9)
    # the denominators vanish with the determinant of the whole, and with nothing else
    guards = solution.guards(Status.TASK_RANK, ())
    denominators = Evaluator([guard.denominator for guard in guards])(values)
    product = np.prod([abs(x) ** (1 / guard.degree) for guard, x in zip(guards, denominators, strict=True)])
    assert product == pytest.approx(abs(np.linalg.det(a)), rel=1e-9)


def test_rows_are_added_where_that_leaves_fewer_entries() -> None:
    """Two legs that are closed on a third whose tip is given: each leg by itself."""
    graph = Graph()
    a, b, c = (graph.symbol(name) for name in "abc")
    zero = graph.zero
    rows = SparserRows(((a, -b, zero), (-a, zero, c), (a, zero, zero)))
    assert [[not x.is_zero for x in row] for row in rows.matrix] == [
        [False, True, False], [False, False, True], [True, False, False],
    ]  # fmt: skip
    x, y, z = (graph.symbol(name) for name in "xyz")
    assert rows.of((x, y, z)) == [x - z, y + z, z]


def test_rows_that_have_nothing_to_give_stay() -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    matrix = ((a, b), (b, a))
    rows = SparserRows(matrix)
    assert rows.matrix == matrix
    assert rows.of((graph.one, graph.zero)) == [graph.one, graph.zero]


def plain(graph_values: dict[str, float], rows: Matrix) -> np.ndarray:
    entries = Evaluator([x for row in rows for x in row])(graph_values)
    return np.array(entries).reshape(len(rows), -1)


def test_rows_of_numbers_are_solved_first() -> None:
    """A hand that a row keeps level: nothing of it is left in the others, and all unknowns come back."""
    graph = Graph()
    b, c, d = (graph.symbol(name) for name in "bcd")
    one, zero = graph.one, graph.zero
    tip = graph.trig("sin", b + c + d)
    arm = [-graph.trig("sin", b) - graph.trig("sin", b + c), -graph.trig("sin", b + c), zero]
    lift = [graph.trig("cos", b) + graph.trig("cos", b + c), graph.trig("cos", b + c), zero]
    matrix = ((one, one, one), tuple(x - tip for x in arm), tuple(x + 3 * tip for x in lift))
    rows = ConstantRows(matrix)
    assert len(rows.matrix) == 2
    assert not any(tip in reached([x]) for row in rows.matrix for x in row)
    right = [graph.symbol(f"r{k}") for k in range(3)]
    values = {"b": 0.7, "c": -1.1, "d": 0.9, "r0": 0.3, "r1": -0.4, "r2": 0.8}
    left = np.linalg.solve(plain(values, rows.matrix), Evaluator(rows.of(right))(values))
    solution = Evaluator(rows.completed([graph.const(Fraction(float(x))) for x in left], right))(values)
    assert np.allclose(plain(values, matrix) @ solution, [0.3, -0.4, 0.8], atol=1e-14)
    assert np.allclose(Evaluator(rows.kept([graph.const(Fraction(float(x))) for x in solution]))(values), left, atol=0)


@pytest.mark.parametrize("side", [1, -1])
def test_rows_that_an_angle_turns_are_taken_in_its_axes(side: int) -> None:
    """A tip beside its column: across the arm the column alone moves it."""
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    c, s = graph.trig("cos", a), graph.trig("sin", a) * side
    reach, slope, beside = graph.trig("cos", b) + 2, -graph.trig("sin", b), graph.const(Fraction(1, 5))
    x = (side * (-reach * s - beside * c), slope * c)
    y = (side * (reach * c - beside * s), slope * s)
    rows = TurnedRows(graph, (x, y), (a, b))
    assert [[not entry.is_zero for entry in row] for row in rows.matrix] == [[True, True], [True, False]]
    assert not any(a in reached([entry]) for row in rows.matrix for entry in row)
    values = {"a": 0.6, "b": 1.9, "p": 0.3, "q": -0.7}
    p, q = graph.symbol("p"), graph.symbol("q")
    turn = np.array([[np.cos(0.6), side * np.sin(0.6)], [-side * np.sin(0.6), np.cos(0.6)]])
    assert np.allclose(plain(values, rows.matrix), turn @ plain(values, (x, y)), atol=1e-15)
    assert np.allclose(Evaluator(rows.of((p, q)))(values), turn @ [0.3, -0.7], atol=1e-15)


def test_rows_in_which_the_angle_stays_are_not_turned() -> None:
    graph = Graph()
    a = graph.symbol("a")
    matrix = ((graph.trig("cos", a), graph.trig("sin", 2 * a)), (graph.trig("sin", a), graph.one))
    rows = TurnedRows(graph, matrix, (a,))
    assert rows.matrix == matrix
    assert rows.of((graph.one, graph.zero)) == [graph.one, graph.zero]


def test_combinations_keep_what_rows_say() -> None:
    dice, graph = random.Random(3), Graph()
    entries = [[graph.const(Fraction(dice.randint(-1, 1))) for _ in range(6)] for _ in range(6)]
    rows = SparserRows(tuple(map(tuple, entries)))
    plain = np.array([[float(x.constant or 0) for x in row] for row in entries])
    made = np.array([[float(x.constant or 0) for x in row] for row in rows.matrix])
    assert (made != 0).sum() < (plain != 0).sum()
    assert abs(np.linalg.det(made)) == pytest.approx(abs(np.linalg.det(plain)))
    right = [graph.const(Fraction(k)) for k in (1, 2, 3, 5, 7, 11)]
    combined = [float(x.constant or 0) for x in rows.of(right)]
    assert np.allclose(np.linalg.lstsq(plain, [1, 2, 3, 5, 7, 11], rcond=None)[0],
                       np.linalg.lstsq(made, combined, rcond=None)[0])  # fmt: skip
