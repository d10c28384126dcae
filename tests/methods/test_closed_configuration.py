"""Configurations in closed form: the rows that are solved so, and that what is solved is the row."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from mpmath import mp, mpf

from symgen.ir.kernel import Status
from symgen.mechanics.system import System
from symgen.methods.given.closed import closed_configuration
from symgen.methods.given.functions import task
from symgen.methods.given.row_solution import solvable_row, solved
from symgen.model.load import load_text
from symgen.symbolic.arcs import turn_of
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

BASE = """
model: m
coordinates: {{{coordinates}}}
parameters: {{l: {{value: 0.7}}, k: {{value: 0.4}}}}
kinetic_energy: {energy}/2
task: {{{task}}}
"""


def made(task_of: str, coordinates: str = "a b") -> bool:
    """Whether the configuration with a task is found in closed form."""
    names = coordinates.split()
    text = BASE.format(
        coordinates=", ".join(f"{name}: {{unit: rad}}" for name in names),
        energy="(" + " + ".join(f"{name}_dot**2" for name in names) + ")",
        task=task_of,
    )
    mechanics = System(load_text(text, "m.yaml"))
    return closed_configuration(mechanics, task(mechanics)) is not None


@pytest.mark.parametrize(
    "task_of",
    [
        "x: l*cos(a) + k*cos(b), y: l*sin(a) + k*sin(b)",  # two links by their own angles
        "x: l*cos(a) + k*cos(a + b), y: l*sin(a) + k*sin(a + b)",  # by relative ones
        "x: l*cos(a) - k*cos(b - a), y: l*sin(a) + k*sin(b - a)",  # the second the other way round
        "x: cos(a)*(b + l) - k*sin(a), y: sin(a)*(b + l) + k*cos(a)",  # a slide on a link
        "x: l*sin(a) + b, y: l*cos(a) + k",  # an angle, then a slide
        "x: a, y: k*cos(b - a)",
    ],
)
def test_chains_of_two_are_solved_in_closed_form(task_of: str) -> None:
    assert made(task_of)


COLUMN = "x: ({0})*cos(a), y: ({0})*sin(a), z: l*sin(b) + k*sin({1})"


@pytest.mark.parametrize(
    ("task_of", "coordinates"),
    [
        (COLUMN.format("l*cos(b) + k*cos(c)", "c"), "a b c"),  # two links on a column
        (COLUMN.format("0.1 + l*cos(b) + k*cos(b - c)", "b - c"), "a b c"),  # by relative angles, with an offset
        (COLUMN.format("l*cos(b) + k*cos(c)", "c") + ", gear: b - 2*d", "a b c d"),  # with a gear behind
        ("x: (l*cos(b) + k*cos(c))*cos(a) - 0.1*sin(a), y: (l*cos(b) + k*cos(c))*sin(a) + 0.1*cos(a),"
         " z: l*sin(b) + k*sin(c)", "a b c"),  # with a shoulder beside the column
        ("x: l*cos(a) + k*cos(b), y: l*sin(a) + k*sin(b), z: cos(a)*cos(b) + sin(c)", "a b c"),  # others wait for both
        ("x: l*cos(a) + k*cos(b) + cos(c), y: l*sin(a) + k*sin(b) + sin(c), turn: c", "a b c"),  # a hand's own angle
        ("x: l*cos(a) + k*cos(a + b) + cos(a + b + c), y: l*sin(a) + k*sin(a + b) + sin(a + b + c), turn: a + b + c",
         "a b c"),  # by relative angles
        ("x: l*cos(a) + k*cos(b) + cos(c), y: l*sin(a) + k*sin(b) + sin(c), turn: c - b - a", "a b c"),
    ],
)  # fmt: skip
def test_arms_of_more_joints_fall_into_such_chains(task_of: str, coordinates: str) -> None:
    assert made(task_of, coordinates)


@pytest.mark.parametrize(
    ("task_of", "coordinates"),
    [
        ("x: cos(2*a), y: b", "a b"),
        ("x: a*a*a, y: b", "a b"),
        ("x: exp(a), y: b", "a b"),
        ("x: a + b, y: a - 2*cos(b)", "a b"),
        ("x: (l*cos(b) - d)*cos(a), y: (l*cos(b) - d)*sin(a), z: l*sin(b) + k*d, gear: b - 2*d", "a b d"),
        ("x: l*cos(a) + k*cos(b), y: l*sin(a) + k*sin(2*b)", "a b"),
        ("x: cos(a) + cos(b), y: sin(a) + sin(b), z: cos(c) + a*c", "a b c"),
        ("x: cos(a) + cos(b) + cos(c), y: sin(a) + sin(b) + sin(c), z: cos(a + b + c)", "a b c"),
        ("x: cos(a), y: b, z: a + b", "a b"),
    ],
)
def test_what_is_of_no_such_form_is_left_to_newton(task_of: str, coordinates: str) -> None:
    assert not made(task_of, coordinates)


@pytest.mark.parametrize("number", ["-1", "-0.9", "-1e-3", "1e-300", "0", "0.01", "0.3", "0.7071", "1"])
def test_an_arc_is_an_arctangent_to_all_digits(number: str) -> None:
    graph = Graph()
    value = Evaluator([turn_of(graph, graph.symbol("t"))])({"t": float(number)})[0]
    with mp.workdps(40):
        exact = 2 * mp.atan(mpf(float(number)))
        assert abs(value - exact) <= 4 * mpf(2) ** -53 * abs(exact)


def test_the_series_leaves_out_less_than_rounding_does() -> None:
    """In exact arithmetic: relative errors of the sum alone, over the whole range."""
    graph = Graph()
    turn = turn_of(graph, graph.symbol("t"))
    with mp.workdps(60):
        worst = max(abs(_exactly(turn, mpf(k) / 64) / (2 * mp.atan(mpf(k) / 64)) - 1) for k in range(1, 65))
        assert worst < mpf(2) ** -59


def _exactly(turn: Scalar, t: mpf) -> mpf:
    known: dict[Scalar, mpf] = {}
    for node in topological([turn]):
        args = [known[x] for x in node.args]
        match node.op:
            case "const":
                number = node.constant
                assert isinstance(number, Fraction)
                known[node] = mpf(number.numerator) / number.denominator
            case "symbol":
                known[node] = t
            case "add":
                known[node] = args[0] + args[1]
            case "sub":
                known[node] = args[0] - args[1]
            case "mul":
                known[node] = args[0] * args[1]
            case "div":
                known[node] = args[0] / args[1]
            case "neg":
                known[node] = -args[0]
            case "sqrt":
                known[node] = mp.sqrt(args[0])
            case op:
                raise AssertionError(op)
    return known[turn]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("form", ["linear", "quadratic", "angle"])
def test_the_root_on_the_side_of_the_start_is_found(form: str, side: int) -> None:
    graph = Graph()
    x, c = graph.symbol("x"), graph.symbol("c")
    functions = {
        "linear": 3 * x - c,
        "quadratic": (x - 1) * (x - 1) - c,
        "angle": 2 * graph.trig("cos", x) + graph.trig("sin", x) - c,
    }
    row = solvable_row(graph, functions[form], x)
    assert row is not None
    assert row.form == form
    one = solved(graph, row, row.scalars, row.scalars, Status.TASK_RANK)
    middle = {"linear": 0.0, "quadratic": 1.0, "angle": math.atan2(1, 2)}[form]
    exact = {"linear": 0.5, "quadratic": math.sqrt(1.5), "angle": math.acos(1.5 / math.sqrt(5))}[form]
    exact = exact if form == "linear" else middle + side * exact
    root = exact + side * 0.2 + Evaluator([one.change])({"x": exact + side * 0.2, "c": 1.5})[0]
    assert root == pytest.approx(exact, abs=4e-16)
