"""`all` has counted limits: beyond them the longest quantities are left out and told, and made where they are named."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from linkages import row_of_four_bars

from symgen.generation.results import Options
from symgen.model.load import load_text
from symgen.model.quantities import MAIN
from symgen.pipeline import generate
from symgen.quantities import everything
from symgen.quantities.everything import OF_ALL, most_with_twice_the_digits
from symgen.quantities.select import derive_quantities
from symgen.runtime.effort import SCALAR, done

TEXT = row_of_four_bars(1, ground="0.7", tail="configuration: {a0: 1, a1: 1, b1: 0}")
MODEL = load_text(TEXT, "row.yaml")


def test_the_longest_are_left_out_where_all_together_are_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = derive_quantities(MODEL, ("all",))
    costs = {choice.quantity: dict(choice.costs)[choice.title] for choice in whole.choices}
    most = sum(costs.values()) // 2
    monkeypatch.setattr(everything, "OPERATIONS_OF_ALL", most)
    short = derive_quantities(MODEL, ("all",))
    left_out = {name: why for name, why in short.absent if why.startswith(OF_ALL)}
    kept = {choice.quantity for choice in short.choices}
    assert {*costs} == kept | {*left_out}
    assert {derived.name for derived in short.quantities} == kept >= {*MAIN}
    assert sum(costs[name] for name in kept) <= most
    assert min(costs[name] for name in left_out) >= max(costs[name] for name in kept - {*MAIN})
    longest = max(left_out, key=lambda name: costs[name])
    assert str(costs[longest]) in left_out[longest]
    named = derive_quantities(MODEL, ("all", longest))
    assert longest in {derived.name for derived in named.quantities}


def test_what_takes_too_long_to_derive_is_given_up_unless_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(everything, "SCALARS_OF_A_METHOD", 20)
    monkeypatch.setattr(everything, "GROWTH", 2)
    short = derive_quantities(MODEL, ("all",))
    left_out = {name for name, why in short.absent if why.startswith(OF_ALL)}
    assert "projected_coriolis_matrix" in left_out
    assert {*MAIN} <= {derived.name for derived in short.quantities}
    named = derive_quantities(MODEL, ("projected_coriolis_matrix",))
    assert [derived.name for derived in named.quantities] == ["projected_coriolis_matrix"]
    assert not named.absent


def test_all_together_take_so_many_scalars_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    def taken(scalars: int) -> tuple[float, set[str], set[str]]:
        monkeypatch.setattr(everything, "SCALARS_OF_ALL", scalars)
        before = done()
        made = derive_quantities(MODEL, ("all",))
        left_out = {name for name, why in made.absent if "long to derive" in why}
        return done() - before, {choice.quantity for choice in made.choices}, left_out

    least, main, _ = taken(0)
    most, every, none = taken(10**9)
    assert not none
    assert {*MAIN} <= main < every
    some, kept, left_out = taken(int((most - least) / SCALAR) // 4)
    assert least < some < most
    assert main < kept < every
    assert left_out == every - kept


def test_what_loses_digits_is_limited_where_nobody_asks_for_it() -> None:
    def most(quantity: str, *outputs: str) -> float:
        return most_with_twice_the_digits(quantity, outputs, ())

    assert 0 < most("nullspace_projector", "all") < most("multipliers", "all") < math.inf
    assert most("nullspace_projector", "all", "nullspace_projector") == most("inverse_dynamics", "all") == math.inf


def test_what_all_leaves_out_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(everything, "OPERATIONS_OF_ALL", 1000)
    path = tmp_path / "row.yaml"
    path.write_text(TEXT)
    result = generate(path, Options(outputs=("all",), parts=("c",), verify=False), lambda _: None)
    messages = [notice.message for notice in result.notices if OF_ALL in notice.message]
    assert any(message.startswith("projected_coriolis_matrix: ") for message in messages)
    assert all("name it in `outputs`" in message for message in messages)
