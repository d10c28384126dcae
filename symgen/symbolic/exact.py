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

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import isqrt
from operator import mul
from typing import TypeAlias

from symgen.symbolic.angles.circle import FIELD, Field
from symgen.symbolic.fingerprint import opaque
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.traverse import topological

# a, or a + b i where b is not 0
Element: TypeAlias = int | tuple[int, int]
# None where something is divided by 0, or of what is unknown
Value: TypeAlias = Element | None

# A constant that is written with pi is m / WHOLE + n pi / WHOLE + ... with whole m and n.
WHOLE = 12 * 10**12
# Denominators of models are smaller than this, those of constants with pi larger.
LARGEST_MODEL_DENOMINATOR = 10**30
# Powers of pi up to which the denominator of a constant is looked through for them.
MOST_DEGREE = 6


_RING = frozenset({"add", "sub", "mul"})
_SIGNS = {"add": (1, 1), "sub": (1, -1), "neg": (-1,)}


def _parts(a: Element) -> tuple[int, int]:
    return (a, 0) if isinstance(a, int) else a


def half_turns(value: Fraction) -> Fraction | None:
    """How many times pi a constant holds: t of b + t pi + ..., as it was written with the PI of graphs and its powers.

    None where that is not to be seen.
    """
    turns = Fraction(0)
    while value.denominator > LARGEST_MODEL_DENOMINATOR:
        # what divides no power of ten belongs to fractions such as 22/7
        rest = value.denominator
        for factor in (2, 5):
            while rest % factor == 0:
                rest //= factor
        whole, degree = WHOLE * rest, 1
        while (scaled := value * whole * PI.denominator**degree).denominator != 1 and degree < MOST_DEGREE:
            degree += 1
        # modulo the denominator of pi nothing is left but its highest power
        count = scaled.numerator * pow(PI.numerator, -degree, PI.denominator) % PI.denominator
        count = count - PI.denominator if 2 * count > PI.denominator else count
        if scaled.denominator != 1 or abs(count) > LARGEST_MODEL_DENOMINATOR or not count:
            return None
        value -= Fraction(count, whole) * PI**degree
        turns += Fraction(count, whole) if degree == 1 else 0
    return turns


def holding_roots(outputs: Iterable[Scalar]) -> set[Scalar]:
    """The scalars below the outputs in which a root of what is no number stands: at a point that of x^2 is x or -x,
    either by chance."""
    with_roots: set[Scalar] = set()
    for node in topological(outputs):
        if (node.op == "sqrt" and node.args[0].constant is None) or not with_roots.isdisjoint(node.args):
            with_roots.add(node)
    return with_roots


