"""What tuned constants change: each has a name and a sentence, and half or twice of it is what a process works with."""

from __future__ import annotations

import re
from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest

from symgen.laboratory.bench.tuning.altered import DOUBLE, HALF
from symgen.laboratory.bench.tuning.constants import measured
from symgen.laboratory.bench.tuning.tuned import NUMERICAL, Constant, tuned
from symgen.laboratory.bench.tuning.varied import Key, Varied

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/constants.md"


def test_each_says_what_it_limits_and_has_a_name_of_its_own() -> None:
    constants = tuned()
    assert [one.key for one in constants if not one.limits.endswith(".")] == []
    assert [name for name, count in Counter(one.name for one in constants).items() if count > 1] == []
    assert {one.name for one in constants if one.numerical} == NUMERICAL


def test_the_page_is_of_the_constants_there_are() -> None:
    rows = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    shown = {tuple(cell.strip() for cell in row.split(" | ")[:3]) for row in rows}
    named = {(f"| `{one.module.removeprefix('symgen.')}` `{one.name}`", one.value, one.limits) for one in tuned()}
    assert {(name, value, limits.removesuffix(" |")) for name, value, limits in shown} == named


def test_the_page_is_of_every_shipped_model() -> None:
    derived = re.search(r"\((\d+) models, (\d+) kernels\)", PAGE.read_text(encoding="utf-8"))
    assert derived is not None
    assert int(derived[1]) == len(list((ROOT / "models").glob("*.yaml")))
    assert int(derived[2]) > 10 * int(derived[1])


def _varied(value: int | Fraction, noticed: set[Key]) -> Varied:
    return Varied(value, {("X", HALF): value / 2, ("X", DOUBLE): value * 2}, noticed)


def test_a_decision_is_noticed_where_another_value_decides_otherwise() -> None:
    noticed: set[Key] = set()
    limit = _varied(8, noticed)
    assert 3 < limit < 17
    assert noticed == set()
    assert limit < 12
    assert noticed == {("X", DOUBLE)}
    noticed.clear()
    assert 10 * (1 + _varied(Fraction(1, 4), noticed)) > 12  # 11.25 with half
    assert noticed == {("X", HALF)}


def test_what_cannot_be_followed_counts_as_noticed() -> None:
    noticed: set[Key] = set()
    assert len(range(_varied(4, noticed))) == 4
    assert noticed == {("X", HALF), ("X", DOUBLE)}


@pytest.mark.bench
def test_half_and_twice_of_a_constant_that_decides_make_other_kernels() -> None:
    (one,) = (one for one in tuned() if one.name == "LARGEST_CORE_BY_MINORS")
    measurements = measured([one], [ROOT / "models/delta.yaml"])
    assert {change.how for change in measurements.changes} == {HALF, DOUBLE}
    assert not any(change.idle or change.failed for change in measurements.changes)
    assert measurements.constants == [Constant(one.module, one.name, "3", one.limits)]
