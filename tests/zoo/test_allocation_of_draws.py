"""Weights, preloads and limits of the witness, against conditions that define them."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symgen.laboratory.zoo.witness.allocation import directed, members, preloads
from symgen.laboratory.zoo.witness.kkt import EquationValues, inverse_dynamics, split
from symgen.laboratory.zoo.witness.limits import NoInputsError, nearest_within
from symgen.laboratory.zoo.witness.numbers.fields import Balls, precision
from symgen.laboratory.zoo.witness.numbers.linear import determinant, transposed

# one mass, driven by three forces along it
AT = EquationValues([[2.0]], [], [[1.0, 2.0, -1.0]], [0.5], [], [])
PAIR = EquationValues([[2.0]], [], [[1.0, 1.0]], [0.0], [], [])
LOAD = 2.0 * 3.0 + 0.5


def test_members_stand_in_the_order_of_the_documentation() -> None:
    block = {"limits": {"a": ["-1", "2"]}, "preload": "3", "weights": {"b": "4"}}
    assert list(members(block, float).items()) == [
        ("weight_b", 4), ("preload", 3), ("limit_a_lower", -1), ("limit_a_upper", 2),
    ]  # fmt: skip


def test_inputs_are_the_nearest_to_their_preloads() -> None:
    near = preloads(("a", "b", "c"), {"preload": {"b": "5"}}, {"preload_b": 5.0}, 0.0)
    weights = [1.0, 3.0, 0.5]
    u, _ = inverse_dynamics(AT, split(AT, 0, 1.0), [3.0], 1, weights, near)
    assert abs(u[0] + 2 * u[1] - u[2] - LOAD) < 1e-12
    # W (u - near) is along the row
    along = [weight * (x - y) for weight, x, y in zip(weights, u, near or (), strict=True)]
    assert abs(along[1] - 2 * along[0]) < 1e-12
    assert abs(along[2] + along[0]) < 1e-12


def test_limits_move_the_internal_force_as_little_as_they_must() -> None:
    names = ("a", "b")

    def shared(limits: dict[str, tuple[float, float]], preload: float) -> list[float]:
        ends = {
            f"limit_{k}_{end}": x for k, pair in limits.items() for end, x in zip(("lower", "upper"), pair, strict=True)
        }
        block = {"preload": "p", "limits": dict.fromkeys(limits, ("", ""))}
        inputs = directed(PAIR, [3.0, 3.0], names, block, {"preload": preload, **ends}, 1.0)
        return [round(float(x), 12) for x in inputs]

    root = 2**0.5
    assert shared({}, 2 * root) == [5, 1]
    assert shared({"a": (-9, 4)}, 2 * root) == [4, 2]
    assert shared({"a": (-9, 4), "b": (2.5, 9)}, 2 * root) == [3.5, 2.5]
    # no share of 6 keeps both at or below 2: from the least excess of one to that of the other all are as good
    assert shared({"a": (0, 2), "b": (0, 2)}, 0.0) == [3, 3]
    assert shared({"a": (0, 2), "b": (0, 2)}, 9 * root) == [4, 2]


def test_determinants_of_columns_that_depend_are_nothing_in_balls() -> None:
    """An input that works against constraints alone: its column follows from those of rows, none of them the last."""
    with precision():
        root = Balls().number(Fraction(2)) ** 0.5
        first, second, third = [root, 1 / root, root / 3], [root / 7, root, 1 / root], [1 / root, root / 5, root]
        columns = [first, [3 * a - b / root for a, b in zip(first, second, strict=True)], second]
        assert abs(determinant(transposed(columns, 3))) < 1e-60
        regular = determinant(transposed([second, third, first], 3))
        cyclic = determinant(transposed([first, second, third], 3))
        assert abs(regular - cyclic) < 1e-60 < abs(regular)
        swapped = determinant(transposed([second, first, third], 3))
        assert abs(regular + swapped) < 1e-60


def test_limits_of_several_are_kept_by_the_nearest_inputs_or_by_none() -> None:
    """u_1 + 2 u_2 - u_3 is given: the nearest to 0 with u_2 at most 2 share the rest evenly."""
    with precision():
        least, _ = inverse_dynamics(AT, split(AT, 0, 1.0), [3.0], 1)
        row = [[1.0, 2.0, -1.0]]
        one = Balls().number(Fraction(1))
        u = nearest_within(row, least, [one] * 3, [(1, -one, 2 * one)], 2)
        assert [round(float(x), 12) for x in u] == [1.25, 2, -1.25]
        # with a weight of 4 the first one takes a fifth of what the third one takes with it
        u = nearest_within(row, least, [4 * one, one, one], [(1, -one, 2 * one)], 2)
        assert round(float(u[1]), 12) == 2
        assert round(float(u[0] - u[2]), 12) == 2.5
        with pytest.raises(NoInputsError):
            nearest_within(row, least, [one] * 3, [(k, -one, one) for k in range(3)], 2)
