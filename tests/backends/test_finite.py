"""The test that all results are finite, made factor by factor: NaN exactly when a result is no finite number."""

from __future__ import annotations

import math
import re

import pytest

from symgen.backends.c.bodies.finite import FiniteTest


def run(lines: list[str], values: dict[str, float]) -> float:
    """`rest` after the lines, which are `[double] target op expression;` with one operation."""
    known = dict(values)
    for line in lines:
        match = re.fullmatch(r"(?:double )?(\w+) ([*+]?=) (\w+)(?: - (\w+))?;", line)
        assert match, line
        target, operator, left, right = match.groups()
        # C would not compile a second declaration, nor a value that is none yet
        assert (target not in known) == line.startswith("double ")
        value = known[left] - known[right] if right else known[left]
        match operator:
            case "=":
                known[target] = value
            case "*=":
                known[target] *= value
            case _:
                known[target] += value
    return known["rest"]


def lines_of(count: int, waiting: int) -> list[str]:
    """The factors of results that are known in reverse order, but for the last `waiting` ones."""
    names = [f"y{k}" for k in range(count)]
    test = FiniteTest("double", names)
    lines = [line for name in [*reversed(names[waiting:]), "other"] for line in test.factor(name)]
    again = [line for name in names[waiting:] for line in test.factor(name)]
    assert not again
    return lines + test.remaining()


@pytest.mark.parametrize("count", range(1, 9))
def test_the_sum_is_nan_exactly_for_results_that_are_not_finite(count: int) -> None:
    for waiting in (0, 1, count):
        lines = lines_of(count, waiting)
        for place in range(-1, count):
            for bad in (math.inf, -math.inf, math.nan):
                point = {f"y{k}": (bad if k == place else 1e300 * (-1) ** k) for k in range(count)}
                total = run(lines, point)
                assert math.isnan(total) == (place >= 0)
                assert place >= 0 or total == 0


def test_each_result_takes_one_operation_but_the_first_of_a_term() -> None:
    for count in range(1, 9):
        terms = (count + 2) // 3
        assert sum(len(re.findall(r" - |\*=|\+=", line)) for line in lines_of(count, 0)) == count + terms - 1
