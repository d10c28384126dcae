"""Where a search for configurations begins: the declared start, places near it, and random ones, in a fixed order."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence

from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.model import Input

# The seed of starts: the same model has the same configurations.
BRANCH_SEED = 20120731
# Starts at most.
MOST_STARTS = 40
# Starts after these, as long as no loop has closed: where many rows hang together one in twenty leads somewhere.
LAST_STARTS = 80


class Starts:
    """The starts of one mechanism; `widths` are the units of its coordinates, 1 rad or half a range."""

    def __init__(self, mechanics: NumericSystem, inputs: Sequence[Input], start: dict[str, float]) -> None:
        self._mechanics, self._inputs, self._start = mechanics, inputs, start
        self._random = random.Random(BRANCH_SEED)
        self.widths = [
            1.0 if c.is_angle else max(float(c.range[1] - c.range[0]) / 2, 1e-300) for c in mechanics.coordinates
        ]

    def direction(self) -> list[float]:
        """A random direction, in coordinate widths."""
        return [self._random.gauss(0, 1) for _ in self.widths]

    def anywhere(self, whole: bool) -> list[float]:
        """A random configuration in the ranges, angles from the whole circle if asked for."""
        return [
            self._random.uniform(-math.pi, math.pi)
            if whole and c.is_angle
            else self._random.uniform(float(c.range[0]), float(c.range[1]))
            for c in self._mechanics.coordinates
        ]

    def begin(self) -> list[float]:
        """The start, completed with the middles of the ranges."""
        return [self._start.get(c.name, float(sum(c.range)) / 2) for c in self._mechanics.coordinates]

    def guesses(self, places: Sequence[tuple[float, ...]]) -> Iterator[tuple[list[float], tuple[int, ...]]]:
        """Starts, and coordinates that are held: the declared start, then in turn near it (or what was found first),
        with coordinates moved that inputs act on, in the ranges, and over the whole circle; at last that alone."""
        begin = self.begin()
        yield begin, ()
        driven = self._driven(begin)
        for number in range(1, MOST_STARTS):
            centre = places[0] if places else begin
            match number % 4:
                case 1:
                    reach = 0.3 if number % 8 == 1 else 1.0
                    shifts = (self._random.uniform(-reach, reach) * width for width in self.widths)
                    yield [x + shift for x, shift in zip(centre, shifts, strict=True)], ()
                case 2:
                    held = driven[number // 4 % len(driven)]
                    reach = self._random.choice((-1, 1)) * self._random.uniform(0.2, 1.2)
                    shifts = (reach * width * (j in held) for j, width in enumerate(self.widths))
                    yield [x + shift for x, shift in zip(centre, shifts, strict=True)], held
                case other:
                    yield self.anywhere(whole=other == 3), ()
        for _ in range(LAST_STARTS):
            if places:
                return
            yield self.anywhere(whole=True), ()

    def _driven(self, q: Sequence[float]) -> list[tuple[int, ...]]:
        """The coordinates that each input acts on; each coordinate where there are no inputs."""
        try:
            columns = self._mechanics.columns(q, self._inputs)
        except (ArithmeticError, ValueError):
            columns = []
        coordinates = [tuple(j for j, value in column.items() if value) for column in columns]
        return [these for these in coordinates if these] or [(j,) for j in range(len(self.widths))]
