"""Exact values of scalars at random points: identities are decided by arithmetic, with no rounding and no tolerance.

Numbers are those of a prime field in which squares are taken for the positive ones (see `circle`).  Then
sqrt(x^2) = |x|, |x y| = |x| |y|, x / |x| = copysign(1, x) and sqrt(x)^2 = x for positive x hold exactly.  Of what is
negative here, numbers have the root i sqrt(-x), other scalars any positive one.  Sines and cosines are points of the
circle: what stands in an angle is worked out as a number of the field of angles, and multiples of pi that are added
there turn by roots of unity.  Every other function is a random number that depends on its arguments' values.  A false
identity passes with a chance of about its degree / 2^100 (Schwartz and Zippel).

Unlike the fingerprints, which every scalar of a graph carries, nothing here relies on the rules of the graph.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

from symgen.graph.circle import FIELD, Field
from symgen.graph.fingerprint import opaque
from symgen.graph.scalar import PI, Scalar
from symgen.graph.traverse import topological

# a, or a + b i where b is not 0
Element: TypeAlias = int | tuple[int, int]
# None where something is divided by 0, or where nothing is known of an angle
Value: TypeAlias = Element | None

# A constant is b + n pi / WHOLE with a decimal b and a small n wherever it is written with pi.
WHOLE = 12 * 10**6
DIGITS = 10**70
# Decimals of models are shorter than this, constants with pi longer.
LONGEST = 10**30


_RING = frozenset({"add", "sub", "mul"})


def _parts(a: Element) -> tuple[int, int]:
    return (a, 0) if isinstance(a, int) else a


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


class ExactValues:
    """The point of a seed: values of scalars, each worked out once, of any graphs with the same symbols."""

    def __init__(self, seed: int = 0, field: Field = FIELD) -> None:
        self._field, self._seed = field, seed
        self._known: dict[Scalar, Value] = {}
        # inside of angles, numbers are those of the field of angles
        self._inside = None if field.angles is None else ExactValues(seed, field.angles)
        self._turns: dict[Scalar, Fraction] = {}
        self._pairs: dict[Scalar, tuple[int, int] | None] = {}

    def __call__(self, outputs: Sequence[Scalar]) -> list[Value]:
        """The outputs' values."""
        order = topological(outputs, self._known)
        angles = [node.args[0] for node in order if node.op in ("sin", "cos")]
        if angles and self._inside is not None:
            self._inside(angles)
            self._add_turns(angles)
        known, prime = self._known, self._field.prime
        for node in order:
            op, args = node.op, node.args
            # most are these
            if op in _RING and (a := known[args[0]]).__class__ is int and (b := known[args[1]]).__class__ is int:
                value = a * b if op == "mul" else a + b if op == "add" else a - b
                known[node] = value % prime
            else:
                known[node] = self._value(node)
        return [self._known[output] for output in outputs]

    def _opaque(self, *key: object) -> int:
        return opaque(self._seed, self._field.prime, *key) % self._field.prime

    def _value(self, node: Scalar) -> Value:
        if node.constant is not None:
            return self._field.number(node.constant)
        if node.op == "symbol":
            return self._opaque("symbol", node.payload)
        if node.op in ("sin", "cos"):
            pair = self._pair(node.args[0])
            return None if pair is None else pair[node.op == "sin"]
        given = [self._known[a] for a in node.args]
        args = [a for a in given if a is not None]
        return None if len(args) < len(given) else self._operation(node, args)

    def _operation(self, node: Scalar, args: list[Element]) -> Value:
        first, second = (*args, 0)[:2]
        match node.op:
            case "add":
                return self._plus(first, second)
            case "sub":
                return self._plus(first, self._minus(second))
            case "neg":
                return self._minus(first)
            case "mul":
                return self._times(first, second)
            case "div":
                return self._over(first, second)
            case "ratio_or_zero":
                return 0 if second == 0 else self._over(first, second)
            case "sqrt" if isinstance(first, int):
                return self._root(first, node.args[0].constant is not None)
            case "abs" if isinstance(first, int):
                return first if self._field.positive(first) else self._minus(first)
            case "copysign" if isinstance(first, int) and isinstance(second, int):
                same = self._field.positive(first) == self._field.positive(second)
                return first if same else self._minus(first)
            case "abs":
                return self._opaque("abs", self._either(first))
            case _:
                return self._opaque(node.op, node.payload, *args)

    def _root(self, a: int, number: bool) -> Element:
        """The positive root, which has a root in turn; i times one, or any, of what is negative."""
        field = self._field
        if field.positive(a):
            return field.root(a)
        return (0, field.root(-a)) if number else pow(self._opaque("sqrt", a), 2, field.prime)

    def _whole(self, a: int, b: int) -> Element:
        p = self._field.prime
        return (a % p, b % p) if b % p else a % p

    def _plus(self, a: Element, b: Element) -> Element:
        (x, y), (z, w) = _parts(a), _parts(b)
        return self._whole(x + z, y + w)

    def _minus(self, a: Element) -> Element:
        x, y = _parts(a)
        return self._whole(-x, -y)

    def _times(self, a: Element, b: Element) -> Element:
        (x, y), (z, w) = _parts(a), _parts(b)
        return self._whole(x * z - y * w, x * w + y * z)

    def _over(self, a: Element, b: Element) -> Value:
        z, w = _parts(b)
        norm = (z * z + w * w) % self._field.prime
        if not norm:
            return None
        scale = pow(norm, -1, self._field.prime)
        return self._times(a, self._whole(z * scale, -w * scale))

    def _either(self, a: Element) -> Element:
        """The same for a and -a."""
        return min(a, self._minus(a), key=_parts)

    def _pair(self, angle: Scalar) -> tuple[int, int] | None:
        if angle not in self._pairs:
            inside = self._inside
            self._pairs[angle] = self._drawn(angle) if inside is None else self._turned(angle, inside._known[angle])
        return self._pairs[angle]

    def _turned(self, angle: Scalar, value: Value) -> tuple[int, int] | None:
        """The point of an angle that is a number of the field of angles, and of the multiple of pi beside it."""
        field, turns = self._field, self._turns[angle]
        assert field.angles is not None
        beside, turned = field.angles.number(turns * PI), field.turn(turns)
        if not isinstance(value, int) or beside is None or turned is None:
            return None
        return field.sum(turned, field.multiple(field.unit, (value - beside) % field.angles.prime))

    def _drawn(self, angle: Scalar) -> tuple[int, int] | None:
        """Any point of the circle for any value of an angle; the opposite one for the opposite value."""
        value = self._known[angle]
        if value is None or value == 0:
            return None if value is None else (1, 0)
        same = self._either(value)
        cosine, sine = self._field.point(self._opaque("angle", same))
        return cosine, sine if value == same else -sine % self._field.prime

    def _add_turns(self, angles: Sequence[Scalar]) -> None:
        """The multiples of pi that are added in sums and in multiples of them; what stands in products is a number."""
        found = self._turns
        for node in topological(angles, found):
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
