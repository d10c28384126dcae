"""Random choices that look like what people write: few digits, round values, sometimes zero, equal or far apart."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Dice:
    """A seeded source of choices; the same seed gives the same draw on every machine and under any hash seed."""

    def __init__(self, *seed: object) -> None:
        self._random = random.Random(" ".join(map(str, seed)))
        # whether masses of this draw are decades apart
        self.extreme = False

    def chance(self, probability: float) -> bool:
        """True with this probability."""
        return self._random.random() < probability

    def choice(self, options: Sequence[T]) -> T:
        """One of the options."""
        return options[self._random.randrange(len(options))]

    def weighted(self, options: dict[T, float]) -> T:
        """One of the options by weight."""
        return self._random.choices(list(options), list(options.values()))[0]

    def sample(self, options: Sequence[T], count: int) -> list[T]:
        """Some different options in their order."""
        kept = set(self._random.sample(range(len(options)), min(count, len(options))))
        return [option for index, option in enumerate(options) if index in kept]

    def shuffled(self, options: Sequence[T]) -> list[T]:
        """All options in another order."""
        return self._random.sample(list(options), len(options))

    def whole(self, least: int, most: int) -> int:
        """A whole number."""
        return self._random.randint(least, most)

    def uniform(self, lower: float, upper: float) -> float:
        """Any float between."""
        return self._random.uniform(lower, upper)

    def number(self, lower: float, upper: float, digits: int = 3) -> str:
        """A decimal between, with so many digits at most."""
        value = self._random.uniform(lower, upper)
        return decimal(value, digits if self.chance(0.7) else 2)

    def length(self) -> str:
        """A length in metres."""
        return self.choice(("1", "0.5", "0.25")) if self.chance(0.15) else self.number(0.1, 1.2, 2)

    def mass(self, extreme: bool = False) -> str:
        """A mass in kilograms; `extreme` ones are nine decades apart."""
        if extreme or (self.extreme and self.chance(0.7)):
            return self.choice(("1e-6", "1e-6", "1e-3", "1", "1e3", "1e3"))
        return "1" if self.chance(0.15) else self.number(0.1, 8, 2)

    def angle(self) -> float:
        """An angle with two decimals, mostly away from multiples of a quarter turn."""
        if self.chance(0.03):
            return self.choice((0.0, math.pi / 2, -math.pi / 2))
        quarter = self.whole(-2, 1)
        return round(quarter * math.pi / 2 + self._random.uniform(0.25, 1.3), 2)


def decimal(value: float, digits: int) -> str:
    """A float with so many significant digits, as a person writes it."""
    text = f"{value:.{digits}g}"
    return repr(float(text)) if "e" not in text else text


def exact(value: float) -> str:
    """A float with all its digits."""
    return repr(float(value))
