"""Configurations nearer and nearer to where rows, inputs or masses lose rank, on the branch that was drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.kkt import Ranks, distances
from symgen.laboratory.zoo.states import FURTHEST, Walker, null_space

# what can lose rank, in the order in which each leaves room for the next
KINDS = ("rows", "inputs", "masses")
# nearer than this to a singular set its side is no longer known from differences
SMOOTH, DIFFERENCE = 1e-5, 1e-7
DEEPEST = 12
STEPS, HALVINGS, LONGEST = 60, 7, 0.4
# each step aims at the middle of the next decade
MIDDLE = 0.4


class Approach:
    """Leads configurations towards the singular sets of a system with given parameters."""

    def __init__(self, walker: Walker, parameters: Mapping[str, float], ranks: Ranks) -> None:
        self._walker, self._parameters, self._ranks = walker, parameters, ranks

    def distance(self, kind: str, q: Any) -> float | None:
        """How far rows, inputs or masses are from a drop of rank; None where there are none of the kind."""
        try:
            at = self._walker.numbers(q, self._parameters)
            return distances(at, self._ranks, 1.0).get(kind)
        except (ValueError, OverflowError, ZeroDivisionError):
            # beyond the edge of what the expressions are defined for
            return None

    def towards(self, kind: str, start: Any, dice: Dice) -> Iterator[tuple[int, Any]]:
        """The decades that are reached, 0 to `DEEPEST`, each with a configuration; fewer where nothing is singular."""
        here, distance = start, self.distance(kind, start)
        direction: Any = None
        told: set[int] = set()
        for _ in range(STEPS):
            if not distance:
                return
            decade = min(DEEPEST, int(-math.log10(min(1.0, distance))))
            if decade not in told:
                told.add(decade)
                yield decade, here
            if decade == DEEPEST:
                return
            aim = MIDDLE * 10.0 ** -(decade + 1)
            found = None
            if distance > SMOOTH or direction is None:
                direction = self._steepest(kind, here, distance, dice)
                found = self._step(kind, start, here, distance, aim, direction)
            else:
                for sign in (1, -1):
                    found = found or self._step(kind, start, here, distance, aim, sign * direction)
            if found is None:
                return
            here, distance = found

    def _steepest(self, kind: str, q: Any, distance: float, dice: Dice) -> Any:
        """The direction along V in which the distance falls, as long as the way for a distance of 1 is at this slope.

        Where the distance does not change, as at a saddle, any.
        """
        free = self._free(q)
        slopes = []
        for column in free.T:
            there = self.distance(kind, q + DIFFERENCE * column)
            slopes.append(0.0 if there is None else (there - distance) / DIFFERENCE)
        steepest = free @ np.array(slopes)
        square = float(steepest @ steepest)
        if square < 1e-12:
            return free @ np.array([dice.uniform(-1, 1) for _ in range(free.shape[1])])
        return -steepest / square

    def _step(
        self, kind: str, start: Any, here: Any, distance: float, aim: float, direction: Any
    ) -> tuple[Any, float] | None:
        """A step along V after which the distance is less."""
        move = (distance - aim) * direction
        free = self._free(here)
        move = free @ (free.T @ move)
        length = float(np.linalg.norm(move))
        if not 0 < length < math.inf:
            return None
        move *= min(1.0, LONGEST / length)
        for _ in range(HALVINGS):
            there = self._walker.closed(here + move, self._parameters)
            if there is not None and np.abs(there - start).max() < FURTHEST and self._walker.inside(there):
                new = self.distance(kind, there)
                if new is not None and new < distance:
                    return there, new
            move = move / 2
        return None

    def _free(self, q: Any) -> Any:
        return null_space(self._walker.numbers(q, self._parameters), self._ranks.constraints)
