"""The worth of what a system does not need: counted, never negative where a finding is certain, told in a table."""

from __future__ import annotations

import pytest
import shipped

from symgen.laboratory.bench.tuning.skipping import BY_MINORS, page, skipped

# Vectors and matrices are derived along different ways; one may share a product that the other does not.
CERTAIN = (
    "coordinates no constraint touches",
    "zeros of B and M",
    "constants of B and M",
    "forces that vanish",
    "m = δ",
)


@pytest.mark.parametrize("name", ["skate", "front_car", "slider_crank"])
def test_keeping_something_never_costs_less(name: str) -> None:
    counts = skipped(shipped.model(name))
    assert counts.minor is not None
    assert counts.generated <= counts.minor
    kept = {one.what: one for one in counts.kept}
    for what in CERTAIN:
        weight = kept[what].weight
        assert weight is None or weight >= kept[what].without, what
    for what in ("zeros of B and M", "zeros of G and C"):
        assert (kept[what].weight or 0) > kept[what].without


def test_body_fixed_axes_save_a_third_of_the_parallel_robot() -> None:
    counts = skipped(shipped.model("rapkm_2rrr_rr"))
    (axes,) = [one for one in counts.kept if one.what == "body-fixed axes"]
    assert axes.weight is not None
    assert axes.without < 0.7 * axes.weight


def test_what_a_model_does_not_have_is_left_out() -> None:
    kept = {one.what: one.weight for one in skipped(shipped.model("slider_crank")).kept}
    assert kept["coordinates no constraint touches"] is None
    assert {one.what: one.weight for one in skipped(shipped.model("skate")).kept}["sines by addition"] is None


def test_the_page_has_a_row_for_each_model() -> None:
    rows = [skipped(shipped.model(name)) for name in ("skate", "slider_crank")]
    lines = page(rows).split("\n")
    table = [line for line in lines if line.startswith("| ")]
    assert [line.split(" | ")[0] for line in table] == ["| model", "| ---", "| skate", "| slider_crank"]
    assert {line.count("|") for line in table} == {3 + len(rows[0].kept) + 1}


@pytest.mark.bench
def test_what_would_be_too_long_is_told_and_not_derived() -> None:
    kept = {one.what: str(one) for one in skipped(shipped.model("chain16")).kept}
    assert kept["zeros of B and M"] == "too long"
    assert kept["coordinates no constraint touches"] == "–"


@pytest.mark.bench
def test_minors_of_many_rows_are_not_listed() -> None:
    counts = skipped(shipped.model("gough_loops"))
    assert counts.minor is None
    assert [str(one) for one in counts.kept[:-1]] == ["too long"] * len(BY_MINORS)
    assert [one.what for one in skipped(shipped.model("skate")).kept[:-1]] == list(BY_MINORS)
