"""Values of scalars in a large prime field: two scalars with the same value are the same function.

Symbols get fixed pseudo-random residues modulo a prime near 2^127, sines and cosines the rational parametrisation
c = (1 - t^2)/(1 + t^2), s = 2t/(1 + t^2) of the circle, sums of angles the addition theorem.  A false identity between
rational functions of symbols, sines and cosines passes with a chance of about degree / 2^127 (Schwartz and Zippel).
Every other function is an independent residue that depends on its argument's value: identities it may take part in are
not seen, but none is invented.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction

# 2 q + 1 with a prime q: doubling comes back to its start after q times at the earliest (modulo 2^127 - 1 after 127)
PRIME = 2**127 - 2721
# Of families: small numbers are multiplied several times as fast.
FAMILIES = 2**61 - 1


def residue(value: Fraction) -> int:
    """A rational number in the field."""
    return value.numerator * pow(value.denominator, -1, PRIME) % PRIME


def opaque(*key: object) -> int:
    """A fixed pseudo-random residue, the same in every run and on every machine."""
    return random.Random(repr(key)).randrange(1, PRIME)


def family(op: str, value: int, families: Sequence[int]) -> int:
    """What products have in common that differ in numbers, in sines and cosines, or in the signs of their factors.

    `value` is that of the operation, `families` are those of its arguments; of the product of two it is their product
    modulo FAMILIES.
    """
    match op:
        case "neg":
            return families[0]
        case "div":
            return families[0] * pow(families[1], -1, FAMILIES) % FAMILIES
        case "const" | "sin" | "cos":
            return 1
        case _:
            # a factor: x and -x have the same square; what is 0 unseen may be divided by, too
            return value * value % PRIME % FAMILIES or 1


def leaf_pair(value: int) -> tuple[int, int]:
    """(cosine, sine) of an angle leaf with a given value; 1 + t^2 has no root because -1 is no square modulo PRIME."""
    t = opaque("angle", value)
    scale = pow(1 + t * t, -1, PRIME)
    return (1 - t * t) * scale % PRIME, 2 * t * scale % PRIME


def angle_pair(form: Mapping[int, int], pairs: Mapping[int, tuple[int, int]]) -> tuple[int, int]:
    """(cosine, sine) of an integer combination of leaves, given by their keys."""
    c, s = 1, 0
    for leaf, count in form.items():
        a, b = pairs[leaf]
        if count < 0:
            b = -b
        left = abs(count)
        while left:  # by squares: nested definitions make large multiples
            if left & 1:
                c, s = (c * a - s * b) % PRIME, (s * a + c * b) % PRIME
            left >>= 1
            if left:
                a, b = (a * a - b * b) % PRIME, 2 * a * b % PRIME
    return c, s


def combine(op: str, args: Sequence[int], payload: object) -> int:
    """The residue of an operation on residues."""
    match op:
        case "add":
            return (args[0] + args[1]) % PRIME
        case "sub":
            return (args[0] - args[1]) % PRIME
        case "mul":
            return args[0] * args[1] % PRIME
        case "neg":
            return -args[0] % PRIME
        case "div" if args[1]:
            return args[0] * pow(args[1], -1, PRIME) % PRIME
        case "abs":
            return opaque("abs", min(args[0], -args[0] % PRIME))
        case _:
            return opaque(op, payload, *args)
