"""What the file leaves open is filled in as documented."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from symgen.model.expressions.expression import Name, Number
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.model.published import PublishedEquations, PublishedMatrix, PublishedSingularSet

TEXT = """\
model: thing
coordinates:
  x: {unit: m, range: [-2, 2.5]}
  a: {unit: rad}
  b:
  c: {}
parameters:
  m: 2
  l: {value: m/4, range: [0.1, 1]}
definitions:
  turned: a + b
kinetic_energy: m/2*(x_dot**2 + c_dot**2) + m*l**2/2*(a_dot**2 + b_dot**2)
potential_energy: m*l*cos(turned) + c*x
constraints:
  nonholonomic: {roll: x_dot - l*a_dot}
  geometric: {hold: x - c}
"""


def load(extra: str = "") -> Model:
    """The thing, with further blocks."""
    return load_text(TEXT + extra, "thing.yaml")


def test_geometric_constraints_come_first() -> None:
    assert [(row.name, row.kind) for row in load().constraints] == [("hold", "geometric"), ("roll", "nonholonomic")]


def test_angles_by_unit_or_by_use() -> None:
    assert [coordinate.is_angle for coordinate in load().coordinates] == [False, True, True, False]


def test_ranges() -> None:
    x, a, b, c = load("ranges: {x_dot: [-pi, 3], a_ddot: [-7, 7], m: [1, 3]}\n").coordinates
    turn = (Fraction(-math.pi), Fraction(math.pi))
    assert x.range == (-2, Fraction(5, 2))
    assert (a.range, b.range) == (turn, turn)
    assert c.range == (-1, 1)
    assert x.rate_range == (Fraction(-math.pi), 3)
    assert a.rate_range == (-1, 1)
    assert a.acceleration_range == (-7, 7)


def test_range_ends_are_doubles() -> None:
    model = load("ranges: {x_ddot: [-0.1, 0.1]}\n")
    assert model.coordinates[0].acceleration_range == (Fraction(-0.1), Fraction(0.1))


def test_parameters() -> None:
    m, length = load("ranges: {m: [1, 3]}\n").parameters
    assert m.value == Number(Fraction(2))
    assert m.range == (1, 3)
    assert length.range == (Fraction(0.1), 1)
    assert load().parameters[0].range is None


@pytest.mark.parametrize(
    ("extra", "outputs"),
    [
        ("", ("forward_dynamics",)),
        ("inputs: {u: {acts_on: {b: 1}}}\n", ("inverse_dynamics",)),
        ("outputs: all\n", ("all",)),
        ("outputs: [energy, all]\n", ("all", "energy")),
        ("outputs: energy\n", ("energy",)),
        ("outputs: [energy, mass_matrix, energy]\n", ("energy", "mass_matrix")),
    ],
)
def test_outputs(extra: str, outputs: tuple[str, ...]) -> None:
    assert load(extra).outputs == outputs


def test_outputs_in_one_call_are_made_by_themselves_too() -> None:
    model = load("outputs: [energy, {together: [mass_matrix, energy, mass_matrix]}, {together: [energy, energy]}]\n")
    assert model.outputs == ("energy", "mass_matrix")
    assert model.together == (("mass_matrix", "energy"),)
    assert load("outputs: [energy, all]\n").together == ()


def test_configuration_and_tolerances_are_exact() -> None:
    model = load("configuration: {x: 0.1, a: -1/3}\ntolerances: {constraint_rank: 1e-9}\n")
    assert model.configuration == (("x", Fraction(1, 10)), ("a", Fraction(-1, 3)))
    assert model.constraint_rank_tolerance == Fraction(1, 10**9)
    assert model.actuation_rank_tolerance is None


def test_published_forms() -> None:
    model = load(
        """\
inputs: {u: {acts_on: {b: 1}}}
published:
  - {equation: "(1)", quantity: potential_force, where: {s: sin(turned)}, value: [0, -m*l*s, -m*l*s, 0]}
  - {equation: "(2)", equations: [{left: b_ddot, right: u + multiplier_roll}]}
  - {equation: "(3)", singular_set: {quantity: orthogonal_complement, where_zero: cos(a), independent: [a, b]}}
"""
    )
    column, equations, singular = model.published
    assert isinstance(column, PublishedMatrix)
    assert [len(row) for row in column.value] == [1, 1, 1, 1]
    assert column.where[0][0] == "s"
    assert isinstance(equations, PublishedEquations)
    assert equations.equations[0][0] == Name("b_ddot")
    assert isinstance(singular, PublishedSingularSet)
    assert singular.independent == ("a", "b")


def test_paths() -> None:
    path = load(
        """\
paths:
  p:
    duration: 3/2
    definitions: {s: t**2*(3 - 2*t)}
    conditions: {first: a - s, second: b + s, third: x - l*a}
    start: {x: 0.5}
"""
    ).paths[0]
    assert (path.duration, path.samples) == (Fraction(3, 2), 201)
    assert [name for name, _ in path.conditions] == ["first", "second", "third"]
    assert path.start == (("x", Fraction(1, 2)),)


def test_description_on_one_line() -> None:
    assert load("description: |\n  two\n  lines\n").description == "two lines"


def test_the_hash_is_that_of_the_text() -> None:
    assert load().text_hash != load("report: short\n").text_hash
    assert load().text_hash == load().text_hash
