"""Exact values of scalars at random points: identities are decided by arithmetic, with no rounding and no tolerance.

Numbers are those of a prime field in which squares are taken for the positive ones (see `circle`).  Then sqrt(x)^2 = x,
sqrt(x^2) = |x|, |x y| = |x| |y| and x / |x| = copysign(1, x) hold exactly, with sqrt(x) = i sqrt(-x) for negative x.
Sines and cosines are points of the circle: what stands in an angle is worked out as a number of the field of angles,
and multiples of pi that are added there turn by roots of unity.  Every other function is a random number that depends
on its arguments' values.  A false identity passes with a chance of about its degree / 2^100 (Schwartz and Zippel).

Unlike the fingerprints, which every scalar of a graph carries, nothing here relies on the rules of the graph.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fractions import Fraction
from typing import TypeAlias

from symgen.graph.circle import FIELD, Field
from symgen.graph.fingerprint import opaque
from symgen.graph.scalar import PI, Scalar
from symgen.graph.traverse import reached, topological

# a + b i; None where something is divided by 0, or where nothing is known of an angle
Element: TypeAlias = tuple[int, int]
Value: TypeAlias = Element | None

ZERO = (0, 0)
# A constant is b + n pi / WHOLE with a decimal b and a small n wherever it is written with pi.
WHOLE = 12 * 10**6
DIGITS = 10**70
# Decimals of models are shorter than this, constants with pi longer.
LONGEST = 10**30


def exact_values(outputs: Sequence[Scalar], seed: int = 0) -> list[Value]:
    """The outputs at the point of a seed; scalars of several graphs with the same symbols have the same point."""
    order = topological(outputs)
    values = _Values(FIELD, order, frozenset(order), seed).known
    return [values[output] for output in outputs]


def half_turns(value: Fraction) -> Fraction:
    """How many times pi a constant holds: t of b + t pi, as it was written with the PI of graphs."""
    if value.denominator <= LONGEST:
        return Fraction(0)
    # what divides neither power of ten nor its multiples belongs to fractions such as 22/7
    rest = value.denominator
    for factor in (2, 5):
        while rest % factor == 0:
            rest //= factor
    whole = WHOLE * rest
    digits, common = (PI * DIGITS).numerator, DIGITS
    scaled, odd = divmod((value * whole * DIGITS).numerator, digits & -digits)
    if odd or rest > LONGEST or (value * whole * DIGITS).denominator != 1:
        return Fraction(0)
    common, digits = common // (digits & -digits), digits // (digits & -digits)
    found = scaled * pow(digits, -1, common) % common
    found = found - common if 2 * found > common else found
    return Fraction(found, whole) if abs(found) < LONGEST else Fraction(0)


class _Values:
    """The values in one field, and, inside of angles, in the field of its angles."""

    def __init__(self, field: Field, order: Sequence[Scalar], wanted: Collection[Scalar], seed: int) -> None:
        self._field, self._seed = field, seed
        self._angles = {node.args[0] for node in order if node in wanted and node.op in ("sin", "cos")}
        self._inside: dict[Scalar, Value] = {}
        self._turns: dict[Scalar, Fraction] = {}
        if self._angles and field.angles is not None:
            inside = reached(self._angles)
            self._inside = _Values(field.angles, order, inside, seed).known
            self._turns = _turns([node for node in order if node in inside])
        self._pairs: dict[Scalar, tuple[int, int] | None] = {}
        self.known: dict[Scalar, Value] = {}
        for node in order:
            if node in wanted:
                self.known[node] = self._value(node)

    def _opaque(self, *key: object) -> int:
        return opaque(self._seed, self._field.prime, *key) % self._field.prime

    def _value(self, node: Scalar) -> Value:
        if node.constant is not None:
            number = self._field.number(node.constant)
            return None if number is None else (number, 0)
        if node.op == "symbol":
            return self._opaque("symbol", node.payload), 0
        if node.op in ("sin", "cos"):
            pair = self._pair(node.args[0])
            return None if pair is None else (pair[node.op == "sin"], 0)
        given = [self.known[a] for a in node.args]
        args = [a for a in given if a is not None]
        return None if len(args) < len(given) else self._operation(node, args)

    def _operation(self, node: Scalar, args: list[Element]) -> Value:
        field = self._field
        a, b = (*args, ZERO)[:2]
        real = not any(x[1] for x in args)
        match node.op:
            case "add":
                return (a[0] + b[0]) % field.prime, (a[1] + b[1]) % field.prime
            case "sub":
                return (a[0] - b[0]) % field.prime, (a[1] - b[1]) % field.prime
            case "neg":
                return self._minus(a)
            case "mul":
                return self._times(a, b)
            case "div":
                return self._over(a, b)
            case "ratio_or_zero":
                return ZERO if b == ZERO else self._over(a, b)
            case "sqrt" if real:
                return (field.root(a[0]), 0) if field.positive(a[0]) else (0, field.root(-a[0]))
            case "abs" if real:
                return a if field.positive(a[0]) else self._minus(a)
            case "copysign" if real:
                return a if field.positive(a[0]) == field.positive(b[0]) else self._minus(a)
            case "abs":
                return self._opaque("abs", min(a, self._minus(a))), 0
            case _:
                return self._opaque(node.op, node.payload, *args), 0

    def _minus(self, a: Element) -> Element:
        return -a[0] % self._field.prime, -a[1] % self._field.prime

    def _times(self, a: Element, b: Element) -> Element:
        p = self._field.prime
        return (a[0] * b[0] - a[1] * b[1]) % p, (a[0] * b[1] + a[1] * b[0]) % p

    def _over(self, a: Element, b: Element) -> Value:
        norm = (b[0] * b[0] + b[1] * b[1]) % self._field.prime
        if not norm:
            return None
        scale = pow(norm, -1, self._field.prime)
        return self._times(a, (b[0] * scale, -b[1] * scale))

    def _pair(self, angle: Scalar) -> tuple[int, int] | None:
        if angle not in self._pairs:
            self._pairs[angle] = self._turned(angle) if self._inside else self._drawn(angle)
        return self._pairs[angle]

    def _turned(self, angle: Scalar) -> tuple[int, int] | None:
        """The point of an angle that is a number of the field of angles, and of the multiple of pi beside it."""
        field, value, turns = self._field, self._inside[angle], self._turns[angle]
        assert field.angles is not None
        beside, turned = field.angles.number(turns * PI), field.turn(turns)
        if value is None or value[1] or beside is None or turned is None:
            return None
        return field.sum(turned, field.multiple(field.unit, (value[0] - beside) % field.angles.prime))

    def _drawn(self, angle: Scalar) -> tuple[int, int] | None:
        """Any point of the circle for any value of an angle; the opposite one for the opposite value."""
        value = self.known[angle]
        if value is None or value == ZERO:
            return None if value is None else (1, 0)
        same = min(value, self._minus(value))
        cosine, sine = self._field.point(self._opaque("angle", same))
        return cosine, sine if value == same else -sine % self._field.prime


def _turns(order: Sequence[Scalar]) -> dict[Scalar, Fraction]:
    """The multiples of pi that are added in sums and in multiples of them; what stands in products is a number."""
    found: dict[Scalar, Fraction] = {}
    for node in order:
        args = node.args
        if node.constant is not None:
            found[node] = half_turns(node.constant)
        elif node.op == "add":
            found[node] = found[args[0]] + found[args[1]]
        elif node.op == "sub":
            found[node] = found[args[0]] - found[args[1]]
        elif node.op == "neg":
            found[node] = -found[args[0]]
        elif node.op == "mul" and (number := args[0].constant) is not None:
            found[node] = found[args[1]] * number
        else:
            found[node] = Fraction(0)
    return found
