"""Evaluations in balls that are recorded once and run again at other numbers.

To walk through joints and expressions takes far longer than the operations on balls that come of it, and Newton's
method in hundreds of digits asks for the same ones at dozens of configurations.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias, cast

from flint import arb

from symgen.model.combinations.taylor_balls import FUNCTIONS_OF_BALLS, Ball, ball, raising
from symgen.model.configurations.numbers import Numbers

_Place: TypeAlias = int
_Operand: TypeAlias = "RecordedNumber | float"


@dataclass(frozen=True)
class RecordedLine:
    """Operations one after the other: each on numbers before it, given ones and constants first."""

    constants: tuple[Ball, ...]
    operations: tuple[tuple[Callable[..., Ball], tuple[_Place, ...]], ...]
    results: tuple[_Place, ...]

    def run(self, given: Sequence[Ball]) -> list[Ball]:
        """The results at given numbers; ValueError where one has no value there."""
        numbers = [*self.constants, *given]
        for operation, operands in self.operations:
            numbers.append(operation(*[numbers[place] for place in operands]))
        results = [numbers[place] for place in self.results]
        if not all(result.is_finite() for result in results):
            raise ValueError
        return results


class Recorder:
    """What is done to numbers, while expressions are evaluated in them; constants have the working precision."""

    def __init__(self) -> None:
        self._constants: list[Ball] = []
        self._known: dict[Fraction | float, RecordedNumber] = {}
        self._given = 0
        # they get their places at the end, behind all constants and given numbers
        self._operations: list[tuple[Callable[..., Ball], tuple[RecordedNumber, ...]]] = []
        self._made: dict[tuple[Any, ...], RecordedNumber] = {}

    def given(self) -> RecordedNumber:
        """The next of the numbers that a run is given."""
        self._given += 1
        return RecordedNumber(self, "given", self._given - 1)

    def constant(self, value: Ball) -> RecordedNumber:
        """A number that all runs have in common."""
        self._constants.append(value)
        return RecordedNumber(self, "constant", len(self._constants) - 1)

    def rational(self, value: Fraction | float) -> RecordedNumber:
        """An exact number."""
        if value not in self._known:
            self._known[value] = self.constant(ball(Fraction(value)))
        return self._known[value]

    def record(self, operation: Callable[..., Ball], *operands: RecordedNumber) -> RecordedNumber:
        """The result of an operation, which is done once where it is met twice."""
        key = operation, *((one.kind, one.number) for one in operands)
        if key not in self._made:
            self._operations.append((operation, operands))
            self._made[key] = RecordedNumber(self, "made", len(self._operations) - 1)
        return self._made[key]

    def power(self, base: float, exponent: Fraction) -> float:
        """A power with a number."""
        return cast(float, self.record(raising(exponent), cast(RecordedNumber, base)))

    def numbers(self) -> Numbers:
        """What expressions are evaluated in."""

        def function(of_balls: Callable[..., Ball]) -> Callable[..., float]:
            return lambda *operands: cast(float, self.record(of_balls, *cast(tuple[RecordedNumber, ...], operands)))

        return Numbers(
            cast(float, self.constant(arb.pi())),
            {name: function(of_balls) for name, of_balls in FUNCTIONS_OF_BALLS.items()},
            lambda value: cast(float, self.rational(value)),
            self.power,
        )

    def line(self, results: Sequence[RecordedNumber]) -> RecordedLine:
        """What these results need."""
        needed = {result.number for result in results if result.kind == "made"}
        for number in reversed(range(len(self._operations))):
            if number in needed:
                needed |= {one.number for one in self._operations[number][1] if one.kind == "made"}
        before = len(self._constants) + self._given
        behind = {number: before + place for place, number in enumerate(sorted(needed))}

        def place(one: RecordedNumber) -> _Place:
            if one.kind == "made":
                return behind[one.number]
            return one.number + (len(self._constants) if one.kind == "given" else 0)

        kept = [self._operations[number] for number in behind]
        operations = tuple((operation, tuple(map(place, operands))) for operation, operands in kept)
        return RecordedLine(tuple(self._constants), operations, tuple(map(place, results)))


@dataclass(frozen=True, slots=True, eq=False)
class RecordedNumber:
    """A number that is known when a line is run: a constant, a given one or what an operation makes."""

    recorder: Recorder
    kind: str
    number: int

    def _with(self, operation: Callable[..., Ball], left: _Operand, right: _Operand) -> RecordedNumber:
        operands = (x if isinstance(x, RecordedNumber) else self.recorder.rational(x) for x in (left, right))
        return self.recorder.record(operation, *operands)

    def __add__(self, other: _Operand) -> RecordedNumber:
        return self._with(operator.add, self, other)

    def __radd__(self, other: float) -> RecordedNumber:
        return self._with(operator.add, other, self)

    def __sub__(self, other: _Operand) -> RecordedNumber:
        return self._with(operator.sub, self, other)

    def __rsub__(self, other: float) -> RecordedNumber:
        return self._with(operator.sub, other, self)

    def __mul__(self, other: _Operand) -> RecordedNumber:
        return self._with(operator.mul, self, other)

    def __rmul__(self, other: float) -> RecordedNumber:
        return self._with(operator.mul, other, self)

    def __truediv__(self, other: _Operand) -> RecordedNumber:
        return self._with(operator.truediv, self, other)

    def __rtruediv__(self, other: float) -> RecordedNumber:
        return self._with(operator.truediv, other, self)

    def __neg__(self) -> RecordedNumber:
        return self.recorder.record(operator.neg, self)
