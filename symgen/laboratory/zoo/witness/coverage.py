"""How much of what was generated was compared, and why not more: what a draw that passes has passed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Coverage:
    """States and results that were held against the witness.

    `lack` says why there are fewer states than were asked for. `quantities` are those with a number beside its truth at
    some state, `missing` those that the model has and that had none. `statuses` are answers other than 0 where the
    state determines the result badly, by scalar type: at these nothing is looked at, and `clearest` says how well the
    best of them is determined, 0 to 1. `unknown` are results that have no truth. `pinocchio` are results of trees
    beside Pinocchio's.
    """

    states: int = 0
    lack: str = ""
    quantities: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    numbers: int = 0
    statuses_float64: int = 0
    statuses_float32: int = 0
    clearest: float = 0.0
    unknown: int = 0
    pinocchio: int = 0

    @property
    def statuses(self) -> int:
        """Answers other than 0 of both types."""
        return self.statuses_float64 + self.statuses_float32


def coverage_of(given: Mapping[str, Any]) -> Coverage:
    """A coverage back from JSON."""
    listed = {name: tuple(given[name]) for name in ("quantities", "missing")}
    return Coverage(**{**given, **listed})


class Tally:
    """Counts results while they are compared."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}
        self._statuses = {"float64": 0, "float32": 0}
        self._clearest, self._unknown = 0.0, 0
        self.pinocchio = 0

    def number(self, quantity: str) -> None:
        """A number beside its truth."""
        self._numbers[quantity] = self._numbers.get(quantity, 0) + 1

    def status(self, scalar: str, clear: float) -> None:
        """A status at a state that determines the result no better than this."""
        self._statuses[scalar] += 1
        self._clearest = max(self._clearest, clear)

    def unknown(self) -> None:
        """A result without a truth."""
        self._unknown += 1

    def total(self, states: int, lack: str, there: tuple[str, ...]) -> Coverage:
        """All of it, `there` being the quantities that the model has."""
        compared = tuple(name for name in there if name in self._numbers)
        missing = tuple(name for name in there if name not in self._numbers)
        statuses = self._statuses["float64"], self._statuses["float32"]
        numbers = sum(self._numbers.values())
        clearest = float(f"{self._clearest:.2g}")
        return Coverage(states, lack, compared, missing, numbers, *statuses, clearest, self._unknown, self.pinocchio)
