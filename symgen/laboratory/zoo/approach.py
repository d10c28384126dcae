"""Configurations nearer and nearer to where rows vanish, or rows, inputs or masses lose rank, on the drawn branch."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.kkt import GenericRanks, distances
from symgen.laboratory.zoo.witness.numbers.float_rows import null_space
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING
from symgen.laboratory.zoo.witness.states import FURTHEST, Walker

# what can lose rank, in the order in which each leaves room for the next; a row vanishes beside its usual length
LENGTHS = "lengths"
KINDS = ("rows", LENGTHS, "inputs", "masses")
# slopes are differences over this, and over less than the distance, beyond which it grows again
DIFFERENCE, SHARE = 1e-7, 1e-2
DEEPEST = 12
STEPS, HALVINGS, LONGEST = 60, 7, 0.4
# each step aims at the middle of the next decade
MIDDLE = 0.4


class Approach:
    """Leads configurations towards the singular sets of a system with given parameters.

    The ranges of the file do not matter: what is generated answers, or has a status, in every configuration.
    """

    def __init__(
        self, walker: Walker, parameters: Mapping[str, float], ranks: GenericRanks, scattered: Sequence[Any]
    ) -> None:
        self._walker, self._parameters, self._ranks = walker, parameters, ranks
        self._scattered = scattered
        self._usual = np.max([walker.lengths(walker.numbers(q, parameters)) for q in scattered], axis=0, initial=0.0)

    def distance(self, kind: str, q: Any) -> float | None:
        """How far rows, inputs or masses are from a drop of rank; None where there are none of the kind."""
        try:
            at = self._walker.numbers(q, self._parameters)
            if kind == LENGTHS:
                held = self._usual > NOTHING
                return float((self._walker.lengths(at)[held] / self._usual[held]).min()) if held.any() else None
            return distances(at, self._ranks, 1.0).get(kind)
        except (ValueError, OverflowError, ZeroDivisionError):
            # beyond the edge of what the expressions are defined for
            return None

    def nearest(self, kind: str, count: int) -> list[Any]:
        """Those of the scattered configurations from which the way is shortest."""
        known = [(distance, k) for k, q in enumerate(self._scattered) if (distance := self.distance(kind, q))]
        return [self._scattered[k] for _, k in sorted(known)[:count]]

    def towards(self, kind: str, start: Any, dice: Dice) -> Iterator[tuple[int, Any]]:
        """The decades that are reached, 0 to `DEEPEST`, each with a configuration; fewer where nothing is singular."""
        first = here = np.array(start)
        distance = self.distance(kind, here)
        reached: set[int] = set()
        for _ in range(STEPS):
            if not distance:
                return
            decade = min(DEEPEST, int(-math.log10(min(1.0, distance))))
            if decade not in reached:
                reached.add(decade)
                yield decade, here
            if decade == DEEPEST:
                return
            aim = MIDDLE * 10.0 ** -(decade + 1)
            move = (distance - aim) * self._steepest(kind, here, distance, dice)
            nearer = self._step(kind, first, here, distance, move)
            if nearer is None:
                return
            here, distance = nearer

    def _steepest(self, kind: str, q: Any, distance: float, dice: Dice) -> Any:
        """The direction along V in which the distance falls, as long as the way for a distance of 1 is at this slope.

        Where the distance does not change, as at a saddle, any.
        """
        free = self._free(q)
        step = min(DIFFERENCE, SHARE * distance)
        slopes = []
        for column in free.T:
            there = self.distance(kind, q + step * column)
            slopes.append(0.0 if there is None else (there - distance) / step)
        steepest = free @ np.array(slopes)
        square = float(steepest @ steepest)
        if square < 1e-12:
            return free @ np.array([dice.uniform(-1, 1) for _ in range(free.shape[1])])
        return -steepest / square

    def _step(self, kind: str, first: Any, here: Any, distance: float, move: Any) -> tuple[Any, float] | None:
        """A step along V after which the distance is less."""
        length = float(np.linalg.norm(move))
        if not 0 < length < math.inf:
            return None
        move = move * min(1.0, LONGEST / length)
        for _ in range(HALVINGS):
            there = self._walker.closed(here + move, self._parameters)
            if there is not None and np.abs(there - first).max() < FURTHEST:
                new = self.distance(kind, there)
                if new is not None and new < distance:
                    return there, new
            move = move / 2
        return None

    def _free(self, q: Any) -> Any:
        return null_space(self._walker.numbers(q, self._parameters), self._ranks.constraints)
