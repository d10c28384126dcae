"""Rows in units of their own are derived in ordinary ones; results are those of the rows of the file."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.row_units import BACK, in_ordinary_units
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

CRANE = """model: crane
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, d: {{unit: rad}}}}
parameters: {{l: {{value: 0.8}}, m: {{value: 3}}}}
kinetic_energy: m/2*(l**2*a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + l*a_dot*b_dot*cos(a - b))
constraints:
  geometric:
    reach: {first}*(l*cos(a) + 0.9*cos(b) - 1.2*cos(c))
    {second_row}
  nonholonomic:
    roll: {third}*(d_dot - 0.3*a_dot*cos(d))
inputs:
  u: {{acts_on: {{a: 1, b: sin(c)}}}}
outputs: all
configuration: {{a: 0.5, b: 0.2, c: 0.4, d: 0.1}}
"""
REACH, HEIGHT = "l*cos(a) + 0.9*cos(b) - 1.2*cos(c)", "l*sin(a) + 0.9*sin(b) - 1.2*sin(c) - 0.05"
INDEPENDENT = "height: {second}*(l*sin(a) + 0.9*sin(b) - 1.2*sin(c) - 0.05)"
AT = {"a": 0.51, "b": 0.18, "c": 0.43, "d": 0.12, "a_dot": 0.3, "b_dot": -0.2, "c_dot": 0.7, "d_dot": 0.4}


def _model(first: str, second: str, third: str) -> Model:
    row = INDEPENDENT.format(second=second)
    return load_text(CRANE.format(first=first, second_row=row, third=third), "crane.yaml")


def _values(model: Model, quantity: str) -> list[float]:
    (derived,) = derive_quantities(model, (quantity,)).quantities
    values = {"l": 0.8, "m": 3.0, "u": 1.7, **{f"{q}_ddot": 0.4 for q in "abcd"}, **AT}
    return Evaluator(list(derived.outputs))(values)


@pytest.mark.parametrize("quantity", sorted({*BACK, "inverse_dynamics", "forward_dynamics", "projected_configuration"}))
def test_quantities_are_those_of_the_rows_in_the_file(quantity: str) -> None:
    """Rows times f: g, B and B_dot are f times as large, B^+ and lambda 1/f, all else as it was."""
    factors = {"reach": 3e9, "height": 1e-7, "roll": 7e5}
    usual, scaled = _model("1", "1", "1"), _model("3e9", "1e-7", "7e5")
    assert in_ordinary_units(usual) is usual
    assert all(in_ordinary_units(scaled).row_units)
    plain, rescaled = _values(usual, quantity), _values(scaled, quantity)
    rows = list(factors.values())
    for entry, (x, y) in enumerate(zip(plain, rescaled, strict=True)):
        if quantity in ("constraint_residual", "multipliers"):
            row = rows[entry]
        elif "jacobian" in quantity:
            row = rows[entry * len(rows) // len(plain)]
        else:
            row = rows[entry % 3] if quantity in BACK else 1.0
        factor = 1 / row if "multipliers" in quantity or "pseudoinverse" in quantity else row
        assert y == pytest.approx(factor * x, rel=1e-12, abs=1e-14 * factor)


def test_products_of_rows_stay_in_the_range_of_float32() -> None:
    """Denominators of the smallest and largest rows: determinants of three rows 1e9 apart would be 1e42."""
    derived = derive_quantities(_model("3e9", "1e-7", "7e5"), ("projected_configuration",)).quantities[0]
    values = {"l": 0.8, "m": 3.0, **AT}
    sizes = Evaluator([guard.denominator for guard in derived.guards])(values)
    assert all(1e-12 < abs(size) < 1e12 for size in sizes)


def test_rows_that_are_sums_of_others_everywhere_have_factors_of_their_own() -> None:
    """The smallest multipliers are meant in the units of the file."""
    text = CRANE.format(first="1e8", second_row="again: 5e7*(l*cos(a) + 0.9*cos(b) - 1.2*cos(c))", third="1e7")
    model = in_ordinary_units(load_text(text, "crane.yaml"))
    assert all(Fraction(2) ** unit < Fraction(1, 1000) for unit in model.row_units)
    multipliers = _values(load_text(text, "crane.yaml"), "multipliers")
    assert multipliers[1] == pytest.approx(multipliers[0] / 2, rel=1e-12)


def test_rows_that_depend_on_each_other_on_the_constraints_alone_have_one_factor() -> None:
    """Two rows that are twice the same on V: y^T B = 0 for no numbers that hold beside it."""
    row = "again: 5e7*((l*cos(a) + 0.9*cos(b) - 1.2*cos(c))*(2 + l*cos(a) + 0.9*cos(b) - 1.2*cos(c)))"
    text = CRANE.format(first="1e8", second_row=row, third="1e7")
    model = in_ordinary_units(load_text(text, "crane.yaml"))
    assert model.row_units[0] == model.row_units[1] != model.row_units[2]
    assert all(Fraction(2) ** unit < Fraction(1, 1000) for unit in model.row_units)


def test_a_row_in_small_units_that_follows_from_an_ordinary_one_takes_what_is_its_own() -> None:
    """Its multiplier is a millionth of the other, with as many digits."""
    text = CRANE.format(first="1", second_row="again: 1e-6*(l*cos(a) + 0.9*cos(b) - 1.2*cos(c))", third="1")
    multipliers = _values(load_text(text, "crane.yaml"), "multipliers")
    assert multipliers[1] == pytest.approx(multipliers[0] * 1e-6, rel=1e-12)


@pytest.mark.parametrize("quantity", ["multipliers", "constraint_pseudoinverse", "weighted_pseudoinverse"])
def test_dependent_rows_of_which_one_is_next_to_nothing_have_the_smallest_multipliers(quantity: str) -> None:
    """Such rows keep factors of their own, and the smallest multipliers are meant in the units of the file."""
    rows = f"height: 1e-6*({HEIGHT})\n    again: 0.5*(1e6*({REACH})) + 1e-6*({HEIGHT})"
    scaled = load_text(CRANE.format(first="1e6", second_row=rows, third="1"), "crane.yaml")
    units = in_ordinary_units(scaled).row_units
    assert min(units) < -15 < 15 < max(units)
    made, plain = _values(scaled, quantity), _values(_model("1", "1", "1"), quantity)
    size = max(map(abs, made))
    for start in range(len(made) // 4):
        reach, height, again, roll = made[4 * start : 4 * start + 4]
        # 0.5 times the first row and the second are the third
        assert 0.5 * reach + height - again == pytest.approx(0.0, abs=1e-12 * size)
        alone = [1e6 * (reach + 0.5 * again), 1e-6 * (height + again), roll]
        assert alone == pytest.approx(plain[3 * start : 3 * start + 3], rel=1e-4)
