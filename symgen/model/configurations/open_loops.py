"""Loops that do not close: where they come nearest to it, and whether a few of their rows keep them open."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from itertools import islice

from symgen.model.configurations.closing import Closer, KinematicLoop
from symgen.model.configurations.starts import Starts
from symgen.records import dataclass

# Starts that show where a loop comes nearest.
SHOWING_STARTS = 8
# Of the widest gap of a loop, from which rows are among those that keep it open.
KEEPING_OPEN = 0.05


@dataclass(frozen=True, slots=True)
class OpenLoop:
    """A mechanism that does not close: the geometric row that stays open widest, by number, and its value."""

    row: int
    value: float


@dataclass(frozen=True, slots=True)
class _NearestPlace:
    """Where a loop is nearest to being closed: the values of its rows there, and how large they are together."""

    q: tuple[float, ...]
    gaps: tuple[float, ...]
    size: float


class OpenLoops:
    """Those of one mechanism; `starts` are the same ones each time."""

    def __init__(self, closer: Closer, starts: Callable[[], Starts]) -> None:
        self._closer, self._starts = closer, starts

    def a_part_stays_open(self) -> bool:
        """Whether the rows that keep a loop open close from no start by themselves: then the mechanism does not.

        In a chain of loops of which one cannot close they are few, and tried in no time beside the chain.
        """
        for loop, place in self._nearest.items():
            part = self._closer.widest(place.q, loop, KEEPING_OPEN)
            guesses = self._starts().guesses(())
            if len(part.rows) < len(loop.rows) and all(self._closer.close(guess, [part]).open for guess, _ in guesses):
                return True
        return False

    def widest(self) -> OpenLoop | None:
        """The widest gap at the nearest configuration, of a loop that never closes."""
        for loop, place in self._nearest.items():
            widest = max(range(len(place.gaps)), key=lambda i: abs(place.gaps[i]))
            return OpenLoop(loop.rows[widest], place.gaps[widest])
        return None

    @cached_property
    def _nearest(self) -> dict[KinematicLoop, _NearestPlace]:
        """Of each loop that closes from none of these starts."""
        nearest: dict[KinematicLoop, _NearestPlace] = {}
        for guess, _ in islice(self._starts().guesses(()), SHOWING_STARTS):
            closed = self._closer.close(guess)
            for loop in self._closer.loops:
                gaps = self._closer.gaps(closed.q, loop) if loop in closed.open else [0.0]
                size = math.hypot(*gaps)
                if not math.isnan(size) and (loop not in nearest or size < nearest[loop].size):
                    nearest[loop] = _NearestPlace(closed.q, tuple(gaps), size)
        return {loop: place for loop, place in nearest.items() if place.size > 0}
