"""Numbers that know what would become of them if a constant were half or double: which decisions would fall otherwise.

One derivation on such numbers tells which constants can change it, without deriving anew for each.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from numbers import Rational
from typing import Any

Key = tuple[str, str]
PLAIN = (int, float, Fraction)


class Varied:
    """A number `here`, and what it is `otherwise`, by the constant and whether that is half or double.

    `noticed` takes what would decide something otherwise.  Where such a number leaves comparisons and arithmetic, every
    other value counts as noticed.
    """

    __slots__ = ("here", "noticed", "otherwise")

    def __init__(self, here: Any, otherwise: Mapping[Key, Any], noticed: set[Key]) -> None:
        self.here, self.otherwise, self.noticed = here, otherwise, noticed

    def used(self) -> Any:
        """The plain number, for what cannot be followed."""
        self.noticed.update(key for key, value in self.otherwise.items() if value != self.here)
        return self.here

    @property
    def numerator(self) -> int:
        """That of the plain number; so the denominator."""
        return int(self.used().numerator)

    @property
    def denominator(self) -> int:
        """What a scalar of the graph asks for, too."""
        return int(self.used().denominator)

    def __hash__(self) -> int:
        return hash(self.used())

    def __bool__(self) -> bool:
        return bool(operator.ne(self, 0))

    def __index__(self) -> int:
        return operator.index(self.used())

    def __int__(self) -> int:
        return int(self.used())

    def __float__(self) -> float:
        return float(self.used())

    def __rlshift__(self, other: int) -> int:
        return other << int(self.used())

    def __abs__(self) -> Any:
        return abs(self.used())

    def __round__(self) -> Any:
        return round(self.used())

    def __neg__(self) -> Varied:
        return Varied(-self.here, {key: -value for key, value in self.otherwise.items()}, self.noticed)

    def __str__(self) -> str:
        return str(self.here)  # for messages

    def __format__(self, how: str) -> str:
        return format(self.here, how)


def _results(operation: Callable[[Any, Any], Any], a: Any, b: Any) -> tuple[Any, dict[Key, Any]]:
    ours, theirs = ((one.here, one.otherwise) if isinstance(one, Varied) else (one, {}) for one in (a, b))
    keys = {**ours[1], **theirs[1]}
    others = {key: operation(ours[1].get(key, ours[0]), theirs[1].get(key, theirs[0])) for key in keys}
    return operation(ours[0], theirs[0]), others


def _arithmetic(operation: Callable[[Any, Any], Any], swapped: bool = False) -> Callable[[Varied, Any], Any]:
    def method(self: Varied, other: Any) -> Any:
        if not isinstance(other, (*PLAIN, Varied)):
            return operation(other, self.used()) if swapped else operation(self.used(), other)
        here, otherwise = _results(operation, *((other, self) if swapped else (self, other)))
        return Varied(here, otherwise, self.noticed)

    return method


def _comparison(operation: Callable[[Any, Any], Any]) -> Callable[[Varied, Any], Any]:
    def method(self: Varied, other: Any) -> Any:
        if not isinstance(other, (*PLAIN, Varied)):
            return operation(self.used(), other)
        here, otherwise = _results(operation, self, other)
        self.noticed.update(key for key, value in otherwise.items() if value != here)
        return here

    return method


Rational.register(Varied)  # so that fractions take it
for _name in ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow"):
    setattr(Varied, f"__{_name}__", _arithmetic(getattr(operator, _name)))
    setattr(Varied, f"__r{_name}__", _arithmetic(getattr(operator, _name), swapped=True))
for _name in ("lt", "le", "gt", "ge", "eq", "ne"):
    setattr(Varied, f"__{_name}__", _comparison(getattr(operator, _name)))
