"""Prime fields with a circle each, whose points multiply as angles add: x^2 + y^2 = 1 over F_p has p + 1 points.

p + 1 is 864 k q with a prime q, so that angles can be numbers of the field F_q: any sum, product and quotient in it
turns the circle over F_p consistently, G^(a + b) = G^a G^b with a point G of order q.  Multiples of pi/432 turn by
powers of a point H of order 864 instead.  q has a circle in turn, for sines and cosines that stand inside of angles.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

Pair: TypeAlias = tuple[int, int]  # cosine, sine

# Points that turn by whole fractions of the circle: 2^5 3^3.
STEPS = 864


class Field:
    """F_p with p + 1 = STEPS * k * q; `angles` is the field F_q, None for the last one.

    -1 is no square, so that all but 0 are squares or opposites of squares: squares are taken for the positive numbers.
    """

    def __init__(self, prime: int, angles: Field | None) -> None:
        self.prime, self.angles = prime, angles

    def number(self, value: Fraction) -> int | None:
        """A rational number; None where its denominator is 0 here."""
        below = value.denominator % self.prime
        return value.numerator * pow(below, -1, self.prime) % self.prime if below else None

    def positive(self, a: int) -> bool:
        """Whether an element is 0 or a square."""
        return a == 0 or pow(a, (self.prime - 1) // 2, self.prime) == 1

    def root(self, a: int) -> int:
        """The positive square root of a positive element."""
        return pow(a, (self.prime + 1) // 4, self.prime)

    def sum(self, a: Pair, b: Pair) -> Pair:
        """The point of the sum of two angles."""
        (c, s), (d, t), p = a, b, self.prime
        return (c * d - s * t) % p, (s * d + c * t) % p

    def multiple(self, point: Pair, count: int) -> Pair:
        """The point of a whole multiple, 0 or more, of an angle."""
        result = (1, 0)
        while count:
            if count & 1:
                result = self.sum(result, point)
            count >>= 1
            if count:
                point = self.sum(point, point)
        return result

    def point(self, t: int) -> Pair:
        """A point of the circle by its rational parameter."""
        p = self.prime
        scale = pow(1 + t * t, -1, p)
        return (1 - t * t) * scale % p, 2 * t * scale % p

    def _points(self) -> Iterator[Pair]:
        return (self.point(t) for t in range(2, self.prime))

    @cached_property
    def unit(self) -> Pair:
        """G, of the order of the field of angles: the point of the angle 1."""
        assert self.angles is not None
        multiples = (self.multiple(point, (self.prime + 1) // self.angles.prime) for point in self._points())
        return next(point for point in multiples if point != (1, 0))

    @cached_property
    def step(self) -> Pair:
        """H, of order STEPS, whose power of 15 degrees is ((sqrt 6 + sqrt 2) / 4, (sqrt 6 - sqrt 2) / 4)."""
        two, three, quarter = self.root(2), self.root(3), pow(4, -1, self.prime)
        fifteen = (two * three + two) * quarter % self.prime, (two * three - two) * quarter % self.prime
        for point in self._points():
            small = self.multiple(point, (self.prime + 1) // STEPS)
            turned = whole = self.multiple(small, STEPS // 24)
            # a power that is prime to 6 keeps the order
            for power in range(1, 24):
                if turned == fifteen:
                    return self.multiple(small, power)
                turned = self.sum(turned, whole)
        raise AssertionError("there is a point of order 864 on every circle")

    def turn(self, half_turns: Fraction) -> Pair | None:
        """The point of a multiple of pi; None where it is no multiple of pi/432 and of fractions prime to 6."""
        below, rest = 1, half_turns.denominator
        for factor in (2, 3):
            while rest % factor == 0:
                below, rest = below * factor, rest // factor
        if STEPS // 2 % below:
            return None
        steps = STEPS // 2 // below * half_turns.numerator * pow(rest, -1, STEPS)
        return self.multiple(self.step, steps % STEPS)


LAST = Field(2**107 - 1, None)
# Primes in which all primes up to 47 are squares: fractions of small numbers have the sign that they have.
INNERMOST = Field(STEPS * 56304 * LAST.prime - 1, LAST)
INNER = Field(STEPS * 93380 * INNERMOST.prime - 1, INNERMOST)
FIELD = Field(STEPS * 191000 * INNER.prime - 1, INNER)
