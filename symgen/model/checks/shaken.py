"""Which entries of the rows are zeros but for rounding, told by how they change when every number is shaken a little.

Numbers in a file are rounded: 0.19 + 1.0 - 1.19 is 1e-16, and an axis that is parallel to another in the drawing is so
but for 1e-16.  Sums of sines that cancel leave as much.  So each number and each occurrence of a name is multiplied by
1 + e with random e: what is left of a zero changes by e times the terms that cancel, which is far more than it is and
in proportion to e.  An entry that counts changes by about e of itself; one of functions so steep that e is enough to
change all of it does so for any e.  That needs no scale, so that a row in other units is the same row, and no list of
what cancels.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

from symgen.diagnostics import Span
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.sparse import Row
from symgen.model.expressions.expression import Binary, Name, Number, Pi
from symgen.model.expressions.walk import exact_value
from symgen.model.model import Input

# The seed of what numbers are shaken by: the same for the same model.
SHAKING_SEED = 20260607
# Relative changes of numbers that are shaken: more than rounding to 16 digits makes, less than any dimension.
LITTLE, MUCH = 1e-13, 1e-10
# Times that all numbers are shaken by each of these.
SHAKES = 3
# Times itself, that a rest changes at least.
CHANGED = 4.0
# Times as much as by a little, that a rest changes by much at least.
PROPORTIONAL = 250.0
# Of what is beside it, up to which an entry may be a rest of zeros, and times its change, up to which it is one.
ZERO_SIZE, MOSTLY = 1e-13, 16.0
# Of itself, that a rest changes by a little at least.
ALTOGETHER = 0.01
# Pi, to more digits than it is shaken by.
PI_TO_50_DIGITS = Fraction("3.14159265358979323846264338327950288419716939937510")

Evaluation: TypeAlias = Callable[[NumericSystem, Sequence[Input], Sequence[float]], list[Row]]
"""Rows of some mechanics and inputs at a configuration; ArithmeticError or ValueError outside of a domain."""


class Shaken:
    """The mechanics and inputs shaken a few times, by little and by much; the same in every run."""

    def __init__(self, mechanics: NumericSystem, inputs: Sequence[Input], evaluate: Evaluation) -> None:
        self._given, self._evaluate = (mechanics, inputs), evaluate
        generator = random.Random(SHAKING_SEED)
        self._others = [
            [_Shaker(generator, share).of(mechanics, inputs) for _ in range(SHAKES)] for share in (LITTLE, MUCH)
        ]
        self.first: list[Row] = []
        self.sizes: list[Row] = []
        self._changes: tuple[list[Row], list[Row]] = ([], [])

    def look(self, q: Sequence[float]) -> bool:
        """Evaluates at one more configuration; whether that was possible."""
        try:
            rows = self._evaluate(*self._given, q)
            beside = [[self._evaluate(*other, q) for other in others] for others in self._others]
        except (ArithmeticError, ValueError):
            return False
        self.first = self.first or rows
        for largest in (self.sizes, *self._changes):
            largest.extend({} for _ in range(len(rows) - len(largest)))
        for i, row in enumerate(rows):
            for j, value in row.items():
                self.sizes[i][j] = max(self.sizes[i].get(j, 0.0), abs(value))
            for changes, other_rows in zip(self._changes, beside, strict=True):
                for other in other_rows:
                    for j in {*row, *other[i]}:
                        change = abs(row.get(j, 0.0) - other[i].get(j, 0.0))
                        changes[i][j] = max(changes[i].get(j, 0.0), change)
        return True

    def is_rest(self, i: int, j: int) -> bool:
        """Whether nothing but rounding is left of an entry."""
        size, little, much = (sizes[i].get(j, 0.0) for sizes in (self.sizes, *self._changes))
        if size == 0 or (CHANGED * size <= little and PROPORTIONAL * little <= much):
            return True
        # zero whatever the numbers are, such as a force along the arm it turns: only rounding changes, and altogether
        largest = max((x for row in self.sizes for x in row.values()), default=0.0)
        if size <= ZERO_SIZE * max(1.0, largest) and ALTOGETHER * size <= little:
            return True
        # what matrices leave that undo each other is in no proportion; it is nothing beside the terms of its row
        terms = max(self._changes[1][i].values()) / MUCH
        return size <= ZERO_SIZE * terms and size <= MOSTLY * min(little, much)

    def within(self, i: int, j: int) -> bool:
        """Whether an entry is no larger than what it changes by."""
        return self.sizes[i].get(j, 0.0) <= self._changes[1][i].get(j, 0.0)


class _Shaker:
    def __init__(self, generator: random.Random, share: float) -> None:
        self._random, self._share = generator, share

    def of(self, given: NumericSystem, inputs: Sequence[Input]) -> tuple[NumericSystem, tuple[Input, ...]]:
        defaults = {name: value * float(self._factor()) for name, value in given.defaults.items()}
        rows, definitions = self._part(given.constraints), self._part(given.definitions)
        return given.having(defaults, rows, definitions, self._part(given.mechanism)), self._part(tuple(inputs))

    def _factor(self) -> Fraction:
        return 1 + Fraction(self._random.choice((-1, 1)) * self._random.uniform(0.5, 1) * self._share)

    def _part(self, part: Any) -> Any:
        match part:
            case Number(value=value):
                return Number(value * self._factor()) if value else part
            case Pi():
                return Number(PI_TO_50_DIGITS * self._factor())
            case Name():
                return Binary("*", Number(self._factor()), part)
            case tuple():
                # what rounding leaves of a zero beside the other entries of a vector is shaken as these are
                sizes = [abs(Fraction(exact_value(one) or 0)) for one in part]
                tiny = Fraction(self._share) * max(sizes, default=0)
                pairs = zip(part, sizes, strict=True)
                return tuple(
                    Number(tiny * self._factor()) if 0 < size < tiny else self._part(one) for one, size in pairs
                )
        if is_dataclass(part) and not isinstance(part, (type, Span)):
            parts = {field.name: getattr(part, field.name) for field in fields(part)}
            return replace(part, **{name: self._part(one) for name, one in parts.items() if not isinstance(one, str)})
        return part
