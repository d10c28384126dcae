"""Singular sets as determinants, held against the determinants of rows stacked on B, at random configurations."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from math import prod
from pathlib import Path

import mpmath
import pytest
import sympy
from mpmath import mp
from sympy import Integer, Symbol

from symgen.closedform.algebra.matrices import transpose
from symgen.closedform.algebra.quotient import Matrix
from symgen.closedform.forms import ClosedForms, derive_closed_forms
from symgen.closedform.laws.determinants import BlockDeterminant, determinant_blocks, unit_rows
from symgen.closedform.laws.singular_sets import DeterminantSet, derive_determinant_sets
from symgen.closedform.points import RingPoint, generic_points
from symgen.closedform.spelling import Speller
from symgen.model.load import load_model, load_text

MODELS = Path(__file__).parents[2] / "models"
LONG = ("delta", "gough_stewart", "three_rrr")


@cache
def shipped(name: str) -> tuple[ClosedForms, dict[str, DeterminantSet]]:
    forms = derive_closed_forms(load_model(MODELS / f"{name}.yaml"))
    return forms, {one.kind: one for one in derive_determinant_sets(forms)}


def given(forms: ClosedForms, kind: str) -> Matrix:
    """The rows whose velocities are to determine all others."""
    exact = forms.exact
    rows = {
        "input": lambda: transpose(exact.mechanics.control),
        "measured": lambda: unit_rows(exact, tuple(exact.model.measured_places)),
        "task": lambda: exact.mechanics.task_jacobian,
    }
    return rows[kind]()


def substituted(forms: ClosedForms, point: RingPoint) -> dict[Symbol, sympy.Float]:
    values = {Symbol(name): sympy.Float(value, 50) for name, value in point.values.items()}
    for i, row in enumerate(point.matrix(forms.exact.mechanics.jacobian)):
        values |= {Symbol(f"B[{i + 1},{j + 1}]"): sympy.Float(entry, 50) for j, entry in enumerate(row)}
    return values


def value(block: BlockDeterminant, values: dict[Symbol, sympy.Float]) -> mpmath.mpf:
    entries = [[mp.mpf(str(e.evalf(45, subs=values))) for e in row] for row in block.matrix.tolist()]
    return mpmath.det(mpmath.matrix(entries))


def difference(forms: ClosedForms, kind: str, blocks: Sequence[BlockDeterminant], point: RingPoint) -> mpmath.mpf:
    """How far the product of the blocks is from |det [X; B]|, relative to that."""
    rows = (*given(forms, kind), *forms.exact.mechanics.jacobian)
    whole = abs(mpmath.det(mpmath.matrix(point.matrix(rows))))
    values = substituted(forms, point)
    return abs(abs(prod(value(block, values) for block in blocks)) - whole) / whole


def blocks_of(forms: ClosedForms, kind: str) -> tuple[BlockDeterminant, ...]:
    blocks = determinant_blocks(forms.exact, Speller(forms.exact.ring), given(forms, kind))
    assert blocks is not None
    return blocks


CASES = [("delta", kind) for kind in ("input", "measured", "task")]
CASES += [("gough_stewart", "input"), ("three_rrr", "input")]


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_blocks_multiply_to_the_determinant(name: str, kind: str) -> None:
    mp.dps = 50
    forms, sets = shipped(name)
    blocks = blocks_of(forms, kind)
    ((printed,),) = (one.products for one in (sets[kind],))
    assert set(printed) <= set(blocks)
    assert all(block.zero == Integer(1) for block in set(blocks) - set(printed))
    exact = forms.exact
    for point in generic_points(exact.model, exact.mechanics, 3, on_constraints=False):
        assert difference(forms, kind, blocks, point) < 1e-30


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_a_wrong_entry_is_noticed(name: str, kind: str) -> None:
    mp.dps = 50
    forms, sets = shipped(name)
    (point,) = generic_points(forms.exact.model, forms.exact.mechanics, 1, on_constraints=False)
    blocks = list(blocks_of(forms, kind))
    place = blocks.index(max(sets[kind].products[0], key=lambda block: block.matrix.rows))
    matrix = blocks[place].matrix.as_mutable()
    matrix[0, 0] += matrix[0, 0]
    blocks[place] = replace(blocks[place], matrix=matrix.as_immutable())
    assert difference(forms, kind, blocks, point) > 1e-6


def nearest_zero(zero: sympy.Expr, values: dict[Symbol, sympy.Float], name: Symbol) -> mpmath.mpf:
    """A root of an expression in one of its names, all others at a point."""
    others = {symbol: number for symbol, number in values.items() if symbol != name}
    return mpmath.findroot(sympy.lambdify(name, zero.subs(others), "mpmath"), mp.mpf("0.4"))


@pytest.mark.parametrize("name", LONG)
def test_short_factors_vanish_with_their_determinants(name: str) -> None:
    mp.dps = 50
    forms, sets = shipped(name)
    exact = forms.exact
    (point,) = generic_points(exact.model, exact.mechanics, 1, on_constraints=False)
    values = substituted(forms, point)
    configuration = {c.name for c in exact.model.coordinates}
    for block in {b for one in sets.values() for product in one.products for b in product if b.zero is not None}:
        assert abs(value(block, values)) > 1e-6
        coordinate = sorted(block.zero.free_symbols & set(map(Symbol, configuration)), key=str)[0]
        root = nearest_zero(block.zero, values, coordinate)
        there = RingPoint(exact.mechanics, {**point.values, str(coordinate): root})
        assert abs(value(block, substituted(forms, there))) < 1e-30


def test_rank_drops_only_where_the_determinants_of_columns_vanish() -> None:
    """Some of these are the products of the other sets, and that of the columns that legs have for themselves."""
    _, sets = shipped("delta")
    own, platform = sets["constraint"].products
    assert [block.matrix.shape for block in own] == [(1, 1)] * 3
    assert (platform,) == sets["input"].products
    assert own == sets["task"].products[0]


def test_rows_that_share_a_column_are_one() -> None:
    """The platform on three legs of two bars: three forces along the outer bars have no moment, or no common plane."""
    _, sets = shipped("three_rrr")
    ((block,),) = sets["input"].products
    assert block.matrix.shape == (3, 3)
    assert {str(name) for name in block.matrix.free_symbols} == {"a_1", "a_2", "a_3", "b_1", "b_2", "b_3", "phi", "r"}


FREE = """
model: free
coordinates: {a: {unit: rad, range: [-1, 1]}, x: {unit: m, range: [-1, 1]}, y: {unit: m, range: [-1, 1]}}
parameters: {m: {value: 2, unit: kg}, J: {value: 1, unit: kg*m**2}, l: {value: 1, unit: m}}
kinetic_energy: J*a_dot**2 + m*x_dot**2 + m*y_dot**2
potential_energy: 0
constraints:
  nonholonomic:
    first: 3*x_dot + l*sin(a)*a_dot
inputs: {u: {unit: N*m, acts_on: {a: 1}}, v: {unit: N, acts_on: {y: 1}}}
"""


def test_a_determinant_that_never_vanishes_says_so() -> None:
    forms = derive_closed_forms(load_text(FREE, "free.yaml"))
    sets = derive_determinant_sets(replace(forms, singular_sets=()))
    assert [(one.kind, one.empty) for one in sets] == [("constraint", True), ("input", True)]
