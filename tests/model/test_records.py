"""symgen.records: its classes behave as frozen dataclasses with slots, which some module's tests rely on everywhere."""

from __future__ import annotations

import dataclasses
import pickle
from dataclasses import dataclass, field
from typing import Any

import pytest

from symgen import records


@records.dataclass(frozen=True, slots=True)
class Made:
    """One with everything."""

    a: int
    b: str = "b"
    c: list[int] = field(default_factory=list, hash=False)
    d: int = field(default=0, compare=False, repr=False)

    @property
    def double(self) -> int:
        return 2 * self.a


@dataclass(frozen=True, slots=True)
class Usual:
    """The same by the standard library."""

    a: int
    b: str = "b"
    c: list[int] = field(default_factory=list, hash=False)
    d: int = field(default=0, compare=False, repr=False)


@records.dataclass(frozen=True, slots=True)
class Empty:
    """Without fields."""


@pytest.mark.parametrize("arguments", [(1,), (1, "x"), (1, "x", [2]), (1, "x", [2], 3)])
def test_values_text_and_conversions_are_the_standard_ones(arguments: tuple[Any, ...]) -> None:
    made, usual = Made(*arguments), Usual(*arguments)
    assert dataclasses.asdict(made) == dataclasses.asdict(usual)
    assert repr(made) == repr(usual).replace("Usual", "Made")
    assert hash(made) == hash(usual)
    assert made == Made(*arguments)
    assert dataclasses.replace(made, a=5) == Made(5, *arguments[1:])
    assert pickle.loads(pickle.dumps(made)) == made
    assert Made.__match_args__ == Usual.__match_args__


def test_comparison() -> None:
    assert Made(1) != Made(2)
    assert Made(1, d=4) == Made(1, d=5)
    assert Made(1) != Usual(1)
    assert Empty() == Empty()
    assert {Made(1): 1, Empty(): 2} == {Empty(): 2, Made(1): 1}
    assert Made(1).c is not Made(1).c


def test_nothing_can_be_changed_or_added() -> None:
    made: Any = Made(1)
    for name in ("a", "other"):
        with pytest.raises(dataclasses.FrozenInstanceError, match=f"cannot assign to field '{name}'"):
            setattr(made, name, 2)
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'a'"):
        del made.a
    assert not hasattr(made, "__dict__")
    assert (made.a, made.double) == (1, 2)


@pytest.mark.parametrize("given", [{}, {"a": 1, "e": 2}])
def test_wrong_arguments(given: dict[str, Any]) -> None:
    with pytest.raises(TypeError, match="__init__"):
        Made(**given)
