"""What `all` takes of the quantities of a system: beyond counted limits the longest are left out, and told.

u is always made, and so is what is asked for by name; accelerations and multipliers are where they are not too long
with twice the digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from typing import TypeVar

from symgen.model.quantities import MAIN
from symgen.runtime.effort import SCALAR, TooLongError, at_most, done, worth_trying

# Counted cost of all quantities together: what takes under a minute to derive, to verify and to compile.
OPERATIONS_OF_ALL = 25_000
# Counted cost of one quantity by a method that loses digits: with twice as many it takes some twenty times as long.
WIDE_OPERATIONS = 2_000
# The same for accelerations and multipliers, which may take more of that than the others.
WIDE_MAIN_OPERATIONS = 10_000
# Counted cost of all methods together that are tried for quantities which verification rejects and nobody asked for.
OPERATIONS_TRIED = 16_000
# Scalars that are made by one method for one quantity before the others are tried.
SCALARS_OF_A_METHOD = 150_000
# Scalars that are made by all methods for all quantities together.
SCALARS_OF_ALL = 800_000
# Times the scalars with which what is asked for, and takes longer by all methods, is tried once more.
GROWTH = 8
Made = TypeVar("Made")
OF_ALL = "`all` leaves it out"
REMEDY = "name it in `outputs` to have it all the same"


class WorkBudget:
    """What is left of the work that `all` may take; `asked` are the quantities that are made whatever they take."""

    def __init__(self, outputs: Sequence[str], named: Mapping[str, str]) -> None:
        self._asked = asked_for(outputs, named)
        self._left = SCALAR * SCALARS_OF_ALL

    def derived(
        self, quantity: str, methods: Mapping[str, Callable[[], Made]], at_hand: int | None = None
    ) -> dict[str, Made]:
        """The quantity by each method that does not take many times what another takes.

        None where it is not asked for and takes too long, or where a method of so many operations is `at_hand`.
        """
        if at_hand is not None:
            return self._within(methods, worth_trying(at_hand))
        first = SCALAR * SCALARS_OF_A_METHOD
        if quantity not in self._asked:
            before = done()
            made = self._within(methods, min(first, self._left))
            self._left -= done() - before
            return made
        for most in (first, GROWTH * first) if len(methods) > 1 else ():
            if made := self._within(methods, most):
                return made
        return {name: method() for name, method in methods.items()}

    @staticmethod
    def _within(methods: Mapping[str, Callable[[], Made]], most: float) -> dict[str, Made]:
        made: dict[str, Made] = {}
        for name, method in methods.items():
            with suppress(TooLongError), at_most(most):
                made[name] = method()
        return made

    def surplus(self, costs: Mapping[str, int]) -> list[str]:
        """The longest of the quantities that are not asked for, without which the rest is short enough."""
        total, without = sum(costs.values()), list[str]()
        for name in sorted(costs, key=lambda name: -costs[name]):
            if total > OPERATIONS_OF_ALL and name not in self._asked:
                without.append(name)
                total -= costs[name]
        return without


def asked_for(outputs: Sequence[str], named: Iterable[str]) -> frozenset[str]:
    """The quantities that are made whatever they take."""
    return frozenset((*outputs, *named, *MAIN))


def most_with_twice_the_digits(quantity: str, outputs: Iterable[str], named: Iterable[str]) -> float:
    """The counted cost up to which a method takes twice the digits; what is asked for has no limit, nor has u."""
    if quantity in (*outputs, *named, "inverse_dynamics"):
        return math.inf
    return WIDE_MAIN_OPERATIONS if quantity in MAIN else WIDE_OPERATIONS


def too_wide(operations: int) -> str:
    """Why `all` leaves out a quantity whose digits every short method loses."""
    takes = f"{operations} operations at least, which twice the digits make some twenty times as many"
    return f"{OF_ALL}, as it loses digits and takes {takes}; {REMEDY}"


def too_many_tried() -> str:
    """Why `all` leaves out a quantity that loses digits, after others that do."""
    tried = f"methods of {OPERATIONS_TRIED} operations were tried for shorter ones"
    return f"{OF_ALL}, as it loses digits, and {tried}; {REMEDY}"


def too_long(operations: int = 0) -> str:
    """Why `all` leaves a quantity out; `operations` are those it takes, where it was derived."""
    most = f"all take at most {OPERATIONS_OF_ALL} together"
    takes = f"{operations} operations, where {most}" if operations else "long to derive"
    return f"{OF_ALL}, as it takes {takes}; {REMEDY}"