class ExactValues:
    """The point of a seed: values of scalars, each worked out once, of any graphs with the same symbols.

    With `signs` a sign is that of the value, and a wrong one passes at half of the points; else |x| and copysign(x, y)
    are random numbers as other functions are.

    `unknown` holds the scalars of which nothing can be said: angles are numbers to the third inside of angles, and of
    a constant such as 6 / pi, of which only the rational number is left, the half turns are not to be seen.  A point
    `beside` this one knows the multiples of pi in angles already.
    """

    def __init__(
        self, seed: int = 0, field: Field = FIELD, signs: bool = True, beside: ExactValues | None = None
    ) -> None:
        self._field, self._seed, self._signs = field, seed, signs
        self.unknown: set[Scalar] = set()
        self._any_root: set[Scalar] = set()
        self._known: dict[Scalar, Value] = {}
        # inside of angles, numbers are those of the field of angles
        self._inside = None if field.angles is None else ExactValues(seed, field.angles, signs)
        # the same at every point
        self._turns: dict[Scalar, Fraction | None] = {} if beside is None else beside._turns
        self._pairs: dict[Scalar, tuple[int, int] | None] = {}

    @property
    def known_count(self) -> int:
        """Of how many scalars the values are known."""
        return len(self._known)

    def waiting(self, outputs: Sequence[Scalar]) -> Sequence[Scalar]:
        """What the outputs reach and is not worked out yet, operands first."""
        return topological(outputs, self._known)

    def __call__(self, outputs: Sequence[Scalar], order: Sequence[Scalar] | None = None) -> list[Value]:
        """The outputs' values; `order` is what `waiting` said here, or at a point that was asked for the same."""
        order = self.waiting(outputs) if order is None else order
        angles = [node.args[0] for node in order if node.op in ("sin", "cos")]
        if angles and self._inside is not None:
            self._inside(angles)
            self._add_turns(angles)
        known, prime = self._known, self._field.prime
        for node in order:
            op = node.op
            # most are these
            if op in _RING:
                first, second = node.args
                a, b = known[first], known[second]
                if a.__class__ is int and b.__class__ is int:
                    value = a * b if op == "mul" else a + b if op == "add" else a - b
                    known[node] = value % prime
                elif a is not None and b is not None:
                    known[node] = self._ring(op, a, b)
                else:
                    known[node] = self._value(node)
            else:
                known[node] = self._value(node)
        return [self._known[output] for output in outputs]

    def pairs(self, outputs: Sequence[Scalar]) -> list[tuple[int, int]] | None:
        """The outputs' values a + b i as a and b; None where one of them is not known."""
        values = [value for value in self(outputs) if value is not None]
        return [_parts(value) for value in values] if len(values) == len(outputs) else None

    def any_root_in(self, outputs: Sequence[Scalar]) -> bool:
        """Whether a root was taken of a + b i: any number stands for it, whose square is another."""
        roots = self._any_root if self._inside is None else self._any_root | self._inside._any_root
        return not roots.isdisjoint(topological(outputs))

    def _opaque(self, *key: object) -> int:
        return opaque(self._seed, self._field.prime, *key) % self._field.prime

    def _value(self, node: Scalar) -> Value:
        if node.constant is not None:
            return self._field.number(node.constant)
        if node.op == "symbol":
            return self._opaque("symbol", node.payload)
        if node.op in ("sin", "cos"):
            if (pair := self._pair(node.args[0])) is not None:
                return pair[node.op == "sin"]
            if not self._undefined(node.args[0]):
                self.unknown.add(node)
            return None
        given = [self._known[a] for a in node.args]
        args = [a for a in given if a is not None]
        if len(args) == len(given):
            return self._operation(node, args)
        if any(a in self.unknown for a in node.args):
            self.unknown.add(node)
        return None

    def _operation(self, node: Scalar, args: list[Element]) -> Value:
        first, second = (*args, 0)[:2]
        match node.op:
            case "neg":
                return self._minus(first)
            case "div":
                return self._over(first, second)
            case "ratio_or_zero":
                return 0 if second == 0 else self._over(first, second)
            case "rounded":
                # what is told to be rounded first is the same number
                return first
            case "sqrt":
                if not isinstance(first, int):
                    self._any_root.add(node)
                return self._root(first, node.args[0].constant)
            case "abs" if self._signs:
                return first if self._positive(first, node.args[0].constant) else self._minus(first)
            case "copysign" if self._signs:
                magnitude, sign = (self._positive(x, a.constant) for x, a in zip(args, node.args, strict=True))
                return first if magnitude == sign else self._minus(first)
            case _:
                return self._opaque(node.op, node.payload, *args)

    def _positive(self, a: Element, number: Fraction | None) -> bool:
        """Whether the scalar, which may be a number, stands for a positive one; of a and -a one does."""
        if number is not None:
            return number >= 0
        x, y = _parts(a)
        return self._field.positive(y if x == 0 else x)

    def _root(self, a: Element, number: Fraction | None) -> Element:
        """The positive root, or i times one; of multiples of i, any positive one."""
        field = self._field
        if isinstance(a, int) and number is not None:
            root = Fraction(isqrt(max(0, number.numerator)), isqrt(number.denominator))
            if root * root == number:
                return field.number(root) or 0
        if isinstance(a, int):
            root_or_not = field.root(a)
            return root_or_not if root_or_not * root_or_not % field.prime == a else (0, field.root(-a))
        return pow(self._opaque("sqrt", a), 2, field.prime)

    def _whole(self, a: int, b: int) -> Element:
        p = self._field.prime
        return (a % p, b % p) if b % p else a % p

    def _ring(self, op: str, a: Element, b: Element) -> Element:
        if op == "mul":
            return self._times(a, b)
        (x, y), (z, w) = _parts(a), _parts(b)
        return self._whole(x + z, y + w) if op == "add" else self._whole(x - z, y - w)

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

    def _pair(self, angle: Scalar) -> tuple[int, int] | None:
        if angle not in self._pairs:
            inside = self._inside
            self._pairs[angle] = None if inside is None else self._turned(angle, inside._known[angle])
        return self._pairs[angle]

    def _undefined(self, angle: Scalar) -> bool:
        """Whether something is divided by 0 in the angle."""
        inside = self._inside
        return inside is not None and inside._known[angle] is None and angle not in inside.unknown

    def _turned(self, angle: Scalar, value: Value) -> tuple[int, int] | None:
        """The point of an angle that is a number of the field of angles, and of the multiple of pi beside it."""
        field, turns = self._field, self._turns[angle]
        assert field.angles is not None
        if not isinstance(value, int) or turns is None:
            return None
        beside, turned = field.angles.number(turns * PI), field.turn(turns)
        if beside is None or turned is None:
            return None
        return field.sum(turned, field.multiple(field.unit, (value - beside) % field.angles.prime))

    def _add_turns(self, angles: Sequence[Scalar]) -> None:
        """The multiples of pi that are added in sums and in multiples of them; what stands in products is a number."""
        by_node, none = self._turns, Fraction(0)
        for node in topological(angles, by_node):
            if node.constant is not None:
                by_node[node] = half_turns(node.constant)
                continue
            turns = [by_node[a] for a in node.args]
            if node.op in _SIGNS:
                by_node[node] = _sum_of_turns(_SIGNS[node.op], turns)
            elif node.op == "mul" and (number := node.args[0].constant) is not None:
                by_node[node] = turns[1] and number * turns[1]
            elif node.op == "div" and (number := node.args[1].constant):
                by_node[node] = turns[0] and turns[0] / number
            else:
                by_node[node] = none


def _sum_of_turns(signs: Sequence[int], turns: Sequence[Fraction | None]) -> Fraction | None:
    """None where one of them is; most are 0."""
    known = [t for t in turns if t is not None]
    if len(known) < len(turns):
        return None
    return sum(map(mul, signs, known), Fraction(0)) if any(known) else Fraction(0)
