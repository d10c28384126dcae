"""What is tried with twice the digits, and what is not tried again."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from symgen.generation.acceptance import tried_methods
from symgen.generation.acceptance.passing import Passing
from symgen.generation.acceptance.tried_methods import TriedMethods
from symgen.ir.kernel import Scalar
from symgen.model.load import load_text
from symgen.quantities.alternatives import Alternative
from symgen.quantities.select import derive_quantities

BOTH: tuple[Scalar, ...] = ("float64", "float32")
PENDULUM = """\
model: pendulum
coordinates: {a: {}}
kinetic_energy: 0.7*a_dot**2
potential_energy: 9.81*cos(a)
outputs: [forward_dynamics]
"""


@cache
def method(title: str = "one", wide: tuple[Scalar, ...] = (), weight: int = 10) -> Alternative:
    selection = derive_quantities(load_text(PENDULUM, "pendulum.yaml"), ("forward_dynamics",))
    choice = replace(selection.choices[0], title=title, costs=((title, weight),), wide=wide)
    return Alternative(choice, selection.mechanics, selection.quantities[0])


def in_both(tried: TriedMethods) -> list[str]:
    return [one.choice.title for one in tried.short_of_digits(tried.take_inaccurate(), BOTH)]


def test_what_does_not_do_with_more_digits_in_one_type_is_tried_in_both() -> None:
    tried = TriedMethods()
    one = tried.widens(method(), ("float32",))
    assert one.choice.wide == ("float32",)
    tried.keep_for_more_digits(one)
    assert in_both(tried) == ["one"]


def test_it_is_tried_once() -> None:
    tried = TriedMethods()
    tried.keep_for_more_digits(method())
    tried.keep_for_more_digits(method())
    assert in_both(tried) == ["one"]
    tried.keep_for_more_digits(tried.widens(method(), BOTH))
    assert in_both(tried) == []


def test_the_shortest_comes_first_and_then_what_loses_least() -> None:
    tried = TriedMethods()
    for title, weight, error in (("short", 10, 90.0), ("worst", 20, 80.0), ("longer", 30, 40.0), ("longest", 40, 20.0)):
        tried.loses(method(title, (), weight), error)
        tried.loses(method(title, (), weight), error / 2)
        tried.keep_for_more_digits(method(title, (), weight))
    assert in_both(tried) == ["short", "longest", "longer"]


def test_long_ones_are_not_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tried_methods, "LONGEST_WIDENED", 9)
    tried = TriedMethods()
    tried.keep_for_more_digits(method())
    assert in_both(tried) == []


def test_what_float32_alone_lacks_is_given_more_digits_there() -> None:
    tried = TriedMethods()
    for title, weight, largest in (("narrow", 10, 9.0), ("long", 30, 2.0), ("short", 20, 3.0)):
        tried.passing.append(Passing(largest, ("float64",), method(title, (), weight), {}))
    tried.passing.append(Passing(1.0, BOTH, method("both"), {}))
    assert [one.choice.title for one in tried.short_of_digits_in_float32(8.0)] == ["short", "long", "narrow"]


def test_the_best_that_passes_is_taken_once() -> None:
    tried = TriedMethods()
    tried.passing += [
        Passing(1.0, ("float64",), method("half"), {}),
        Passing(7.0, BOTH, method("whole"), {}),
        Passing(5.0, BOTH, method("better"), {}),
    ]
    taken = [tried.take_best(BOTH), tried.take_best(BOTH), tried.take_best(BOTH), tried.take_best(())]
    assert [one and one.alternative.choice.title for one in taken] == ["better", "whole", None, "half"]


def test_kernels_are_looked_at_once() -> None:
    tried = TriedMethods()
    assert not tried.saw({})
    assert tried.saw({})
