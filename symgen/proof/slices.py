"""Ranges of angles cut into slices in which the portable sine and cosine stay in one quadrant.

In a slice that spans two quadrants the multiple of pi/2 is not one number, and interval analysis of the polynomials
says next to nothing. The cuts therefore lie exactly between the two floats where the multiple changes.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from symgen.backends.literals import round_to
from symgen.ir.kernel import Scalar
from symgen.ir.sincos import ROUNDER, angle_limit
from symgen.model.model import Range
from symgen.symbolic.scalar import PI

# The width of a slice in rad, at most.
WIDEST = 0.25
_FORMAT: dict[Scalar, tuple[str, str]] = {"float64": ("<d", "<q"), "float32": ("<f", "<i")}


@dataclass(frozen=True, slots=True)
class Slice:
    """A closed interval of floats."""

    low: float
    high: float


@cache
def slices(scalar: Scalar, given: Range, wide: bool = False) -> tuple[Slice, ...]:
    """The range, rounded to the scalar type, in slices of one quadrant, none much wider than `WIDEST`.

    A range that goes beyond the limit of the angles, which is further in models of wide angles, stays whole.
    """
    low, high = (round_to(scalar, bound) for bound in given)
    limit = float(angle_limit(scalar, wide))
    if not -limit <= low <= high <= limit:
        return (Slice(low, high),)
    pieces = []
    while True:
        end = _last_with(scalar, _multiple(scalar, low), low, high)
        pieces += _fine(scalar, Slice(low, end))
        if end == high:
            return tuple(pieces)
        low = _neighbour(scalar, end)


def _multiple(scalar: Scalar, x: float) -> float:
    """The multiple of pi/2 that the reduction takes from x, in the arithmetic of the scalar type.

    A product, sum or difference of two binary32 numbers that is rounded to binary64 and then to binary32 is the one
    rounded once: 53 bits are more than 2 * 24 + 1 (Figueroa, When is double rounding innocuous?, 1995).
    """
    one, rounder = _rounded(scalar), float(ROUNDER[scalar])
    turns = one(x * _turn(scalar))
    return one(one(turns + rounder) - rounder)


@cache
def _turn(scalar: Scalar) -> float:
    return round_to(scalar, 2 / PI)


def _rounded(scalar: Scalar) -> Callable[[float], float]:
    return float if scalar == "float64" else _single


def _single(x: float) -> float:
    return float(struct.unpack("<f", struct.pack("<f", x))[0])


def _last_with(scalar: Scalar, multiple: float, low: float, high: float) -> float:
    """The largest float up to `high` with the multiple that `low` has; multiples grow with x."""
    if _multiple(scalar, high) == multiple:
        return high
    return _bisect(scalar, lambda x: _multiple(scalar, x) == multiple, low, high)


def _bisect(scalar: Scalar, holds: Callable[[float], bool], low: float, high: float) -> float:
    """The last float for which a statement holds that is true at `low` and false at `high`."""
    first, last = _order(scalar, low), _order(scalar, high)
    while last - first > 1:
        middle = (first + last) // 2
        first, last = (middle, last) if holds(_float(scalar, middle)) else (first, middle)
    return _float(scalar, first)


def _neighbour(scalar: Scalar, x: float) -> float:
    return _float(scalar, _order(scalar, x) + 1)


def _order(scalar: Scalar, x: float) -> int:
    """The place of a float in the order of all floats."""
    real, whole = _FORMAT[scalar]
    (bits,) = struct.unpack(whole, struct.pack(real, abs(x)))
    return -int(bits) if x < 0 else int(bits)


def _float(scalar: Scalar, place: int) -> float:
    real, whole = _FORMAT[scalar]
    (x,) = struct.unpack(real, struct.pack(whole, abs(place)))
    return -float(x) if place < 0 else float(x)


def _fine(scalar: Scalar, whole: Slice) -> list[Slice]:
    count = max(1, math.ceil((whole.high - whole.low) / WIDEST))
    step = (Fraction(whole.high) - Fraction(whole.low)) / count
    inner = [round_to(scalar, Fraction(whole.low) + k * step) for k in range(1, count)]
    return [Slice(a, b) for a, b in zip([whole.low, *inner], [*inner, whole.high], strict=True)]
